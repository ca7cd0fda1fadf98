"""Tooth geometry, manufacturing errors, damage, stiffness and contact of spur gears."""
