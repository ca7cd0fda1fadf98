"""A drawn planetary set in SI: its teeth, its bodies on their supports, its planets in their ring.

Bodies are steel discs, the ring an annulus: r²/2 (outer and inner) about the axis. A body of mass m on a support k is
damped by 2 ζ √(k m). What holds the ring round its rim keeps it from turning too: evenly spread springs and dampers
that resist along and across make k R² (derived).
"""

from __future__ import annotations

from math import pi, sqrt

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Config, PlainRotor, Planetary
from siggen.config import Coupling as CouplingSection
from siggen.config.planetary_problems import set_of
from siggen.dynamics.structure.gear_stage import Coupling, PlanetaryBody, PlanetaryStage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.internal_pair import InternalPair, ring_round
from siggen.gears.geometry.planetary import PlanetarySet
from siggen.keys.number import Number, constant
from siggen.planning.specimen import OperatingPoint, Specimen
from siggen.rig.rig_numbers import STEEL_DENSITY_KG_M3
from siggen.seeding import Stage, named_generator
from siggen.specimen.gears import gear_pair
from siggen.specimen.rotors import rotor_numbers

DAMPING_RATIO = 0.03
"""Of each body on its support alone (assumed)."""
RIM_MODULES = 4.0
"""Thickness of a ring behind its roots (assumed)."""


def planetary_teeth(specimen: Specimen) -> PlanetarySet:
    """Return the teeth of a drawn set, and where its planets stand."""
    assert specimen.planetary is not None
    return set_of(specimen.gears, specimen.planetary)


def planets_in_ring(specimen: Specimen) -> tuple[GearPair, InternalPair]:
    """Return sun and planet, and the planet in its ring.

    Raises
    ------
    ValueError
        As `ring_round`.
    """
    pair = gear_pair(specimen.gears)
    return pair, ring_round(pair, planetary_teeth(specimen).ring)


def of_one_mesh(specimen: Specimen, point: OperatingPoint) -> OperatingPoint:
    """Return a point as the sun has it against the carrier in one of its meshes; that of a pair as it is."""
    if specimen.planetary is None:
        return point
    teeth = planetary_teeth(specimen)
    return OperatingPoint(point.speed_hz * (1.0 - float(teeth.carrier_turns)), point.torque_nm / len(teeth.places))


def hunting_turns_of_sun(specimen: Specimen) -> float:
    """Return the turns of the sun after which all teeth stand again as they did, and the carrier too."""
    teeth = planetary_teeth(specimen)
    return teeth.common_turns * (1.0 + teeth.ring / teeth.sun)


def pin_errors_m(config: Config, specimen: Specimen) -> FloatArray:
    """Return by how much each planet's pin is ahead of its place along the tangent (planets,) [m]."""
    section = specimen.planetary
    assert section is not None
    rng = named_generator(config.seed, Stage.GEARS, specimen.specimen_id, name="planetary.pin_error_um")
    drawn = rng.standard_normal(len(section.positions_deg))
    return np.asarray(1e-6 * constant(section.pin_error_um) * drawn)


def planetary_numbers(specimen: Specimen) -> PlanetaryStage:
    """Return the bodies of a drawn set with motor, load and couplings."""
    section, dynamics = specimen.planetary, specimen.dynamics
    assert section is not None
    pair, inner = planets_in_ring(specimen)
    sun, planet = (rotor_numbers(PlainRotor(), gear, pair.face_width_m) for gear in (pair.pinion, pair.gear))
    ring = _ring(section, inner)
    return PlanetaryStage(
        sun_angle_rad=pair.working_pressure_angle_rad,
        ring_angle_rad=inner.working_pressure_angle_rad,
        centre_distance_m=pair.working_centre_distance_m,
        sun=_body(sun.base_radius_m, (sun.mass_kg, sun.inertia_kg_m2), section.sun_stiffness_n_per_m),
        planet=_body(planet.base_radius_m, (planet.mass_kg, planet.inertia_kg_m2), section.planet_stiffness_n_per_m),
        ring=ring,
        carrier=_carrier(section, pair),
        places_turns=tuple(float(place) for place in planetary_teeth(specimen).places),
        motor_inertia_kg_m2=constant(dynamics.motor_inertia_kg_m2),
        load_inertia_kg_m2=constant(dynamics.load_inertia_kg_m2),
        input_coupling=_coupling(dynamics.input_coupling),
        output_coupling=_coupling(dynamics.output_coupling),
    )


def _body(radius_m: float, inertias: tuple[float, float], stiffness: Number) -> PlanetaryBody:
    (mass, inertia), stiffness_n_per_m = inertias, constant(stiffness)
    return PlanetaryBody(
        radius_m, mass, inertia, stiffness_n_per_m, 2.0 * DAMPING_RATIO * sqrt(stiffness_n_per_m * mass)
    )


def ring_outer_radius_m(specimen: Specimen) -> float:
    """Return the radius of the ring's rim [m]."""
    return _outer_radius_m(planets_in_ring(specimen)[1])


def _outer_radius_m(inner: InternalPair) -> float:
    return inner.gear.root_radius_m + RIM_MODULES * inner.gear.module_m


def _ring(section: Planetary, inner: InternalPair) -> PlanetaryBody:
    ring = inner.gear
    root, outer = ring.root_radius_m, _outer_radius_m(inner)
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


def _coupling(section: CouplingSection) -> Coupling:
    return Coupling(constant(section.stiffness_nm_per_rad), constant(section.damping_nm_s_per_rad))
