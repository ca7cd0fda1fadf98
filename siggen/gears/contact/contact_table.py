r"""ContactTable: force of a pair over position and approach, with the contact solved across the face.

Derived from `face_force`. At a column of the table (a position of a kind of pair) the force is a monotone cubic of
the approach beyond first touch, with a continuous slope that grows from 0 there. Between columns it is linear, at equal
approach beyond first touch: what a gap without land does most, the sink of the whole pair, stands in `touch_m` on the
fine grid of the stiffness, so that columns only carry how the load spreads. Away from damage all kinds share the
columns of the healthy pair.

Where gears tilt, the table holds the stored energy along rays in the plane of approach and tilt (`tilt_rays`), from no
load to a face that rests on one end; force and moment are its derivatives. What misalignment takes away stands in the
lead, not in the tilt. The ray without tilt is the curve of parallel gears.

Nodes lie at u k², u of the pair alone: a larger force of the set adds nodes at the end, and what the others hold, where
columns are and what a slice is stay as they were. Beyond the last node the force goes on with the last slope.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.gears.contact.column_halving import halved
from siggen.gears.contact.kind_row import KindRow, felt, first_touch, kind_row, pits_of_kind, touch_along
from siggen.gears.contact.table_columns import FORCE, ROUGH, TableSolver, column_curves, table_solver
from siggen.gears.contact.table_options import TableOptions, face_slices
from siggen.gears.contact.tilted_columns import ROUGH_BEND, tilted_columns
from siggen.gears.damage.tooth_damage import Damage, has_extent
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.mesh_tables import pair_kinds
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

COARSEST = 64
"""Intervals of the fine grid per column near damage before refining."""
BEND = 4e-3
"""Largest deviation of a column's forces from the mean of its neighbours, of the force and a tenth of the largest.

