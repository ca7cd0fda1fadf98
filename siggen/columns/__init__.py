"""Names, units and meanings of every column of a set."""
