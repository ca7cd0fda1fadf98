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

from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit
from siggen.damage.chip import standing_share
from siggen.damage.flank_chords import FlankChords, flank_chords
from siggen.damage.lost_shape import shapes_touching_m
from siggen.damage.part import Damage, acts_unevenly, goes_through, has_extent, pits_of
from siggen.damage.rough_land import rough_land, rough_shares
from siggen.gears.face_shares import FaceShares
from siggen.gears.gear_pair import GearPair
from siggen.gears.helical import carrying_middle_m, slice_radii_m, slice_shifts_m
from siggen.mesh import tilt_rays
from siggen.mesh.face_force import SolverRoom, keep_rigid_sinks, loads_under_force, solved_force, solver_room
from siggen.mesh.face_slices import (
    FaceGaps,
    FaceOptions,
    FaceSlices,
    PairRest,
    contact_kappa,
    face_gaps,
    helical_gaps,
    helical_missing_m,
    helical_rest,
    pair_faces,
    pair_rest,
)
from siggen.mesh.hertz import centre_line_depth
from siggen.mesh.mesh_stiffness import rolls_at
from siggen.mesh.mesh_tables import pair_kinds
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions, face_slices, half_width
from siggen.mesh.tilt_rays import RAYS, UPRIGHT, along_rays, energy_j, ray_way
from siggen.mesh.tooth_compliance import tooth_compliance
from siggen.names import Side

# KindRow: one kind of pair along its path, as gaps of damage and tips and as compliance of the teeth.
#
# Gaps are found where damage may be felt; elsewhere they are those of the healthy pair.

FELT_HALF_WIDTHS = 4.0
"""Gaps farther from the contact than this many Hertz half widths are not felt."""


class KindRow(NamedTuple):
    """One kind of pair on the fine grid (points,): positions, gaps, compliance of all but the contact, radius of edges.

    `gaps` are those of the points from `first` on, `elsewhere` those of the healthy pair at all points; `edge_radius_m`
    is the mean of those that the damage of both teeth states, or else that of the options. Of a helical pair
    `position_m` is where the middle of the face is; `slice_missing_m` (points, n): what slices miss beside the lead.
    `rough` (points, n): parts of slices that are rough land; None: none.
    """

    position_m: FloatArray
    gaps: FaceGaps
    first: int
    elsewhere: FaceGaps
    rest: PairRest
    edge_radius_m: float
    slice_missing_m: FloatArray | None = None
    rough: FloatArray | None = None

    def lead_at(self, chosen: IntArray, lead_m: FloatArray) -> FloatArray:
        """Return what slices miss at fine points (chosen, n), or (n,) where it is the same at all [m]."""
        return lead_m if self.slice_missing_m is None else self.slice_missing_m[chosen] + lead_m

    def gaps_at(self, chosen: IntArray) -> FaceGaps:
        """Return the gaps at fine points (chosen,)."""
        inside = chosen - self.first
        here = (inside >= 0) & (inside < len(self.gaps.left_m))
        if here.all():
            return FaceGaps(*(near[inside] for near in self.gaps))
        found = []
        for near, far in zip(self.gaps, self.elsewhere, strict=True):
            values = far[chosen]
            values[here] = near[inside[here]]
            found.append(values)
        return FaceGaps(*found)


def pits_of_kind(damage: Damage, kind: tuple[int, int]) -> tuple[Damage, Damage]:
    """Return the damage of pinion and gear tooth of a kind of pair."""
    return pits_of(damage, Side.DRIVER, kind[0]), pits_of(damage, Side.DRIVEN, kind[1])


