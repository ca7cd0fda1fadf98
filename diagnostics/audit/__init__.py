"""Audit of a set: what makes it trivially separable, how near it is to measured gearboxes, what can be detected."""
