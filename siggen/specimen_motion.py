"""The motion of a drawn specimen at an operating point: its structure under the mesh law that it is configured with."""

from __future__ import annotations

from dataclasses import dataclass

from siggen.config import Dynamics, constant
from siggen.dataset.specimen import OperatingPoint
from siggen.dynamics.linear_motion import LinearMotion
from siggen.dynamics.load_lock import locked_load
from siggen.dynamics.mesh_force import mean_mesh_stiffness
from siggen.dynamics.pair_law import PairLaw, SqueezeFilm, pair_law
from siggen.dynamics.pair_motion import PairMotion
from siggen.dynamics.response import Motion
from siggen.dynamics.structure import Structure
from siggen.gears.geometry import GearPair
from siggen.gears.missing_material import MissingMaterial, TipRelief, missing_material
from siggen.gears.tables import MeshTables
from siggen.specimen_friction import specimen_friction


@dataclass(frozen=True, slots=True)
class SpecimenMesh:
    """What all records of one specimen and state share: structure and tables of its teeth."""

    pair: GearPair
    structure: Structure
    tables: MeshTables
    missing: MissingMaterial


def teeth_missing(dynamics: Dynamics, pair: GearPair, points: int) -> MissingMaterial:
    """Return the missing material of the teeth of a drawn `dynamics` section."""
    mesh = dynamics.mesh
    relief = TipRelief(1e-6 * constant(mesh.tip_relief_um), constant(mesh.tip_relief_length) * pair.base_pitch_m)
    return missing_material(pair, relief, corner_contact=mesh.corner_contact == "on", points=points)


def specimen_motion(dynamics: Dynamics, mesh: SpecimenMesh, point: OperatingPoint, step_s: float) -> Motion:
    """Return the motion, made for steps of `step_s` seconds; with friction the load holds the mean speed."""
    if dynamics.mesh.law == "linear":
        return LinearMotion(
            mesh.structure,
            mesh.tables,
            torque_nm=point.torque_nm,
            mesh_damping_ratio=constant(dynamics.mesh_damping_ratio),
            backlash_m=1e-6 * constant(dynamics.backlash_um),
            step_s=step_s,
            integrator=dynamics.method,
        )
    rubbing = dynamics.friction.model != "off"
    return PairMotion(
        locked_load(mesh.structure) if rubbing else mesh.structure,
        _law(dynamics, mesh, point),
        torque_nm=point.torque_nm,
        speed_hz=point.speed_hz,
        reference_stiffness_n_per_m=mean_mesh_stiffness(mesh.tables),
        step_s=step_s,
    )


def _law(dynamics: Dynamics, mesh: SpecimenMesh, point: OperatingPoint) -> PairLaw:
    section = dynamics.mesh
    film = SqueezeFilm(
        constant(section.oil_viscosity_pa_s), mesh.pair.face_width_m, 1e-6 * constant(section.film_floor_um)
    )
    return pair_law(
        mesh.tables,
        mesh.missing,
        line_of_action_m=mesh.pair.line_of_action_m,
        damping_ratio=constant(dynamics.mesh_damping_ratio),
        equivalent_mesh_mass_kg=mesh.structure.equivalent_mesh_mass_kg,
        backlash_m=1e-6 * constant(dynamics.backlash_um),
        friction=specimen_friction(dynamics.friction, mesh.pair, point),
        film=film if section.squeeze_film == "on" else None,
    )