Up to the reference force: where columns are may not depend on how far they go."""


class ContactTable(NamedTuple):
    """Tables on the fine grid of the stiffness, `points` positions from s_A to s_E.

    `touch_m` (rows, points): approach at which a pair of this kind first touches [m]; `column`, `gain` (rows, points -
    1): column at the start of a fine interval, how many columns it spans; `curves` (columns, nodes, rays, values): see
    FORCE; `unit_m`: u; `lead_m`: least missing material across the face, which every pair has to add;
    `half_face_m`: h of `tilt_rays`, 0 where gears stay parallel.
    """

    touch_m: FloatArray
    column: FloatArray
    gain: FloatArray
    curves: FloatArray
    unit_m: float
    lead_m: float = 0.0
    half_face_m: float = 0.0

    @property
    def upright(self) -> FloatArray:
        """Curves without tilt (columns, nodes, values), whose first four are force, slope and shares."""
        return self.curves[:, :, self.curves.shape[2] // 2]


def contact_table(
    pair: GearPair,
    damage: Damage,
    stiffness: StiffnessOptions,
    options: TableOptions,
    points: int = 2049,
    lead_m: FloatArray | None = None,
) -> ContactTable:
    """Return the table of a pair with damage on any teeth.

    Parameters
    ----------
    pair : GearPair
    damage : Damage
        Pits and spalls; those without extent in some direction are none.
    stiffness : StiffnessOptions
        Of the teeth; the contact is Weber and Banaschek's, whatever `hertz` says.
    options : TableOptions
    points : int
        Positions of the fine grid from s_A to s_E.
    lead_m : (slices,) or None
        Missing material across the face in the middle of the slices (`face_slices`), the same for all pairs [m].

    Raises
    ------
    ValueError
        If a damaged tooth does not exist, a pit is impossible or a contact cannot be solved.
    """
    damage = tuple(pit for pit in damage if has_extent(pit))
    lead = np.zeros(face_slices(pair, options)) if lead_m is None else np.asarray(lead_m, dtype=np.float64)
    # The least missing material counts in the places of the teeth.
    even = lead - lead.min()
    healthy, row = _healthy(pair, stiffness, options, points, tuple(even.tolist()))
    solver = table_solver(pair, stiffness, options, even)
    parts = [(healthy.touch_m[0], healthy.column[0], healthy.gain[0], healthy.curves)]
    for kind in pair_kinds(pair, damage)[1:]:
        first = sum(len(curves) for *_, curves in parts)
        damaged = kind_row(pair, stiffness, options, points, pits_of_kind(damage, kind), row)
        parts.append(_damaged(solver, damaged, row, healthy, first))
    touch, column, gain, curves = (list(values) for values in zip(*parts, strict=True))
    joined = np.concatenate(curves)
    half_face = 0.5 * pair.face_width_m if options.tilts else 0.0
    table = ContactTable(
        np.stack(touch), np.stack(column), np.stack(gain), joined, healthy.unit_m, float(lead.min()), half_face
    )
    for array in table[:4]:
        array.setflags(write=False)
    return table


@lru_cache(maxsize=8)  # states of a specimen share the healthy columns of every mesh
def _healthy(
    pair: GearPair, stiffness: StiffnessOptions, options: TableOptions, points: int, lead_m: tuple[float, ...]
) -> tuple[ContactTable, KindRow]:
    solver = table_solver(pair, stiffness, options, np.array(lead_m))
    row = kind_row(pair, stiffness, options, points)
    chosen = np.round(np.linspace(0, points - 1, min(options.healthy_columns, points))).astype(np.int64)
    curves = tilted_columns(solver, row, chosen, column_curves(solver, row, chosen))
    at = np.interp(np.arange(points), chosen, np.arange(chosen.size))
    touch = first_touch(pair, row, np.arange(points), solver.lead_m)
    return ContactTable(touch[None], at[None, :-1], np.diff(at)[None], curves, float(solver.node_m[1])), row


def _damaged(
    solver: TableSolver, row: KindRow, healthy_row: KindRow, healthy: ContactTable, first: int
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return touch (points,), column and gain (points - 1,) and the curves of one kind, numbered from `first`."""
    differs = felt(solver.pair, row, healthy_row)
    column, gain = healthy.column[0].copy(), healthy.gain[0].copy()
    parts = [np.zeros((0, *healthy.curves.shape[1:]))]
    for run in _runs(np.flatnonzero(differs[1:] | differs[:-1])):
        ends, curves = _refined(solver, row, run)
        intervals = np.arange(run[0], run[-1] + 1)
        starts = np.interp(intervals, ends, np.arange(ends.size))
        column[intervals] = first + starts
        gain[intervals] = np.interp(intervals + 1, ends, np.arange(ends.size)) - starts
        parts.append(curves)
        first += ends.size
    return touch_along(solver.pair, row, healthy.touch_m[0], solver.lead_m), column, gain, np.concatenate(parts)


def _runs(intervals: IntArray) -> list[IntArray]:
    """Return the parts of ascending numbers that follow each other without a gap."""
    if intervals.size == 0:
        return []
    return list(np.split(intervals, np.flatnonzero(np.diff(intervals) > 1) + 1))


def _refined(solver: TableSolver, row: KindRow, run: IntArray) -> tuple[IntArray, FloatArray]:
    """Return fine points and curves of the columns of a run: halved where the middle is not the mean of the ends."""
    first, last = int(run[0]), int(run[-1]) + 1
    wanted = np.unique(np.append(np.arange(first, last, COARSEST), last)).tolist()
    end = solver.reference + 1

    def bent(low: FloatArray, middle: FloatArray, high: FloatArray, weight: float) -> bool:
        if not _is_mean(low[:end, 0, FORCE], middle[:end, 0, FORCE], high[:end, 0, FORCE], weight):
            return True
        off = (1.0 - weight) * low[:end, 0, ROUGH] + weight * high[:end, 0, ROUGH] - middle[:end, 0, ROUGH]
        return bool(np.any(np.abs(off) > ROUGH_BEND))

    ends, curves = halved(wanted, lambda places: column_curves(solver, row, places), bent, solver.options.finest)
    return ends, tilted_columns(solver, row, ends, curves)


def _is_mean(low: FloatArray, middle: FloatArray, high: FloatArray, weight: float) -> bool:
    """Whether forces (nodes,) of a column without tilt are those between its neighbours'."""
    mean = (1.0 - weight) * low + weight * high
    return bool(np.all(np.abs(mean - middle) <= BEND * (middle + 0.1 * middle[-1])))
