r"""ContactTable: force of a pair over position and approach, with the contact solved across the face.

Derived from `face_force`. At a column of the table (a position of a kind of pair) the force is a monotone cubic of
the approach beyond first touch, with a continuous slope that grows from 0 there. Between columns it is linear, at equal
approach beyond first touch: what a gap without land does most, the sink of the whole pair, stands in `touch_m` on the
fine grid of the stiffness, so that columns only carry how the load spreads. Away from damage all kinds share the
columns of the healthy pair.

Where gears tilt, the energy is expanded about no tilt, W = W_0(d) + M(d) θ + ½ M_θ(d) θ², so that force and moment,

    F = W_0' + M' θ + ½ M_θ' θ²,   moment = M + M_θ θ,

are derivatives of one energy: no closed loop in (d, θ) does work. Loaded tilts are small beside the approach, since
shafts are much stiffer against tilting than the contact is; what misalignment takes away stands in the lead, not in
θ.

Nodes lie at D (k/(n - 1))² up to the largest approach D; beyond it the force goes on with the last slope.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.gears.contact.face_gaps import FaceGaps, face_gaps
from siggen.gears.contact.face_slices import FaceSlices
from siggen.gears.contact.force_curve import force_curve
from siggen.gears.contact.newton_matrix import SolverRoom, solver_room
from siggen.gears.contact.pair_faces import FaceOptions, contact_kappa, pair_faces
from siggen.gears.contact.pair_rest import PairRest, pair_rest
from siggen.gears.damage.flank_chords import flank_chords
from siggen.gears.damage.tooth_damage import Damage, has_extent, pits_of
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.compliance import tooth_compliance
from siggen.gears.stiffness.hertz import centre_line_depth, contact_half_width
from siggen.gears.stiffness.mesh_stiffness import rolls_at
from siggen.gears.stiffness.mesh_tables import pair_kinds
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

FORCE, SLOPE, CARRYING, ROUGH, MOMENT, MOMENT_SLOPE, TURNING, TURNING_SLOPE = range(8)
"""Columns of the curves: force [N], dF/dd [N/m], carrying share of the face, share of the load on damage; where gears
tilt, also the moment at no tilt M [N m], dM/dd [N], dM/dθ = M_θ [N m], and dM_θ/dd [N]."""
FELT_HALF_WIDTHS = 4.0
"""Gaps farther from the contact than this many Hertz half widths are not felt."""
NO_ENERGY = np.zeros((2, 0))
COARSEST = 64
"""Intervals of the fine grid per column near damage before refining."""
BEND = 2e-3
"""Largest deviation of a column's forces from the mean of its neighbours, of the force and a tenth of the largest."""


class TableOptions(NamedTuple):
    """How finely the contact is tabulated.

    `largest_force_n`: at which the nodes end; `edge_radius_m`: of damage; `cell_m`: width of a slice, 1 to 1.5 Hertz
    half widths; `nodes`: approaches; `healthy_columns`; `finest`: intervals of the fine grid below which columns are
    not refined; `section_loss`: whether damage also weakens the tooth's sections; `coupled`: whether slices feel each
    other; `tilt_rad`: at which dM/dθ is taken, 0 where gears stay parallel.
    """

    largest_force_n: float
    edge_radius_m: float = 0.1e-3
    cell_m: float = 0.1e-3
    nodes: int = 16
    healthy_columns: int = 65
    finest: int = 2
    section_loss: bool = False
    coupled: bool = True
    tilt_rad: float = 0.0


class ContactTable(NamedTuple):
    """Tables on the fine grid of the stiffness, `points` positions from s_A to s_E.

    `touch_m` (rows, points): approach at which a pair of this kind first touches [m]; `column`, `gain` (rows, points -
    1): column at the start of a fine interval, and how many columns it spans; `curves` (columns, nodes, 4 or 8): see
    FORCE; `reach_m`: D; `lead_m`: least missing material across the face, which every pair has to add.
    """

    touch_m: FloatArray
    column: FloatArray
    gain: FloatArray
    curves: FloatArray
    reach_m: float
    lead_m: float = 0.0


