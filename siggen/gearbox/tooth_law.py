"""From a drawn section `dynamics` to the law of the meshes in SI."""

from __future__ import annotations

from siggen.config import Dynamics, Friction
from siggen.dynamics.mesh.damping import DampingLaw
from siggen.dynamics.mesh.tooth_law import FlankFriction, ToothLaw
from siggen.keys.drawing import draw
from siggen.keys.number import MIDDLE, constant


def tooth_law(dynamics: Dynamics) -> ToothLaw:
    """Return how the teeth of a drawn section push and rub."""
    mesh, ratio = dynamics.mesh, constant(dynamics.mesh_damping_ratio)
    shares = mesh.structure_damping_ratio, mesh.film_damping_ratio, mesh.asperity_damping_ratio
    return ToothLaw(
        kind=mesh.law,
        method=dynamics.method,
        steps_per_sample=dynamics.steps_per_sample,
        tolerance=dynamics.integration_tolerance,
        damping_ratio=ratio,
        damping=ratio if mesh.damping == "constant" else DampingLaw(*map(constant, shares)),
        backlash_m=1e-6 * constant(dynamics.backlash_um),
        relief_m=1e-6 * constant(mesh.tip_relief_um),
        edge_radius_m=1e-3 * constant(mesh.pit_edge_radius_mm),
        section_loss=mesh.damage == "all",
        tilts=dynamics.shafts is not None,
        friction=_flank_friction(dynamics.friction, dynamics.rubbing),
    )


def typical_tooth_law() -> ToothLaw:
    """Return how teeth push and rub where a file says nothing of it, at the middle of what is drawn."""
    return tooth_law(draw(Dynamics(), lambda _: MIDDLE, "dynamics"))


def _flank_friction(section: Friction, model: str) -> FlankFriction:
    return FlankFriction(
        model=model,
        coefficient=constant(section.coefficient),
        oil=str(section.oil),
        oil_temperature_c=constant(section.oil_temperature_c),
        roughness_m=1e-6 * constant(section.roughness_um),
        pit_roughness_m=1e-6 * constant(section.pit_roughness_um),
        boundary_friction=constant(section.boundary_friction),
    )
