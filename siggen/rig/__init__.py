"""A machine that a user describes by a few numbers, as a configuration that a set can be made from."""
