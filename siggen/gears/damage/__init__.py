"""Damage on flanks: outlines, their union, what the contact line meets."""
