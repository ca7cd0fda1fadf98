"""Condition indicators, one definition per file; each says on which signal it is defined."""
