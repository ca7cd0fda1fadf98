"""Kinds of sensors, each a module: what a user writes, what of the model it shows, its quantity and unit."""