def kind_row(
    pair: GearPair,
    stiffness: StiffnessOptions,
    options: TableOptions,
    points: int,
    pits: tuple[Damage, Damage] = ((), ()),
    healthy: KindRow | None = None,
) -> KindRow:
    """Return one kind of pair on a grid of points from s_A to s_E; without `healthy` its gaps are found everywhere."""
    if pair.helix_rad != 0.0:
        return _helical_row(pair, stiffness, options, points, pits, healthy)
    position = np.linspace(pair.contact_start_m, pair.contact_end_m, points)
    rolls, flanks = rolls_at(pair, position), (Side.DRIVER, Side.DRIVEN)
    slices = face_slices(pair, options)
    chords = [
        flank_chords(pair.member(side), of_tooth, pair.face_width_m, slices)
        for side, of_tooth in zip(flanks, pits, strict=True)
    ]
    # What shows on no flank acts through the tooth alone; what is gone through it leaves a narrower one.
    notches = [[d for d in of_tooth if not goes_through(d)] for of_tooth in pits]
    acting = [tuple(d for d in of_tooth if options.section_loss or d.outline is None) for of_tooth in notches]
    standing = [standing_share(pair, side, of_tooth) for side, of_tooth in zip(flanks, pits, strict=True)]
    if healthy is not None and not any(acting) and min(standing) == 1.0:
        rest = healthy.rest
    else:
        rest = _rest(pair, stiffness, rolls, (acting[0], acting[1]), (standing[0], standing[1]), slices)
    edge_radius = _edge_radius(chords, options)
    place = np.repeat(position[:, np.newaxis], slices, axis=1)
    missing = shapes_touching_m(pair, pits, place)
    window = slice(0, points) if healthy is None or missing is not None else _window(pair, chords, position)
    gaps = face_gaps(pair, chords[0], chords[1], position[window])
    elsewhere = gaps if healthy is None else healthy.elsewhere
    rough = _rough(pair, pits, place)
    return KindRow(position, gaps, window.start, elsewhere, rest, edge_radius, missing, rough)


def _rough(pair: GearPair, pits: tuple[Damage, Damage], place_m: FloatArray) -> FloatArray | None:
    """Return the rough parts of slices at their places (k, n), None where both flanks are sound."""
    if not any(pits):
        return None
    slices = place_m.shape[1]
    pinion, gear = (
        rough_land(pair.member(side), of_tooth, pair.face_width_m, slices)
        for side, of_tooth in zip(Side, pits, strict=True)
    )
    return rough_shares(pair, pinion, gear, place_m)


def _edge_radius(chords: list[FlankChords], options: TableOptions) -> float:
    """Return the mean of the radii that the damage of both teeth states, or else that of the options [m]."""
    stated = np.concatenate([radius.ravel() for c in chords for radius in (c.low_radius_m, c.high_radius_m)])
    stated = stated[stated > 0.0]
    return float(stated.mean()) if stated.size else options.edge_radius_m


def _helical_row(
    pair: GearPair,
    stiffness: StiffnessOptions,
    options: TableOptions,
    points: int,
    pits: tuple[Damage, Damage],
    healthy: KindRow | None,
) -> KindRow:
    """Return the row of helical teeth with damage on their flanks."""
    position, slices = np.linspace(pair.engagement_start_m, pair.engagement_end_m, points), face_slices(pair, options)
    place = position[:, np.newaxis] + slice_shifts_m(pair, slices)
    chords = [
        flank_chords(pair.member(side), of_tooth, pair.face_width_m, slices)
        for side, of_tooth in zip(Side, pits, strict=True)
    ]
    gaps, edge_radius = helical_gaps(pair, place, chords[0], chords[1]), _edge_radius(chords, options)
    rough = _rough(pair, pits, place)
    if healthy is not None and healthy.slice_missing_m is not None:
        lost = shapes_touching_m(pair, pits, place)
        missing = healthy.slice_missing_m if lost is None else healthy.slice_missing_m + lost
        return healthy._replace(gaps=gaps, edge_radius_m=edge_radius, slice_missing_m=missing, rough=rough)
    missing = helical_missing_m(pair, place, options.relief)
    return KindRow(position, gaps, 0, gaps, helical_rest(pair, place, stiffness), edge_radius, missing, rough)


def _rest(
    pair: GearPair,
    stiffness: StiffnessOptions,
    rolls: tuple[FloatArray, FloatArray],
    acting: tuple[Damage, Damage],
    standing: tuple[float, float],
    slices: int,
) -> PairRest:
    """Return the rest of both teeth (points,): evenly what damage does over the whole face, uneven what it does not."""
    teeth, added = [], np.zeros((2, rolls[0].size, slices))
    for i, (side, roll, damage) in enumerate(zip(Side, rolls, acting, strict=True)):
        uneven = tuple(d for d in damage if acts_unevenly(d))
        teeth.append(tooth_compliance(pair, side, roll, stiffness, (d for d in damage if d not in uneven)))
        for one in uneven:
            added[i] += one.slice_compliance_m_per_n(pair, roll, teeth[i].total, slices)
    return pair_rest(pair, (teeth[0], teeth[1]), stiffness, standing, added if added.any() else None)


