"""The 18/47 gearbox with casing of the standard set: module 3 mm, 30 N m, bolts of 8e7 and 1.5e8 N/m."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from siggen.drivetrain.gear_stage import Bearing, Bolts, Casing, Coupling, GearStage, Rotor
from siggen.drivetrain.structure import Structure, vector
from tests.dynamics.trains import casing_structure, eight_dof

PRESSURE_ANGLE = np.radians(20.0)
BASE_RADIUS_1 = 0.5 * 3e-3 * 18 * np.cos(PRESSURE_ANGLE)
BASE_RADIUS_2 = 0.5 * 3e-3 * 47 * np.cos(PRESSURE_ANGLE)
MEAN_STIFFNESS = 3.14e8
BOLT_PLACES = ((0.09, 0.0), (0.09, 0.0), (-0.09, 0.0), (-0.09, 0.0))


def shaft_damping(stiffness: float, first: float, second: float) -> float:
    """Return 2 ζ √(k J_a J_b/(J_a + J_b)) with ζ = 5 %."""
    return 2.0 * 0.05 * float(np.sqrt(stiffness * first * second / (first + second)))


def bearing(stiffness: float, mass: float) -> Bearing:
    damping = 2.0 * 0.03 * float(np.sqrt(stiffness * mass))
    return Bearing(stiffness, stiffness, damping, damping)


def make_stage(bearing_stiffness: float = 2e8) -> GearStage:
    return GearStage(
        working_pressure_angle_rad=PRESSURE_ANGLE,
        pinion=Rotor(BASE_RADIUS_1, 1.0, 1.6e-4, bearing(bearing_stiffness, 1.0)),
        gear=Rotor(BASE_RADIUS_2, 3.0, 6.4e-3, bearing(bearing_stiffness, 3.0)),
        motor_inertia_kg_m2=4e-3,
        load_inertia_kg_m2=1e-2,
        input_coupling=Coupling(6300.0, shaft_damping(6300.0, 4e-3, 1.6e-4)),
        output_coupling=Coupling(2100.0, shaft_damping(2100.0, 6.4e-3, 1e-2)),
    )


def make_casing(**changes) -> Casing:
    casing = Casing(
        mass_kg=20.0,
        inertia_kg_m2=0.25,
        bolts=Bolts(8e7, 1.5e8, 0.04, BOLT_PLACES),
        pinion_place_m=(0.04875, 0.0),
        sensor_places_m={"lid": (0.06, 0.05)},
    )
    return replace(casing, **changes)


def make_structure(**changes) -> Structure:
    return casing_structure(make_stage(), make_casing(**changes))


def grounded_structure() -> Structure:
    """Return a casing that does not move: a million times the mass and inertia on bolts as much stiffer."""
    return casing_structure(
        make_stage(),
        make_casing(mass_kg=2e7, inertia_kg_m2=2.5e5, bolts=Bolts(8e13, 1.5e14, 0.04, BOLT_PLACES)),
    )


def torsional(stage: GearStage) -> Structure:
    """Return the rotations alone, q = [θ_m, θ_1, θ_2, θ_L]: the limit of rigid supports."""
    whole = eight_dof(stage)
    turning = [i for i, name in enumerate(whole.coordinates) if name.startswith("theta")]
    mesh, square = whole.mesh, np.ix_(turning, turning)
    coordinates = tuple(whole.coordinates[i] for i in turning)
    return replace(
        whole,
        coordinates=coordinates,
        mass=whole.mass[square],
        damping=whole.damping[square],
        stiffness=whole.stiffness[square],
        meshes=(replace(mesh, vector=mesh.vector[turning], sliding=np.ascontiguousarray(mesh.sliding[:, turning])),),
        lines=np.ascontiguousarray(whole.lines[:, turning]),
        torque_vector=whole.torque_vector[turning],
        motions={"pinion_rim/tangential": vector(coordinates, {"theta_pinion": BASE_RADIUS_1})},
        bearing_forces={},
        bearing_directions={},
    )
