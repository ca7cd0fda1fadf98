"""Bodies, bearings and housing of a gearbox, what drives it, and its matrices."""
