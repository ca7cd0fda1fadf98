"""The friction law of a drawn specimen at an operating point."""

from __future__ import annotations

from functools import lru_cache
from math import copysign, hypot, pi, sqrt
from typing import NamedTuple

from siggen.gearbox.specimen import OperatingPoint
from siggen.gears.gear_pair import GearPair
from siggen.mesh.asperities import AsperityTable, asperity_table, share_at
from siggen.mesh.friction import FrictionLaw, PitchPoint, composite_friction, constant_friction, slip_speed
from siggen.mesh.lubrication import LubricatedMesh, effective_modulus, relative_radius
from siggen.mesh.oil import MINERAL_OILS
from siggen.mesh.tooth_law import CONSTANT, OFF, FlankFriction

LARGEST_FORCE = 10.0
"""End of the table's load axis over the static mesh force; beyond it the coefficient stays."""
LEAST_LINE_LOAD_N_PER_M = 1e3
"""A Hertz band of some 10 µm."""


def specimen_friction(
    flanks: FlankFriction, pair: GearPair, point: OperatingPoint, *, rough_pits: bool = False
) -> FrictionLaw | None:
    """Return the law of a pair, None where friction is off; with `rough_pits` it knows rough land."""
    if flanks.model == OFF:
        return None
    if flanks.model == CONSTANT:
        return constant_friction(flanks.coefficient)
    mesh, force_n = lubricated_mesh(flanks, pair, point), mean_force_n(pair, point)
    healthy_m, pitted_m = composite_roughness_m(flanks)
    table = _table(
        mesh,
        (healthy_m, pitted_m) if rough_pits else (healthy_m,),
        _places_m(pair),
        LARGEST_FORCE * force_n,
    )
    slip_m_s = slip_speed(mesh, pitch_point(pair, mesh), force_n, healthy_m)
    return composite_friction(table, mesh.boundary_friction, slip_m_s)


def _places_m(pair: GearPair) -> tuple[float, float]:
    """Return between which positions flanks may touch [m].

    Corners touch a little outside the path of contact; half-way to the base circles the radius is still finite.
    """
    start, end, line = 0.5 * pair.contact_start_m, pair.contact_end_m, pair.line_of_action_m
    return start, 0.5 * (end + line) if line > 0.0 else end + start  # no base circle lies behind a hollow flank


@lru_cache(maxsize=8)  # states of a gearbox share them
def _table(
    mesh: LubricatedMesh, roughness_m: tuple[float, ...], range_m: tuple[float, float], largest_force_n: float
) -> AsperityTable:
    return asperity_table(mesh, roughness_m, range_m, largest_force_n)


def mean_force_n(pair: GearPair, point: OperatingPoint) -> float:
    """Return the mean force of the teeth [N], at least that of a light contact: idling flanks touch now and then."""
    return max(abs(point.torque_nm) / pair.pinion.base_radius_m, light_force_n(pair))


def light_force_n(pair: GearPair) -> float:
    """Return the force of a light contact [N], the least that counts where flanks rattle."""
    return LEAST_LINE_LOAD_N_PER_M * pair.face_width_m


def pitch_point(pair: GearPair, mesh: LubricatedMesh) -> PitchPoint:
    """Return where a pair passes the pitch point; half a tooth lies behind either flank."""
    return PitchPoint(
        pair.pitch_point_m, mesh.speed_1_rad_s * pair.pinion.base_radius_m, 0.25 * pi * pair.pinion.module_m
    )


def composite_roughness_m(flanks: FlankFriction) -> tuple[float, float]:
    """Return the composite rms roughness of two healthy flanks, and of a healthy one on rough land [m]."""
    healthy_m = flanks.roughness_m
    # Land beside damage is never smoother than the flank around it.
    pitted_m = max(flanks.pit_roughness_m, healthy_m)
    return hypot(healthy_m, healthy_m), hypot(pitted_m, healthy_m)


def lubricated_mesh(flanks: FlankFriction, pair: GearPair, point: OperatingPoint) -> LubricatedMesh:
    """Return a lubricated pair at an operating point."""
    oil, temperature_c = MINERAL_OILS[flanks.oil], flanks.oil_temperature_c
    speed = 2.0 * pi * point.speed_hz
    return LubricatedMesh(
        line_m=pair.line_of_action_m,
        speed_1_rad_s=speed,
        # of a ring, which turns the same way, negative as its base radius
        speed_2_rad_s=copysign(speed * pair.pinion.teeth / pair.gear.teeth, pair.gear.signed_base_radius_m),
        contact_length_m=pair.face_width_m,
        effective_modulus_pa=effective_modulus(pair.youngs_modulus_pa, pair.poisson_ratio),
        viscosity_pa_s=oil.viscosity_pa_s(temperature_c),
        pressure_viscosity_per_pa=oil.pressure_viscosity_per_pa(temperature_c),
        viscosity_fall_per_k=oil.viscosity_fall_per_k(temperature_c),
        inlet_temperature_k=temperature_c + 273.15,
        boundary_friction=flanks.boundary_friction,
    )


# Asperities of a drawn specimen at an operating point: what they carry of the load, and how wide the contact is.


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
