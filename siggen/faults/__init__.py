"""Kinds of damage, each a module: what a user writes, how it is drawn, what cannot be, what it is called."""
