"""One page on which the records of a set are looked at: chosen, zoomed, and laid over their healthy reference."""
