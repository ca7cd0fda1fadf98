"""Masses, dampers and springs of gears, shafts, bearings and casing."""