def _window(pair: GearPair, chords: list[FlankChords], position_m: FloatArray) -> slice:
    """Return the points from the first to the last at which damage of either flank may be felt."""
    along = (position_m, pair.line_of_action_m - position_m)
    reach = FELT_HALF_WIDTHS * half_width(pair, position_m, pair.reference_force_n)
    near = np.zeros(position_m.size, dtype=bool)
    for flank, path in zip(chords, along, strict=True):
        holds = np.arange(flank.low.shape[1]) < flank.intervals[:, None]
        if not holds.any():
            continue
        arc = path**2 / (2.0 * flank.base_radius_m)
        near |= (arc > flank.low[holds].min() - reach) & (arc < flank.high[holds].max() + reach)
    found = np.flatnonzero(near)
    return slice(int(found[0]), int(found[-1]) + 1) if found.size else slice(0, 0)


def felt(pair: GearPair, row: KindRow, healthy: KindRow) -> np.ndarray:
    """Return at which fine points a kind is rough, or differs from a healthy pair under the reference force."""
    softer = not np.array_equal(row.rest.tooth_m_per_n, healthy.rest.tooth_m_per_n)
    # Slices of helical teeth differ as they do on healthy ones, which is nothing of the damage.
    uneven = row.rest.uneven is not None and row.rest.uneven is not healthy.rest.uneven
    found = np.full(row.position_m.size, softer or uneven)
    if row.rough is not None:
        found |= row.rough.any(axis=1)
    window = slice(row.first, row.first + len(row.gaps.left_m))
    left, right = row.gaps.left_m, row.gaps.right_m
    other = (left != row.elsewhere.left_m[window]) | (right != row.elsewhere.right_m[window])
    middle = carrying_middle_m(pair, row.position_m[window])
    reach = FELT_HALF_WIDTHS * half_width(pair, middle, pair.reference_force_n)
    if row.slice_missing_m is not None and row.slice_missing_m is not healthy.slice_missing_m:
        sound = 0.0 if healthy.slice_missing_m is None else healthy.slice_missing_m
        found |= np.any(row.slice_missing_m != sound, axis=1)
    found[window] |= np.any(other & (-np.minimum(left, right) < reach[:, None]), axis=1)
    return found


def first_touch(pair: GearPair, row: KindRow, chosen: IntArray, lead_m: FloatArray) -> FloatArray:
    """Return the least rigid sink of all slices, missing material across the face included (chosen,) [m]."""
    lead = row.lead_at(chosen, lead_m)
    radii = slice_radii_m(pair, row.position_m[chosen], lead.shape[-1]) + row.edge_radius_m
    return _least_sink(radii, row.gaps_at(chosen), lead)


def touch_along(pair: GearPair, row: KindRow, healthy_m: FloatArray, lead_m: FloatArray) -> FloatArray:
    """Return `first_touch` at all fine points, from that of the healthy pair (points,) [m]."""
    touch = healthy_m.copy()
    window = slice(row.first, row.first + len(row.gaps.left_m))
    inside = np.arange(window.start, window.stop)
    touch[window] = first_touch(pair, row, inside, lead_m)
    return touch


def _least_sink(radii_m: FloatArray, gaps: FaceGaps, lead_m: FloatArray) -> FloatArray:
    near = np.maximum(np.minimum(gaps.left_m, gaps.right_m), 0.0)
    floor = np.where(gaps.floor_m > 0.0, gaps.floor_m, np.inf)
    sunk = np.minimum(near**2 / (2.0 * radii_m), floor)
    tip = np.maximum(gaps.nearest_tip_m, 0.0) ** 2 / (2.0 * radii_m)
    sunk = np.where(gaps.covered < 1.0, np.minimum(sunk, tip), sunk)
    return np.asarray((sunk + lead_m).min(axis=1))


# ForceCurve: answers of a tooth pair at one position along approaches and tilts, each solved from the ones before.


class ForceCurve(NamedTuple):
    """Answers along a way, (k,) each, as in `FaceForce`."""

    force_n: FloatArray
    moment_n_m: FloatArray
    stiffness_n_per_m: FloatArray
    turning_n: FloatArray
    tilting_n_m: FloatArray
    carrying_m: FloatArray
    on_rough: FloatArray


