"""Records of a set as arrays, what makes them usable, and their states."""