class KindRow(NamedTuple):
    """One kind of pair on the fine grid (points,): positions, gaps, compliance of all but the contact, radius of edges.

    The radius is the mean of those that the damage of both teeth states, or else that of the options.
    """

    position_m: FloatArray
    gaps: FaceGaps
    rest: PairRest
    edge_radius_m: float


class TableSolver(NamedTuple):
    """What all columns of a pair share."""

    pair: GearPair
    options: TableOptions
    lead_m: FloatArray
    node_m: FloatArray


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
    # The least missing material counts in the places of the teeth (`slice_law` does the same).
    even = lead - lead.min()
    healthy, row = _healthy(pair, stiffness, options, points, tuple(even.tolist()))
    solver = table_solver(pair, stiffness, options, even)
    parts = [(healthy.touch_m[0], healthy.column[0], healthy.gain[0], healthy.curves)]
    for kind in pair_kinds(pair, damage)[1:]:
        first = sum(len(curves) for *_, curves in parts)
        damaged = kind_row(pair, stiffness, options, points, pits_of_kind(damage, kind))
        parts.append(_damaged(solver, damaged, row.gaps, healthy, first))
    touch, column, gain, curves = (list(values) for values in zip(*parts, strict=True))
    joined = np.concatenate(curves)
    table = ContactTable(np.stack(touch), np.stack(column), np.stack(gain), joined, healthy.reach_m, float(lead.min()))
    for array in table[:4]:
        array.setflags(write=False)
    return table


def face_slices(pair: GearPair, options: TableOptions) -> int:
    """Return the number of slices across the face."""
    return max(2, round(pair.face_width_m / options.cell_m))


@lru_cache(maxsize=2)  # states of a specimen share the healthy columns
def _healthy(
    pair: GearPair, stiffness: StiffnessOptions, options: TableOptions, points: int, lead_m: tuple[float, ...]
) -> tuple[ContactTable, KindRow]:
    solver = table_solver(pair, stiffness, options, np.array(lead_m))
    row = kind_row(pair, stiffness, options, points, ((), ()))
    chosen = np.round(np.linspace(0, points - 1, min(options.healthy_columns, points))).astype(np.int64)
    curves = _curves(solver, row, chosen)
    at = np.interp(np.arange(points), chosen, np.arange(chosen.size))
    touch = first_touch(solver, row, np.arange(points))
    return ContactTable(touch[None], at[None, :-1], np.diff(at)[None], curves, float(solver.node_m[-1])), row


def pits_of_kind(damage: Damage, kind: tuple[int, int]) -> tuple[Damage, Damage]:
    """Return the damage of pinion and gear tooth of a kind of pair."""
    return pits_of(damage, "pinion", kind[0]), pits_of(damage, "gear", kind[1])


def kind_row(
    pair: GearPair, stiffness: StiffnessOptions, options: TableOptions, points: int, pits: tuple[Damage, Damage]
) -> KindRow:
    """Return one kind of pair on a grid of points from s_A to s_E."""
    position = np.linspace(pair.contact_start_m, pair.contact_end_m, points)
    members = tuple(zip(("pinion", "gear"), rolls_at(pair, position), pits, strict=True))
    chords = [
        flank_chords(pair.member(which), of_tooth, pair.face_width_m, face_slices(pair, options))
        for which, _, of_tooth in members
    ]
    # What shows on no flank acts through the tooth alone, as in `slice_law`.
    teeth = [
        tooth_compliance(
            pair, which, roll, stiffness, tuple(d for d in damage if options.section_loss or d.outline is None)
        )
        for which, roll, damage in members
    ]
    rest = pair_rest(pair, rolls_at(pair, position), (teeth[0], teeth[1]))
    stated = np.concatenate([radius.ravel() for c in chords for radius in (c.low_radius_m, c.high_radius_m)])
    stated = stated[stated > 0.0]
    edge_radius = float(stated.mean()) if stated.size else options.edge_radius_m
    return KindRow(position, face_gaps(pair, chords[0], chords[1], position), rest, edge_radius)