@entry(cache=True, _nrt=False, error_model="numpy")
def write_curves(
    slices: FaceSlices,
    approach_m: FloatArray,
    tilt_rad: FloatArray,
    room: SolverRoom,
    tolerance: float,
    out: FloatArray,
) -> bool:
    """Write the answers (7, ways, k) along ways to approaches and tilts (ways, k) from no guess; False if one has none.

    Compiled code that allocates nothing need not count references.
    """
    for way in range(approach_m.shape[0]):
        room.loads[:] = 0.0
        if not _write_curve(
            slices, approach_m[way], tilt_rad[way], room.loads, room, tolerance, out[:, way]
        ):  # fmt: skip
            return False
    return True


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_curve(
    slices: FaceSlices,
    approach_m: FloatArray,
    tilt_rad: FloatArray,
    loads: FloatArray,
    room: SolverRoom,
    tolerance: float,
    out: FloatArray,
) -> bool:
    """Write the answers (7, k) to approaches and tilts (k,) on a straight way; False if one cannot be solved.

    Every solution starts from the line through the two before it.
    """
    before = room.before
    keep_rigid_sinks(slices, room)
    for j in range(approach_m.size):
        ratio = _step_ratio(approach_m, tilt_rad, j) if j > 1 else 0.0
        for i in range(loads.size):
            found = loads[i]
            if j > 1 and found > 0.0 and before[i] > 0.0:
                loads[i] = max(found + ratio * (found - before[i]), 0.1 * found)
            before[i] = found
        answer = solved_force(slices, approach_m[j], tilt_rad[j], loads, room, tolerance)
        if answer.passes < 0:
            return False
        out[0, j] = answer.force_n
        out[1, j] = answer.moment_n_m
        out[2, j] = answer.stiffness_n_per_m
        out[3, j] = answer.turning_n
        out[4, j] = answer.tilting_n_m
        out[5, j] = answer.carrying_m
        out[6, j] = answer.on_rough
    return True


@njit(cache=True, _nrt=False, error_model="numpy")
def _step_ratio(approach_m: FloatArray, tilt_rad: FloatArray, j: int) -> float:
    """Return the step to place j over the one before it."""
    before = approach_m[j - 1] - approach_m[j - 2]
    if before != 0.0:
        risen: float = (approach_m[j] - approach_m[j - 1]) / before
        return risen
    turned = tilt_rad[j - 1] - tilt_rad[j - 2]
    ratio: float = (tilt_rad[j] - tilt_rad[j - 1]) / turned if turned != 0.0 else 0.0
    return ratio


# Columns of the contact table: answers of one kind of pair at points of the path to approaches beyond first touch.
#
# Forces, moments and their slopes are the solver's own, so that few approaches do. Nodes lie at u k², u of the pair
# alone.

FORCE, SLOPE, CARRYING, ROUGH, ACROSS, ACROSS_SLOPE, ENERGY, BESIDE = range(8)
TURNING, TURNING_SLOPE = ENERGY, BESIDE
"""Values of the curves: force [N], its slope [N/m], carrying share of the face, share of the load on rough land.

Where gears tilt, for every ray of `tilt_rays`: W_r [N] and W_rr, both shares, W_p [J], W_pr and W [J]. On the ray
without tilt, where W_r is F, T [N/m] and T_r stand in the last two places, and W in the last one of the rays beside it.
"""
VALUES, TILTING_VALUES = 4, 8
TOLERANCE = 2e-2
"""Of the last Newton step of a column's loads: the force errs by 1e-4 of 1,200 N at most, by 1e-5 rms (measured)."""


REACH = 1.25
"""How far nodes go over the approach of a force in the middle of the path."""
TYPICAL_SHARE = 0.25
"""Of the reference force: a load that decides from which depth slices count as not carrying."""


class TableSolver(NamedTuple):
    """What all columns of a pair share; `reference` is the number of the node at the reference force."""

    pair: GearPair
    options: TableOptions
    lead_m: FloatArray
    node_m: FloatArray
    reference: int


def node_places_m(unit_m: float, nodes: int) -> FloatArray:
    """Return the approaches of the nodes (nodes,) beyond first touch [m]."""
    return unit_m * np.arange(float(nodes)) ** 2


