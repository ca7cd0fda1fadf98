"""A drawn planetary set in SI: its bodies on their supports.

Bodies are steel discs, the ring an annulus: r²/2 (outer and inner) about the axis. A body of mass m on a support k is
damped by 2 ζ √(k m). What holds the ring round its rim keeps it from turning too: evenly spread springs and dampers
that resist along and across make k R² (derived).
"""

from __future__ import annotations

from math import pi, sqrt

from siggen.config import Dynamics, PlainRotor, Planetary
from siggen.dynamics.structure.gear_stage import PlanetaryBody, PlanetaryStage
from siggen.dynamics.structure.steel_disc import STEEL_DENSITY_KG_M3
from siggen.gearbox.train import coupling_numbers, rotor_numbers
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.internal_pair import InternalPair
from siggen.gears.geometry.planetary import PlanetarySet
from siggen.keys.number import Number, constant

DAMPING_RATIO = 0.03
"""Of each body on its support alone (assumed)."""
RIM_MODULES = 4.0
"""Thickness of a ring behind its roots (assumed)."""


def ring_outer_radius_m(inner: InternalPair) -> float:
    """Return the radius of the ring's rim [m]."""
    return inner.gear.root_radius_m + RIM_MODULES * inner.gear.module_m


def planetary_stage(
    section: Planetary, dynamics: Dynamics, pair: GearPair, inner: InternalPair, teeth: PlanetarySet
) -> PlanetaryStage:
    """Return the bodies of a drawn set with motor, load and couplings."""
    sun, planet = (rotor_numbers(PlainRotor(), gear, pair.face_width_m) for gear in (pair.pinion, pair.gear))
    return PlanetaryStage(
        sun_angle_rad=pair.working_pressure_angle_rad,
        ring_angle_rad=inner.working_pressure_angle_rad,
        centre_distance_m=pair.working_centre_distance_m,
        sun=_body(sun.base_radius_m, (sun.mass_kg, sun.inertia_kg_m2), section.sun_stiffness_n_per_m),
        planet=_body(planet.base_radius_m, (planet.mass_kg, planet.inertia_kg_m2), section.planet_stiffness_n_per_m),
        ring=_ring(section, inner),
        carrier=_carrier(section, pair),
        places_turns=tuple(float(place) for place in teeth.places),
        motor_inertia_kg_m2=constant(dynamics.motor_inertia_kg_m2),
        load_inertia_kg_m2=constant(dynamics.load_inertia_kg_m2),
        input_coupling=coupling_numbers(dynamics.input_coupling),
        output_coupling=coupling_numbers(dynamics.output_coupling),
    )


def _body(radius_m: float, inertias: tuple[float, float], stiffness: Number) -> PlanetaryBody:
    (mass, inertia), stiffness_n_per_m = inertias, constant(stiffness)
    return PlanetaryBody(
        radius_m, mass, inertia, stiffness_n_per_m, 2.0 * DAMPING_RATIO * sqrt(stiffness_n_per_m * mass)
    )


def _ring(section: Planetary, inner: InternalPair) -> PlanetaryBody:
    ring, outer = inner.gear, ring_outer_radius_m(inner)
    root = ring.root_radius_m
    steel_kg = STEEL_DENSITY_KG_M3 * pi * (outer**2 - root**2) * inner.face_width_m
    mass = steel_kg if section.ring_mass_kg is None else constant(section.ring_mass_kg)
    held = constant(section.ring_stiffness_n_per_m)
    damping = 2.0 * DAMPING_RATIO * sqrt(held * mass)
    inertia = 0.5 * mass * (outer**2 + root**2)
    return PlanetaryBody(ring.base_radius_m, mass, inertia, held, damping, held * outer**2, damping * outer**2)


def _carrier(section: Planetary, pair: GearPair) -> PlanetaryBody:
    radius = pair.working_centre_distance_m
    mass = STEEL_DENSITY_KG_M3 * pi * radius**2 * pair.face_width_m
    return _body(radius, (mass, 0.5 * mass * radius**2), section.carrier_stiffness_n_per_m)
