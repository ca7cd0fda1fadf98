"""A drawn train or planetary set in SI.

From drawn sections to the rotors, shafts, couplings and bearings of a train in SI.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import pi, sqrt

from siggen.config import CouplingSection, Dynamics, Planetary, RotorSection, ShaftSection, Stage
from siggen.config.planetary import RING
from siggen.drivetrain.bearings import BallBearing
from siggen.drivetrain.gear_stage import (
    STEEL_DENSITY_KG_M3,
    Bearing,
    CommonShaft,
    Coupling,
    GearStage,
    NextStage,
    PlanetaryBody,
    PlanetaryStage,
    Rotor,
    Shaft,
    disc_inertia_kg_m2,
    disc_mass_kg,
)
from siggen.gearbox.specimen import ToothMesh
from siggen.gearbox.teeth import Drawing, Teeth, mesh_seed, on_one_body, sharing
from siggen.gears.gear_pair import GearPair
from siggen.gears.planetary import InternalPair, PlanetarySet, ring_begins_pitches
from siggen.gears.spur_gear import SpurGear
from siggen.keys.number import Number, constant, each_of
from siggen.names import Side


def gear_stage(dynamics: Dynamics, pair: GearPair) -> GearStage:
    """Return motor, gears and load of a drawn section; a gear without given mass is a steel disc with its bore."""
    return GearStage(
        working_pressure_angle_rad=pair.working_pressure_angle_rad,
        pinion=rotor_numbers(dynamics.pinion, pair.pinion, pair.face_width_m),
        gear=rotor_numbers(dynamics.gear, pair.gear, pair.face_width_m),
        motor_inertia_kg_m2=constant(dynamics.motor_inertia_kg_m2),
        load_inertia_kg_m2=constant(dynamics.load_inertia_kg_m2),
        input_coupling=coupling_numbers(dynamics.input_coupling),
        output_coupling=coupling_numbers(dynamics.output_coupling),
        base_helix_rad=pair.base_helix_rad,
    )


def rotor_numbers(section: RotorSection, gear: SpurGear, face_width_m: float) -> Rotor:
    """Return a gear with both bearings of its shaft."""
    mass, inertia, bearing = section.mass_kg, section.inertia_kg_m2, section.bearing
    stiffness_x, stiffness_y = map(constant, each_of(bearing.stiffness_n_per_m, 2))
    time_s = None if bearing.damping_time_s is None else constant(bearing.damping_time_s)
    if time_s is not None:
        damping_x, damping_y = time_s * stiffness_x, time_s * stiffness_y
    else:
        damping_x, damping_y = map(constant, each_of(bearing.damping_n_s_per_m, 2))
    return Rotor(
        base_radius_m=gear.base_radius_m,
        mass_kg=disc_mass_kg(gear, face_width_m) if mass is None else constant(mass),
        inertia_kg_m2=disc_inertia_kg_m2(gear, face_width_m) if inertia is None else constant(inertia),
        bearing=Bearing(
            stiffness_x,
            stiffness_y,
            damping_x,
            damping_y,
            stiffness_z_n_per_m=constant(bearing.axial_stiffness_n_per_m),
            damping_time_s=time_s,
        ),
    )


def coupling_numbers(section: CouplingSection) -> Coupling:
    """Return a torsional shaft with its coupling."""
    return Coupling(constant(section.stiffness_nm_per_rad), constant(section.damping_nm_s_per_rad))


def ball_bearings(dynamics: Dynamics) -> tuple[tuple[Side, BallBearing], ...]:
    """Return each of both bearings of the shafts, pinion and gear, whose stiffness follows the load."""
    sections = {Side.DRIVER: dynamics.pinion.bearing.geometry, Side.DRIVEN: dynamics.gear.bearing.geometry}
    return tuple((side, section.bearing()) for side, section in sections.items() if section is not None)


def bending_shafts(dynamics: Dynamics, stage: GearStage, pair: GearPair) -> tuple[Shaft, Shaft] | None:
    """Return the shafts that bend, each with the moment of inertia of its gear about a diameter: J/2 + m b²/12."""
    if dynamics.shafts is None:
        return None
    pairs = ((dynamics.shafts.driver, stage.pinion), (dynamics.shafts.driven, stage.gear))
    pinion, gear = (shaft_numbers(section, rotor, pair) for section, rotor in pairs)
    return pinion, gear


def shaft_numbers(section: ShaftSection, rotor: Rotor, pair: GearPair) -> Shaft:
    """Return a shaft that bends, with its gear."""
    return Shaft(
        span_m=1e-3 * constant(section.bearing_span_mm),
        gear_share=constant(section.gear_position),
        diameter_m=1e-3 * constant(section.diameter_mm),
        youngs_modulus_pa=pair.youngs_modulus_pa,
        poisson_ratio=pair.poisson_ratio,
        tilt_inertia_kg_m2=0.5 * rotor.inertia_kg_m2 + rotor.mass_kg * pair.face_width_m**2 / 12.0,
    )


def next_stages(dynamics: Dynamics, stages: Sequence[Stage], meshes: Sequence[ToothMesh]) -> Iterator[NextStage]:
    """Yield the further meshes; a shaft is as thick as the thinner bore of its two gears."""
    # a pinion is a disc, or the gear in front where it is that
    front = [dynamics.gear, *(stage.gear for stage in stages)]
    for stage, seat, (before, mesh) in zip(stages, front, pairwise(meshes), strict=False):
        pair, width_m = mesh.pair, (before if mesh.idler else mesh).pair.face_width_m
        yield NextStage(
            working_pressure_angle_rad=pair.working_pressure_angle_rad,
            pinion=rotor_numbers(seat if mesh.idler else RotorSection(), pair.pinion, width_m),
            gear=rotor_numbers(stage.gear, pair.gear, pair.face_width_m),
            shaft=None if mesh.idler else _common_shaft(stage, before.pair, pair),
            direction_rad=mesh.direction_rad,
        )


def _common_shaft(stage: Stage, before: GearPair, pair: GearPair) -> CommonShaft:
    span_m = 2.0 * (before.face_width_m + pair.face_width_m)
    return CommonShaft(
        span_m=span_m if isinstance(stage.span_mm, str | None) else 1e-3 * constant(stage.span_mm),
        diameter_m=2.0 * min(before.gear.bore_radius_m, pair.pinion.bore_radius_m),
        youngs_modulus_pa=pair.youngs_modulus_pa,
        poisson_ratio=pair.poisson_ratio,
    )


# A drawn planetary set in SI: its bodies on their supports, and the teeth of its 2N meshes.
#
# The sun meshes with each planet, then each planet with the ring. Each mesh is a pair of its own, with teeth drawn for
# it; the sun and the ring are one and the same in all of theirs. A planet's flanks towards the sun are not those
# towards the ring, so damage of a planet is in one mesh: that of the first planet with the sun. Damage of sun and ring
# is in all of their meshes, as its teeth come round. Bodies are steel discs, the ring an annulus: r²/2 (outer and
# inner) about the axis. A body of mass m on a support k is damped by 2 ζ √(k m). What holds the ring round its rim
# keeps it from turning too: evenly spread springs and dampers that resist along and across make k R² (derived).

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
    sun, planet = (rotor_numbers(RotorSection(), gear, pair.face_width_m) for gear in (pair.pinion, pair.gear))
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


def planetary_teeth(
    drawing: Drawing, rotors: Sequence[RotorSection], seed: int, teeth: PlanetarySet, pair: GearPair, ring: InternalPair
) -> tuple[Teeth, ...]:
    """Return the teeth of the sun with each planet, then of each planet with the ring.

    Parameters
    ----------
    drawing : draws the teeth of one mesh
    rotors : of every pinion and gear, for how far their seats lie off their bearings
    seed : int, of the gearbox
    teeth : PlanetarySet
    pair, ring : sun and planet; planet and ring
    """
    later, of_ring = _axes_later_rad(teeth, pair, ring), mesh_seed(seed, RING)
    first = drawing(pair, rotors, seed, "", 1.0)
    suns, rings = [first], [on_one_body(drawing(ring, rotors, of_ring, RING, 1.0), first, later[0])]
    for i in range(1, len(later)):
        suns.append(sharing(drawing(pair, rotors, mesh_seed(seed, f"planet_{i}"), "", 1.0), first, Side.DRIVER))
        own = sharing(drawing(ring, rotors, mesh_seed(of_ring, f"planet_{i}"), RING, 1.0), rings[0], Side.DRIVEN)
        rings.append(on_one_body(own, suns[i], later[i]))
    return *suns, *rings


def _axes_later_rad(teeth: PlanetarySet, pair: GearPair, inner: InternalPair) -> list[float]:
    """Return by how much the phase of a planet's eccentricity is later in its mesh with the ring than with the sun.

    Derived: moved by e at the angle β from the radius outwards, a planet stands back from the sun by e sin(β + α_s),
    from the ring by e sin(β - α_r); both phases count its turning, opposite to β, from where that mesh has turned none.
    """
    angles = pair.working_pressure_angle_rad + inner.working_pressure_angle_rad
    lag, both = ring_begins_pitches(pair, inner), zip(teeth.sun_begins, teeth.ring_begins, strict=True)
    return [angles - 2.0 * pi * (lag + float(ring - sun)) / teeth.planet for sun, ring in both]