def table_solver(pair: GearPair, stiffness: StiffnessOptions, options: TableOptions, lead_m: FloatArray) -> TableSolver:
    """Return the solver; a largest force above the reference force adds nodes at the end and moves none."""
    reference = pair.reference_force_n
    unit = REACH * approach_under_m(pair, stiffness, reference) / (options.nodes - 1.0) ** 2
    reach = REACH * approach_under_m(pair, stiffness, max(options.largest_force_n, reference))
    nodes = max(options.nodes, int(np.ceil(np.sqrt(reach / unit))) + 1)
    return TableSolver(pair, options, lead_m, node_places_m(unit, nodes), options.nodes - 1)


def approach_under_m(pair: GearPair, stiffness: StiffnessOptions, force_n: float) -> float:
    """Return the approach of one healthy pair under a force in the middle of the path [m]."""
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m)])
    rolls = rolls_at(pair, middle)
    members = tuple(zip(Side, rolls, strict=True))
    depth = float(np.sqrt(np.prod([centre_line_depth(pair, side, roll) for side, roll in members])))
    rest = sum(float(tooth_compliance(pair, side, roll, stiffness).total[0]) for side, roll in members)
    width = float(half_width(pair, middle, force_n)[0])
    contact = contact_kappa(pair) * force_n / pair.face_width_m * (np.log(2.0 * depth / width) + 0.5)
    return float(force_n * rest + contact)


def row_faces(solver: TableSolver, row: KindRow, chosen: IntArray) -> list[FaceSlices]:
    """Return the slices at fine points (chosen,)."""
    options = solver.options
    typical = TYPICAL_SHARE * solver.pair.reference_force_n / solver.pair.face_width_m
    return pair_faces(
        solver.pair,
        row.gaps_at(chosen),
        carrying_middle_m(solver.pair, row.position_m[chosen]),
        row.rest.at(chosen),
        FaceOptions(typical, row.edge_radius_m, options.coupled),
        row.lead_at(chosen, solver.lead_m),
        None
        if solver.pair.helix_rad == 0.0
        else slice_radii_m(solver.pair, row.position_m[chosen], solver.lead_m.size),
        None if row.rough is None else row.rough[chosen],
    )


def column_curves(solver: TableSolver, row: KindRow, chosen: IntArray) -> FloatArray:
    """Return the curves (chosen, nodes, 1, values) without tilt at fine points (chosen,), ascending."""
    curves = ray_curves(solver, row, chosen, RAYS[UPRIGHT : UPRIGHT + 1])
    keep_rising(solver.node_m, curves)
    return curves


def ray_curves(solver: TableSolver, row: KindRow, chosen: IntArray, rays: FloatArray) -> FloatArray:
    """Return the curves (chosen, nodes, rays, values) on rays (rays,) of p at fine points (chosen,), as solved."""
    touch, room = first_touch(solver.pair, row, chosen, solver.lead_m), solver_room(solver.lead_m.size)
    node, half_face = solver.node_m[1:], 0.5 * solver.pair.face_width_m
    way = ray_way(rays, node, half_face)
    found = np.zeros((chosen.size, len(ForceCurve._fields), rays.size, node.size))
    for i, slices in enumerate(row_faces(solver, row, chosen)):
        if not write_curves(slices, touch[i] + way.approach_m, way.tilt_rad, room, TOLERANCE, found[i]):
            raise ValueError("the contact across the face was not solved; allowed: finite slices and approaches")
    found = np.moveaxis(found, 0, 1)
    values = along_rays(rays, node, half_face, found)
    parts = [values[0], values[1], found[tilt_rays.CARRYING] / solver.pair.face_width_m, found[tilt_rays.ON_ROUGH]]
    count = TILTING_VALUES if solver.options.tilts else VALUES
    curves = np.zeros((chosen.size, solver.node_m.size, rays.size, count))
    for number, part in enumerate(parts):
        curves[:, 1:, :, number] = np.moveaxis(part, -1, 1)
    if solver.options.tilts:
        curves[:, 1:, :, ACROSS], curves[:, 1:, :, ACROSS_SLOPE] = np.moveaxis(values[2:], -1, 2)
    curves[:, 0, :, [CARRYING, ROUGH]] = curves[:, 1, :, [CARRYING, ROUGH]]
    if solver.options.tilts and rays.size == 1:  # without tilt
        turning = found[tilt_rays.TURNING] / half_face**2
        turning = np.concatenate([turning[..., :1], turning], axis=-1)
        curves[..., TURNING] = np.moveaxis(turning, -1, 1)
        curves[..., TURNING_SLOPE] = np.moveaxis(monotone_slopes(solver.node_m, turning), -1, 1)
    return curves


