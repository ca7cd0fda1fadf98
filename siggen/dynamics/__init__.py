"""Structure, drive, friction, mesh law and time integration of a gearbox."""
