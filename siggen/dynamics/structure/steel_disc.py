"""A gear as a solid steel disc of its pitch circle with its bore."""

from __future__ import annotations

from math import pi

from siggen.gears.geometry.spur_gear import SpurGear

STEEL_DENSITY_KG_M3 = 7850.0


def disc_mass_kg(gear: SpurGear, face_width_m: float) -> float:
    """Return its mass [kg]."""
    return STEEL_DENSITY_KG_M3 * pi * (gear.pitch_radius_m**2 - gear.bore_radius_m**2) * face_width_m


def disc_inertia_kg_m2(gear: SpurGear, face_width_m: float) -> float:
    """Return its moment of inertia about its axis [kg m^2]."""
    return 0.5 * disc_mass_kg(gear, face_width_m) * (gear.pitch_radius_m**2 + gear.bore_radius_m**2)