def monotone_slopes(node_m: FloatArray, values: FloatArray) -> FloatArray:
    """Return the slopes (..., nodes) of a cubic that is monotone where values are: harmonic means of the secants.

    Source: Fritsch and Butland 1984.
    """
    secant = np.diff(values) / np.diff(node_m)
    before, behind = secant[..., :-1], secant[..., 1:]
    product, total = before * behind, before + behind
    inner = np.where(product > 0.0, 2.0 * product / np.where(total == 0.0, 1.0, total), 0.0)
    return np.concatenate([secant[..., :1], inner, secant[..., -1:]], axis=-1)


def keep_rising(node_m: FloatArray, curves: FloatArray) -> None:
    """Cut slopes to three times the secants beside them: such a cubic rises (Fritsch and Carlson 1980)."""
    secant = 3.0 * np.diff(curves[..., FORCE], axis=1) / np.diff(node_m)[:, np.newaxis]
    curves[:, 1:, :, SLOPE] = np.minimum(curves[:, 1:, :, SLOPE], secant)
    curves[:, :-1, :, SLOPE] = np.minimum(curves[:, :-1, :, SLOPE], secant)


# Columns of a table where they are needed: intervals are halved until the middle is what the ends say of it.

Bent = Callable[[FloatArray, FloatArray, FloatArray, float], bool]
"""Whether a middle column is not the mean of a low and a high one; the weight of the high one comes last."""