def table_solver(pair: GearPair, stiffness: StiffnessOptions, options: TableOptions, lead_m: FloatArray) -> TableSolver:
    """Return the solver with nodes up to 1.25 times the approach of the largest force in the middle of the path."""
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m)])
    rolls = rolls_at(pair, middle)
    members = tuple(zip(("pinion", "gear"), rolls, strict=True))
    depth = float(np.sqrt(np.prod([centre_line_depth(pair, which, roll) for which, roll in members])))
    rest = sum(float(tooth_compliance(pair, which, roll, stiffness).total[0]) for which, roll in members)
    force = options.largest_force_n
    width = float(_half_width(pair, middle, force)[0])
    contact = contact_kappa(pair) * force / pair.face_width_m * (np.log(2.0 * depth / width) + 0.5)
    reach = 1.25 * (force * rest + contact)
    return TableSolver(pair, options, lead_m, reach * (np.arange(options.nodes) / (options.nodes - 1.0)) ** 2)


def _damaged(
    solver: TableSolver, row: KindRow, healthy_gaps: FaceGaps, healthy: ContactTable, first: int
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return touch (points,), column and gain (points - 1,) and the curves of one kind, numbered from `first`."""
    other = (row.gaps.left_m != healthy_gaps.left_m) | (row.gaps.right_m != healthy_gaps.right_m)
    away = -np.minimum(row.gaps.left_m, row.gaps.right_m)
    reach = FELT_HALF_WIDTHS * _half_width(solver.pair, row.position_m, solver.options.largest_force_n)
    felt = np.any(other & (away < reach[:, None]), axis=1) | solver.options.section_loss
    column, gain = healthy.column[0].copy(), healthy.gain[0].copy()
    parts = [np.zeros((0, *healthy.curves.shape[1:]))]
    for run in _runs(np.flatnonzero(felt[1:] | felt[:-1])):
        ends, curves = _refined(solver, row, run)
        intervals = np.arange(run[0], run[-1] + 1)
        starts = np.interp(intervals, ends, np.arange(ends.size))
        column[intervals] = first + starts
        gain[intervals] = np.interp(intervals + 1, ends, np.arange(ends.size)) - starts
        parts.append(curves)
        first += ends.size
    return first_touch(solver, row, np.arange(row.position_m.size)), column, gain, np.concatenate(parts)


def _runs(intervals: IntArray) -> list[IntArray]:
    """Return the parts of ascending numbers that follow each other without a gap."""
    if intervals.size == 0:
        return []
    return list(np.split(intervals, np.flatnonzero(np.diff(intervals) > 1) + 1))


def _refined(solver: TableSolver, row: KindRow, run: IntArray) -> tuple[IntArray, FloatArray]:
    """Return fine points and curves of the columns of a run: halved where the middle is not the mean of the ends."""
    first, last = int(run[0]), int(run[-1]) + 1
    wanted = np.unique(np.append(np.arange(first, last, COARSEST), last)).tolist()
    found = dict(zip(wanted, _curves(solver, row, np.array(wanted)), strict=True))
    intervals = list(pairwise(wanted))
    while intervals := [(low, high) for low, high in intervals if high - low > solver.options.finest]:
        middles = [(low + high) // 2 for low, high in intervals]
        found |= dict(zip(middles, _curves(solver, row, np.array(middles)), strict=True))
        bent = [
            (low, middle, high)
            for (low, high), middle in zip(intervals, middles, strict=True)
            if not _is_mean(found[low], found[middle], found[high], (middle - low) / (high - low))
        ]
        intervals = [part for low, middle, high in bent for part in ((low, middle), (middle, high))]
    ends = np.array(sorted(found), dtype=np.int64)
    return ends, np.stack([found[i] for i in ends.tolist()])


def _is_mean(low: FloatArray, middle: FloatArray, high: FloatArray, weight: float) -> bool:
    """Whether a column's forces are those between its neighbours'."""
    mean = (1.0 - weight) * low[:, FORCE] + weight * high[:, FORCE]
    scale = middle[:, FORCE] + 0.1 * middle[-1, FORCE]
    return bool(np.all(np.abs(mean - middle[:, FORCE]) <= BEND * scale))


def _half_width(pair: GearPair, position_m: FloatArray, force_n: float) -> FloatArray:
    length = np.full(position_m.shape, pair.face_width_m)
    return contact_half_width(pair, *rolls_at(pair, position_m), length, force_n)


def first_touch(solver: TableSolver, row: KindRow, chosen: IntArray) -> FloatArray:
    """Return the least rigid sink of all slices, missing material across the face included (chosen,) [m]."""
    position, line = row.position_m[chosen], solver.pair.line_of_action_m
    radius = position * (line - position) / line + row.edge_radius_m
    gaps = row.gaps
    near = np.maximum(np.minimum(gaps.left_m[chosen], gaps.right_m[chosen]), 0.0)
    floor = np.where(gaps.floor_m[chosen] > 0.0, gaps.floor_m[chosen], np.inf)
    sunk = np.minimum(near**2 / (2.0 * radius[:, None]), floor)
    return np.asarray((sunk + solver.lead_m).min(axis=1))


def row_faces(solver: TableSolver, row: KindRow, chosen: IntArray) -> list[FaceSlices]:
    """Return the slices at fine points (chosen,)."""
    options = solver.options
    typical = 0.25 * options.largest_force_n / solver.pair.face_width_m
    return pair_faces(
        solver.pair,
        FaceGaps(*(array[chosen] for array in row.gaps)),
        row.position_m[chosen],
        PairRest(*(array[chosen] for array in row.rest)),
        FaceOptions(typical, row.edge_radius_m, options.coupled),
        solver.lead_m,
    )


def _curves(solver: TableSolver, row: KindRow, chosen: IntArray) -> FloatArray:
    """Return the curves (chosen, nodes, 4 or 8) at fine points (chosen,)."""
    from scipy.interpolate import pchip_interpolate

    pair, options, node = solver.pair, solver.options, solver.node_m
    faces = row_faces(solver, row, chosen)
    touch = first_touch(solver, row, chosen)
    tilts = options.tilt_rad > 0.0
    curves = np.zeros((chosen.size, options.nodes, 8 if tilts else 4))
    room = solver_room(solver.lead_m.size)
    for i, slices in enumerate(faces):
        found = force_curve(slices, touch[i] + node[1:], 0.0, np.zeros(solver.lead_m.size), room, NO_ENERGY)
        curves[i, 1:, FORCE] = found.force_n
        curves[i, 1:, CARRYING] = found.carrying_m / pair.face_width_m
        curves[i, 1:, ROUGH] = found.on_damage
        if tilts:
            curves[i, 1:, MOMENT] = found.moment_n_m
            curves[i, :, TURNING] = _turning(slices, touch[i], node, options.tilt_rad, room)
    curves[:, 0, CARRYING:] = curves[:, 1, CARRYING:]
    curves[:, :, SLOPE] = pchip_interpolate(node, curves[:, :, FORCE].T, node, der=1).T
    for value in (MOMENT, TURNING) if tilts else ():
        curves[:, :, value + 1] = pchip_interpolate(node, curves[:, :, value].T, node, der=1).T
    curves[:, 0, SLOPE] = 0.0  # Weber and Banaschek's tangent, which no mean of secants finds
    return curves


def _turning(slices: FaceSlices, touch_m: float, node_m: FloatArray, tilt_rad: float, room: SolverRoom) -> FloatArray:
    """Return dM/dθ (nodes,) [N m] from tilts to both sides, at every third node and monotone between."""
    from scipy.interpolate import pchip_interpolate

    chosen = np.unique(np.append(np.arange(1, node_m.size, 3), node_m.size - 1))
    zeros = np.zeros(slices.face_m.size)
    one, two = (
        force_curve(slices, touch_m + node_m[chosen], tilt, zeros.copy(), room, NO_ENERGY).moment_n_m
        for tilt in (tilt_rad, -tilt_rad)
    )
    known = np.append(0.0, (one - two) / (2.0 * tilt_rad))
    return np.asarray(pchip_interpolate(np.append(0.0, node_m[chosen]), known, node_m))
