"""A rigid casing of a drawn specimen in SI: mass, bolts, and where shafts and sensors stand."""

from __future__ import annotations

from collections.abc import Sequence

from siggen.config import RigidHousing
from siggen.dynamics.structure.gear_stage import Bolts, Casing, Point
from siggen.keys.number import Number, constant
from siggen.sensors.sensor import SensorBase

CASING_GYRATION = 1.15
"""Radius of gyration of a casing over the distance of its axes: a box of even wall round the gears (derived)."""


def casing_numbers(section: RigidHousing, extent_m: float, sensors: Sequence[SensorBase]) -> Casing:
    """Return a drawn casing in SI; the extent [m] is that of its outermost axes, the first pinion at one end."""
    bolts, inertia = section.bolts, section.inertia_kg_m2
    mass, gyration_m = constant(section.mass_kg), CASING_GYRATION * extent_m
    return Casing(
        mass_kg=mass,
        inertia_kg_m2=mass * gyration_m**2 if inertia is None else constant(inertia),
        bolts=Bolts(
            shear_stiffness_n_per_m=constant(bolts.shear_stiffness_n_per_m),
            axial_stiffness_n_per_m=constant(bolts.axial_stiffness_n_per_m),
            damping_ratio=constant(bolts.damping_ratio),
            places_m=tuple(_metres(place) for place in bolts.positions_mm),
            loose_share=constant(section.loose_foot_share),
        ),
        pinion_place_m=(0.5 * extent_m, 0.0),
        sensor_places_m={s.name: _sensor_metres(s.place_on_casing_mm) for s in sensors if s.place_on_casing_mm},
    )


def _sensor_metres(position_mm: tuple[Number, ...]) -> Point:
    horizontal, vertical = (constant(number) for number in position_mm)
    return _metres((horizontal, vertical))


def _metres(position_mm: tuple[float, float]) -> Point:
    return 1e-3 * position_mm[0], 1e-3 * position_mm[1]
