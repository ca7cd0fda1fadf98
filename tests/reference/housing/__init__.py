"""Housings of siggen against three-dimensional finite elements, and what choosing from a library would cost."""
