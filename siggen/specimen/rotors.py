"""Gears of a drawn specimen as rotors on their bearings; one without given mass is a steel disc with its bore."""

from __future__ import annotations

from math import pi

from siggen.config import PlainRotor, Rotor
from siggen.dynamics.structure.gear_stage import Bearing
from siggen.dynamics.structure.gear_stage import Rotor as RotorNumbers
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.keys.number import constant
from siggen.rig.rig_numbers import STEEL_DENSITY_KG_M3


def disc_mass_kg(gear: SpurGear, face_width_m: float) -> float:
    """Return the mass [kg] of a steel disc of the gear's pitch circle with its bore."""
    return STEEL_DENSITY_KG_M3 * pi * (gear.pitch_radius_m**2 - gear.bore_radius_m**2) * face_width_m


def disc_inertia_kg_m2(gear: SpurGear, face_width_m: float) -> float:
    """Return the moment of inertia [kg m^2] of the same disc about its axis."""
    return 0.5 * disc_mass_kg(gear, face_width_m) * (gear.pitch_radius_m**2 + gear.bore_radius_m**2)


def rotor_numbers(section: PlainRotor, gear: SpurGear, face_width_m: float) -> RotorNumbers:
    """Return a gear with both bearings of its shaft in SI."""
    mass, inertia = section.mass_kg, section.inertia_kg_m2
    along = {}
    if isinstance(section, Rotor):
        along["stiffness_z_n_per_m"] = constant(section.bearing_stiffness_z_n_per_m)
    return RotorNumbers(
        base_radius_m=gear.base_radius_m,
        mass_kg=disc_mass_kg(gear, face_width_m) if mass is None else constant(mass),
        inertia_kg_m2=disc_inertia_kg_m2(gear, face_width_m) if inertia is None else constant(inertia),
        bearing=Bearing(
            stiffness_x_n_per_m=constant(section.bearing_stiffness_x_n_per_m),
            stiffness_y_n_per_m=constant(section.bearing_stiffness_y_n_per_m),
            damping_x_n_s_per_m=constant(section.bearing_damping_x_n_s_per_m),
            damping_y_n_s_per_m=constant(section.bearing_damping_y_n_s_per_m),
            **along,
        ),
    )
