"""Damage: what a user writes of it, and what it takes from teeth and bearings."""
