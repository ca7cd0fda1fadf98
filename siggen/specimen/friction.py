"""The friction law of a drawn specimen at an operating point."""

from __future__ import annotations

from math import hypot, pi

from siggen.config import Friction
from siggen.dynamics.friction.asperity_table import asperity_table
from siggen.dynamics.friction.contact_kinematics import effective_modulus
from siggen.dynamics.friction.fluid_friction import fluid_friction
from siggen.dynamics.friction.friction import FrictionLaw, composite_friction, constant_friction
from siggen.dynamics.friction.lubrication import LubricatedMesh
from siggen.dynamics.friction.oil import MINERAL_OILS
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import bounds, constant
from siggen.planning.specimen import OperatingPoint

LARGEST_FORCE = 10.0
"""End of the table's load axis over the static mesh force; beyond it the coefficient stays."""


def specimen_friction(
    section: Friction, pair: GearPair, point: OperatingPoint, *, rough_pits: bool = False
) -> FrictionLaw | None:
    """Return the law of a drawn section, None where friction is off; with `rough_pits` it knows the lands in damage.

    Raises
    ------
    ValueError
        If the roughness is beyond the data of the chosen friction of the oil.
    """
    slip_speed = constant(section.regular_speed_m_s)
    if section.model == "off":
        return None
    if section.model == "constant":
        return constant_friction(constant(section.coefficient), slip_speed)
    mesh = lubricated_mesh(section, pair, point)
    healthy_m, pitted_m = composite_roughness_m(section)
    table = asperity_table(
        mesh,
        [healthy_m, pitted_m] if rough_pits else [healthy_m],
        # The friction of the oil itself stays that of a healthy flank: its formulas end below the roughness of pits.
        fluid_friction(section.fluid, mesh, healthy_m),
        # Corners touch a little outside the path of contact; half-way to the base circles the radius is still finite.
        (0.5 * pair.contact_start_m, 0.5 * (pair.contact_end_m + pair.line_of_action_m)),
        LARGEST_FORCE * point.torque_nm / pair.pinion.base_radius_m,
    )
    return composite_friction(table, constant(section.boundary_coefficient), slip_speed)


def composite_roughness_m(section: Friction) -> tuple[float, float]:
    """Return the composite rms roughness of two healthy flanks, and of a healthy one on the lands inside damage [m]."""
    healthy_m = 1e-6 * constant(section.roughness_um)
    # Lands inside damage are never smoother than the flank around them.
    pitted_m = max(1e-6 * constant(section.pit_roughness_um), healthy_m)
    return hypot(healthy_m, healthy_m), hypot(pitted_m, healthy_m)


def lubricated_mesh(section: Friction, pair: GearPair, point: OperatingPoint) -> LubricatedMesh:
    """Return the lubricated pair of a drawn section at an operating point."""
    oil, temperature_c = MINERAL_OILS[str(section.oil)], constant(section.oil_temperature_c)
    speed = 2.0 * pi * point.speed_hz
    return LubricatedMesh(
        line_m=pair.line_of_action_m,
        speed_1_rad_s=speed,
        speed_2_rad_s=speed * pair.pinion.teeth / pair.gear.teeth,
        contact_length_m=pair.face_width_m,
        effective_modulus_pa=effective_modulus(pair.youngs_modulus_pa, pair.poisson_ratio),
        viscosity_pa_s=oil.viscosity_pa_s(temperature_c),
        pressure_viscosity_per_pa=oil.pressure_viscosity_per_pa(temperature_c),
        hardness_pa=1e9 * constant(section.hardness_gpa),
    )


def roughness_problem(section: Friction) -> str:
    """Return what the friction of the oil is allowed where the roughness is beyond its data, else nothing."""
    if section.model in {"off", "constant"}:
        return ""
    roughest_m = 1e-6 * bounds(section.roughness_um)[1]
    probe = LubricatedMesh(0.03, 200.0, 80.0, 0.02, 2.26e11, 0.1, 2e-8, 7e9)  # any: only the roughness is judged
    try:
        fluid_friction(section.fluid, probe, hypot(roughest_m, roughest_m))
    except ValueError as error:
        return str(error)
    return ""