def halved(
    wanted: Sequence[int], solve: Callable[[IntArray], FloatArray], bent: Bent, finest: int
) -> tuple[IntArray, FloatArray]:
    """Return places (k,), ascending, and their columns (k, ...).

    Parameters
    ----------
    wanted : sequence of int
        Places of the first columns, ascending.
    solve : callable
        Returns the columns at places.
    bent : callable
    finest : int
        Intervals that are not halved any more.
    """
    found = dict(zip(wanted, solve(np.array(wanted)), strict=True))
    intervals = list(pairwise(wanted))
    while intervals := [(low, high) for low, high in intervals if high - low > finest]:
        middles = [(low + high) // 2 for low, high in intervals]
        found |= dict(zip(middles, solve(np.array(middles)), strict=True))
        parted = [
            (low, middle, high)
            for (low, high), middle in zip(intervals, middles, strict=True)
            if bent(found[low], found[middle], found[high], (middle - low) / (high - low))
        ]
        intervals = [part for low, middle, high in parted for part in ((low, middle), (middle, high))]
    places = np.array(sorted(found), dtype=np.int64)
    return places, np.stack([found[i] for i in places.tolist()])


# Columns of the contact table on all rays of approach and tilt, from those without tilt.
#
# Derived. How a tilt takes force from a column hardly changes from one to the next, though the force itself does:
# along a ray the force over that without tilt at the same radius is linear between few columns, which are solved.

TILTED_COARSEST = 16
"""Columns from one that is solved on all rays to the next, before halving."""
TILTED_BEND = 1e-2
"""Largest deviation of a ray's forces from its neighbours', of the force without tilt and a tenth of the largest."""
ROUGH_BEND = 0.05
"""Largest deviation of the share of the load on rough land from its neighbours'."""

TILTED_NODES = 10
"""Nodes up to which rays are solved, of those up to the reference force.

In quickstart to 14 um, where the first ray lifts the ends of a face by 8 um. Behind it the share of the force without
tilt stays.
"""
TILTED = [ray for ray in range(1, RAYS.size - 1) if ray != UPRIGHT]
"""Rays that are solved."""


def tilted_columns(solver: TableSolver, row: KindRow, chosen: IntArray, upright: FloatArray) -> FloatArray:
    """Return the columns (chosen, nodes, rays, values) at fine points (chosen,) from those without tilt.

    `upright` (chosen, nodes, 1, values): of `column_curves`, which is returned where gears do not tilt.
    """
    if not solver.options.tilts:
        return upright
    scale = _scale(solver.node_m, upright)

    end = TILTED_NODES + 1

    def solve(places: IntArray) -> FloatArray:
        return _rays(solver, row, chosen[places]) / scale[places, :end]

    force = upright[:, : solver.reference + 1, :, FORCE].mean(axis=0)
    counts = force[:end] / (force[:end] + 0.1 * force[-1])

    def bent(low: FloatArray, middle: FloatArray, high: FloatArray, weight: float) -> bool:
        off = np.abs((1.0 - weight) * low + weight * high - middle)
        return bool(np.any(off[:, :, FORCE] * counts > TILTED_BEND) or np.any(off[:, :, ROUGH] > ROUGH_BEND))

    wanted = np.unique(np.append(np.arange(0, chosen.size, TILTED_COARSEST), chosen.size - 1)).tolist()
    stations, shares = halved(wanted, solve, bent, 1)
    solved = _between(chosen[stations], shares, chosen)
    curves = scale * np.concatenate([solved, np.repeat(solved[:, -1:], solver.node_m.size - end, axis=1)], axis=1)
    curves[:, :, UPRIGHT] = upright[:, :, 0]
    keep_rising(solver.node_m, curves)
    pushed, slope = (np.moveaxis(curves[..., column], 1, -1) for column in (FORCE, SLOPE))
    energy = np.moveaxis(energy_j(solver.node_m, pushed, slope), -1, 1)
    for ray in range(RAYS.size):
        if ray != UPRIGHT:
            curves[:, :, ray, ENERGY] = energy[:, :, ray]
    for ray in (UPRIGHT - 1, UPRIGHT + 1):
        curves[:, :, ray, BESIDE] = energy[:, :, UPRIGHT]
    return np.asarray(curves)


def _scale(node_m: FloatArray, upright: FloatArray) -> FloatArray:
    """Return what values of a ray are shares of (chosen, nodes, 1, values)."""
    scale = np.ones_like(upright)
    force = upright[..., FORCE]
    scale[..., FORCE], scale[..., SLOPE], scale[..., ACROSS_SLOPE] = force, upright[..., SLOPE], force
    scale[..., ACROSS] = node_m[:, np.newaxis] * force
    return np.where(scale > 0.0, scale, 1.0)


def _rays(solver: TableSolver, row: KindRow, chosen: IntArray) -> FloatArray:
    """Return solved columns (chosen, TILTED_NODES + 1, rays, values).

    On the last rays a rigid corner only comes to touch.
    """
    near = solver._replace(node_m=solver.node_m[: TILTED_NODES + 1])
    curves = np.zeros((chosen.size, near.node_m.size, RAYS.size, TILTING_VALUES))
    curves[:, :, TILTED] = ray_curves(near, row, chosen, RAYS[TILTED])
    return curves


def _between(stations: IntArray, shares: FloatArray, chosen: IntArray) -> FloatArray:
    """Return the shares at fine points (chosen,), linear between stations."""
    at = np.interp(chosen, stations, np.arange(float(stations.size)))
    first = np.minimum(at.astype(np.int64), max(stations.size - 2, 0))
    weight = (at - first)[:, np.newaxis, np.newaxis, np.newaxis]
    return np.asarray(shares[first] + weight * (shares[np.minimum(first + 1, stations.size - 1)] - shares[first]))


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
    for kind in pair_kinds(damage)[1:]:
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


# Shares of the load that slices of a healthy helical pair carry, solved across the face under a typical force.

STEP = 0.03
"""Of the force, by which it is raised and lowered."""


def load_shares(
    pair: GearPair, stiffness: StiffnessOptions, options: TableOptions, lead_m: FloatArray | None = None
) -> FaceShares:
    """Return the shares at as many positions as a healthy pair has columns; arguments as for `contact_table`.

    Source: derived. The force is that which decides in the table which slices count as carrying.
    """
    slices = face_slices(pair, options)
    lead = np.zeros(slices) if lead_m is None else np.asarray(lead_m, dtype=np.float64)
    solver = table_solver(pair, stiffness, options, lead - lead.min())
    row = kind_row(pair, stiffness, options, options.healthy_columns)
    force_n = TYPICAL_SHARE * pair.reference_force_n
    chosen = np.arange(options.healthy_columns)
    faces = row_faces(solver, row, chosen)
    low, high = (
        np.stack([loads_under_force(one, force) for one in faces])
        for force in ((1.0 - STEP) * force_n, (1.0 + STEP) * force_n)
    )
    share, yielding = (loads / loads.sum(axis=1, keepdims=True) for loads in (low + high, high - low))
    for array in (share, yielding):
        array.setflags(write=False)
    ends = float(row.position_m[0]), float(row.position_m[-1])
    return FaceShares(*ends, slice_shifts_m(pair, slices), share, yielding)
