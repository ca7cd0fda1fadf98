"""KindRow: one kind of pair along its path, as gaps of damage and tips and as compliance of the teeth.

Gaps are found where damage may be felt; elsewhere they are those of the healthy pair.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.gears.contact.face_gaps import FaceGaps, face_gaps
from siggen.gears.contact.helical_slices import helical_gaps, helical_missing_m, helical_rest
from siggen.gears.contact.pair_rest import PairRest, pair_rest
from siggen.gears.contact.table_options import TableOptions, face_slices, half_width
from siggen.gears.damage.flank_chords import FlankChords, flank_chords
from siggen.gears.damage.lost_shape import shapes_touching_m
from siggen.gears.damage.part_chip import standing_share
from siggen.gears.damage.rough_land import rough_land, rough_shares
from siggen.gears.damage.tooth_damage import Damage, acts_unevenly, goes_through, pits_of
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.helical import carrying_middle_m, slice_radii_m, slice_shifts_m
from siggen.gears.stiffness.compliance import tooth_compliance
from siggen.gears.stiffness.mesh_stiffness import rolls_at
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.names import Side

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
