"""Runs of the standard gearbox with casing under the pair law, and what they are made of."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from siggen.damage.part import Damage
from siggen.drivetrain.structure import Structure
from siggen.gears.gear_pair import GearPair, SpurGear
from siggen.gears.missing_material import MissingMaterial, TipRelief, missing_material
from siggen.mesh.contact_table import ContactTable, contact_table
from siggen.mesh.friction import FrictionLaw
from siggen.mesh.mesh_force import mean_mesh_stiffness
from siggen.mesh.mesh_stiffness import StiffnessOptions
from siggen.mesh.mesh_tables import MeshTables, mesh_tables
from siggen.mesh.pair_law import MeshConstants, PairLaw, pair_law
from siggen.mesh.table_options import TableOptions
from siggen.mesh.tooth_law import DampingLaw
from siggen.motion.equations import no_inputs
from siggen.motion.pair_motion import MeanState, PairMesh, PairMotion
from siggen.record.contact import whole_face

RELIEF = TipRelief(8e-6, 0.25 * 8.856e-3)
TEETH = StiffnessOptions("base_circle", "sainsot", "profile")
TORQUE = 30.0
MESHES = 18
LARGEST_N = 4000.0
"""Up to which contacts are tabulated: three times the force of the torque."""


@cache
def gear_pair() -> GearPair:
    def wheel(teeth: int, bore_m: float) -> SpurGear:
        return SpurGear(
            teeth=teeth,
            module_m=3e-3,
            pressure_angle_rad=np.radians(20.0),
            profile_shift=0.0,
            addendum_coefficient=1.0,
            clearance_coefficient=0.25,
            bore_radius_m=bore_m,
            body_ratio=1.0,  # rings held in their bores, as in the independent computations
        )

    return GearPair(wheel(18, 0.01), wheel(47, 0.015), 0.02, 206e9, 0.3)


@cache
def tables() -> MeshTables:
    return mesh_tables(gear_pair(), (), TEETH)


def constant_tables(stiffness: float = 1.57e8, contact_ratio: float = 2.0) -> MeshTables:
    """Return pairs of one stiffness; with a contact ratio of 2 their sum never changes."""
    pair = gear_pair()
    length = contact_ratio * pair.base_pitch_m
    start = pair.pitch_point_m - 0.5 * length
    return MeshTables(
        start, start + length, length / 64, pair.base_pitch_m, np.full((1, 65), stiffness), np.zeros((18, 47), np.int32)
    )


def exact_involutes(over: MeshTables) -> MissingMaterial:
    """Return teeth that miss nothing and end where the tables do."""
    pair = gear_pair()
    whole = missing_material(pair, None, corner_contact=False, points=2)
    return MissingMaterial(over.start_m, over.end_m, whole.pinion, whole.gear)


def law(
    missing: MissingMaterial | None = None,
    over: MeshTables | None = None,
    *,
    damping_ratio: float | DampingLaw = 0.07,
    backlash_m: float = 80e-6,
    mass: float = 0.2124,
    friction: FrictionLaw | None = None,
    contact: ContactTable | None = None,
    coupling_m_per_n: np.ndarray | None = None,
) -> PairLaw:
    return pair_law(
        tables() if over is None else over,
        missing_material(gear_pair(), RELIEF) if missing is None else missing,
        MeshConstants(gear_pair().line_of_action_m, mass, backlash_m),
        damping_ratio=damping_ratio,
        friction=friction,
        contact=contact,
        coupling_m_per_n=coupling_m_per_n,
    )


@cache
def contact_of(damage: Damage = (), points: int = 1025) -> ContactTable:
    """Return the contact of teeth with damage of sharp edges, solved across the face."""
    return contact_table(gear_pair(), damage, TEETH, TableOptions(LARGEST_N, edge_radius_m=0.0), points)


def contact_law(damage: Damage = (), **other: Any) -> PairLaw:
    """Return the law of teeth with damage; others as of `law`."""
    table = contact_of(damage)
    return law(over=whole_face(gear_pair(), damage, TEETH, table.touch_m.shape[1]), contact=table, **other)


def motion(
    structure: Structure,
    chosen: PairLaw,
    *,
    torque_nm: float = TORQUE,
    speed_hz: float = 30.0,
    step_s: float = 1.0 / (51200 * 4),
    stiffness: float | None = None,
) -> PairMotion:
    mean = mean_mesh_stiffness(tables()) if stiffness is None else stiffness
    return PairMotion(structure, [PairMesh(chosen, mean)], mean=MeanState(torque_nm, speed_hz), step_s=step_s)


def settled(run: PairMotion, speed_hz: float, step_s: float, steps: int, settle_s: float = 0.4):
    """Return pinion angles (steps,) and states (steps, 2n) after `settle_s` from the static start."""
    before = round(settle_s / step_s)
    pitches = MESHES * speed_hz * step_s * np.arange(before + steps + 1) + 0.3
    states = np.empty((before + 1, 2 * len(run.structure.coordinates)))
    states[0] = run.start(pitches[0])
    run.advance(pitches[: before + 1], no_inputs(pitches[: before + 1]), states)
    kept = np.empty((steps + 1, states.shape[1]))
    kept[0] = states[-1]
    run.advance(pitches[before:], no_inputs(pitches[before:]), kept)
    return pitches[before:], kept


def columns(run: PairMotion, states: np.ndarray, pitches: np.ndarray) -> dict[str, np.ndarray]:
    return dict(zip(run.internal_names, run.internals(states, pitches).T, strict=True))
