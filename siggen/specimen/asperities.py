"""Asperities of a drawn specimen at an operating point: what they carry of the load, and how wide the contact is."""

from __future__ import annotations

from math import pi, sqrt
from typing import NamedTuple

from siggen.dynamics.friction.asperity_table import share_at
from siggen.dynamics.friction.contact_kinematics import effective_modulus, relative_radius
from siggen.dynamics.friction.reversal import slip_speed
from siggen.dynamics.mesh.tooth_law import FlankFriction
from siggen.gearbox.specimen import OperatingPoint
from siggen.gears.geometry.gear_pair import GearPair
from siggen.specimen.friction import composite_roughness_m, lubricated_mesh, mean_force_n, pitch_point


def asperity_share(flanks: FlankFriction, pair: GearPair, point: OperatingPoint) -> float:
    """Return the share of the mean load that asperities of healthy flanks carry at the pitch point, whatever rubs."""
    force_n = mean_force_n(pair, point)
    mesh, roughness_m = lubricated_mesh(flanks, pair, point), composite_roughness_m(flanks)[0]
    return float(share_at(mesh, roughness_m, pair.pitch_point_m, force_n))


class FrictionTurn(NamedTuple):
    """Friction where the sliding turns: the coefficient that turns, and the speed v_0 over which it does [m/s]."""

    coefficient: float
    slip_speed_m_s: float


def friction_turn(flanks: FlankFriction, pair: GearPair, point: OperatingPoint) -> FrictionTurn:
    """Return how the friction of a mixed film turns at the pitch point: asperities do, the film is at rest there."""
    force_n = mean_force_n(pair, point)
    mesh = lubricated_mesh(flanks, pair, point)
    speed = slip_speed(mesh, pitch_point(pair, mesh), force_n, composite_roughness_m(flanks)[0])
    return FrictionTurn(asperity_share(flanks, pair, point) * mesh.boundary_friction, speed)


def contact_half_width_m(pair: GearPair, point: OperatingPoint) -> float:
    """Return the half width of Hertz's line contact under the mean load at the pitch point [m]: √(8 F R/(π L E'))."""
    radius = relative_radius(pair.pitch_point_m, pair.line_of_action_m)
    modulus = effective_modulus(pair.youngs_modulus_pa, pair.poisson_ratio)
    return float(sqrt(8.0 * mean_force_n(pair, point) * radius / (pi * pair.face_width_m * modulus)))
