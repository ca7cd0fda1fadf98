"""FaceSlices: one tooth pair at one position, cut into slices across the face, and what a slice answers on its own."""

from __future__ import annotations

from math import asinh, cos, exp, pi, sinh, sqrt
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.damage.flank_chords import FlankChords, depth_on_line, one_line
from siggen.gears import involute
from siggen.gears.gear_pair import GearPair
from siggen.gears.helical import carrying_middle_m
from siggen.gears.missing_material import TipRelief, missing_at_m
from siggen.mesh.body_coupling import ring_torsion
from siggen.mesh.contact_edges import NO_EDGE, GapSink, gap_sink
from siggen.mesh.hertz import centre_line_depth
from siggen.mesh.line_kernel import (
    ENERGY_WIDTH,
    LineKernel,
    ToothKernel,
    kernel_family,
    line_kernels,
    reckoned_width,
    tooth_kernel,
    tooth_matrix,
    unit_tooth,
)
from siggen.mesh.mesh_stiffness import rolls_at
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import half_width
from siggen.mesh.tooth_compliance import ToothCompliance, axial_part, tooth_compliance
from siggen.names import Side

# Sink of a slice that damage covers in part: land and gap share its load by one energy.
#
# Derived. Of a slice under the mean load u the land, a part f, carries u_l and the gap, c = 1 - f, carries u_g, with
# u = f u_l + c u_g. A load that passes from one to the other sinks by the kernel between neighbours, k = K_0 - K_1:
#
#     E(u) = min ½ k f c (u_l - u_g)² + f ∫ e_l du + c ∫ e_g du,   k (u_l - u_g) = e_g(u_g) - e_l(u_l),
#
# and the sink is dE/du = f e_l + c e_g; where the gap is too deep to carry it is k u c/f + e_l(u/f). A slice of land
# alone or of a gap alone keeps its own law, and between them the sink is continuous in c.

PASSES = 40
CLOSE = 1e-12
"""Of the last step over the mean load."""


def spread_of_cells(cell_widths: float) -> float:
    """Return k = K_0 - K_1 of cells so many half widths wide."""
    x = 0.5 * cell_widths / ENERGY_WIDTH
    return 1.5 * asinh(x) - 0.5 * asinh(3.0 * x)


class CoveredSlice(NamedTuple):
    """A slice (a named tuple, since compiled code takes no dataclass).

    `gap`: left_m, right_m, notch_m, floor_m of the covered part, as for `gap_sink`; `tips`: left_m and right_m of the
    land; `covered`: c; `spread`: k; `radii`: radius_m and rounding_m, as for `gap_sink`.
    """

    gap: tuple[float, float, float, float]
    tips: tuple[float, float]
    covered: float
    spread: float
    radii: tuple[float, float]


@entry(cache=True, _nrt=False, error_model="numpy")
def covered_sink(one: CoveredSlice, load_m: float) -> GapSink:
    """Return the sink of a slice, its slope, and the part of the gap's load on its left edge.

    Parameters
    ----------
    one : CoveredSlice, with c above 0 and below 1
    load_m : κq of the whole slice [m]; at 0 the rigid sink
    """
    gap, tips, covered, spread, (radius, rounding) = one
    land = 1.0 - covered
    apart = 0.0 if load_m <= 0.0 else load_apart(one, load_m)
    on_land = gap_sink(tips[0], tips[1], 0.0, 0.0, radius, rounding, load_m + covered * apart)
    on_gap = gap_sink(gap[0], gap[1], gap[2], gap[3], radius, rounding, max(load_m - land * apart, 0.0))
    if load_m <= 0.0:
        return on_gap if on_gap.sink_m < on_land.sink_m else on_land
    if apart >= load_m / land:
        sink = spread * apart * covered + on_land.sink_m
        return GapSink(sink, (spread * covered + on_land.slope) / land, on_gap.left_share)
    turn = (on_gap.slope - on_land.slope) / (spread + covered * on_land.slope + land * on_gap.slope)
    slope = land * on_land.slope * (1.0 + covered * turn) + covered * on_gap.slope * (1.0 - land * turn)
    return GapSink(land * on_land.sink_m + covered * on_gap.sink_m, slope, on_gap.left_share)


@njit(cache=True, _nrt=False, error_model="numpy")
def load_apart(one: CoveredSlice, load_m: float) -> float:
    """Return u_l - u_g [m] of a slice under `load_m` > 0; parameters as for `covered_sink`."""
    gap, tips, covered, spread, (radius, rounding) = one
    land = 1.0 - covered
    # between a land and a gap that carry nothing
    low, high = -load_m / covered, load_m / land
    on_land = gap_sink(tips[0], tips[1], 0.0, 0.0, radius, rounding, high)
    on_gap = gap_sink(gap[0], gap[1], gap[2], gap[3], radius, rounding, 0.0)
    if spread * high + on_land.sink_m <= on_gap.sink_m:
        return high
    apart = 0.0
    for _ in range(PASSES):
        on_land = gap_sink(tips[0], tips[1], 0.0, 0.0, radius, rounding, load_m + covered * apart)
        on_gap = gap_sink(gap[0], gap[1], gap[2], gap[3], radius, rounding, load_m - land * apart)
        rest = spread * apart + on_land.sink_m - on_gap.sink_m
        low, high = (low, apart) if rest > 0.0 else (apart, high)
        moved = apart - rest / (spread + covered * on_land.slope + land * on_gap.slope)
        if not low < moved < high:
            moved = 0.5 * (low + high)
        if abs(moved - apart) <= CLOSE * load_m:
            break
        apart = moved
    return apart


class FaceSlices(NamedTuple):
    """The slices at one position (a named tuple, since compiled code takes no dataclass); arrays are (n,).

    `left_m`, `right_m`, `notch_m`, `floor_m`: the gap that each slice meets, as for `two_edges.gap_sink`; `rough`: part
    of a slice that is rough land; `covered`: part of a slice that has this gap, the rest has
    only the edges `tips_m` (n, 2; left, right) of the teeth; `spread`: k of `covered_slice`; `lead_m`: missing material
    across the face, of any sign; `face_m`: y from the middle of the face; `kernel`: K; `teeth`: T; `radius_m`: R by
    which slices act on each other; `radii_m`: R of each; `rounding_m`: radius of the edges; `kappa_per_pa`: κ;
    `compliance_m_per_n`: C, of what is rigid across the face; `carrying_m`: L.
    """

    left_m: FloatArray
    right_m: FloatArray
    notch_m: FloatArray
    floor_m: FloatArray
    rough: FloatArray
    covered: FloatArray
    lead_m: FloatArray
    face_m: FloatArray
    tips_m: FloatArray
    spread: float
    kernel: LineKernel
    teeth: ToothKernel
    radius_m: float
    radii_m: FloatArray
    rounding_m: float
    kappa_per_pa: float
    compliance_m_per_n: float
    carrying_m: float


@njit(cache=True, _nrt=False, error_model="numpy")
def slice_of(slices: FaceSlices, i: int) -> CoveredSlice:
    """Return slice i on its own."""
    gap = slices.left_m[i], slices.right_m[i], slices.notch_m[i], slices.floor_m[i]
    tips = slices.tips_m[i, 0], slices.tips_m[i, 1]
    return CoveredSlice(gap, tips, slices.covered[i], slices.spread, (slices.radii_m[i], slices.rounding_m))


@njit(cache=True, _nrt=False, error_model="numpy")
def slice_sink(one: CoveredSlice, load: float) -> GapSink:
    """Return the sink of a slice under a load κq [m]."""
    if 0.0 < one.covered < 1.0:
        return covered_sink(one, load)
    gap, (radius, rounding) = one.gap, one.radii
    return gap_sink(gap[0], gap[1], gap[2], gap[3], radius, rounding, load)


@entry(cache=True, _nrt=False, error_model="numpy")
def contact_half_width(slices: FaceSlices, square: float) -> tuple[float, float, float]:
    """Return a [m] of loads with the sum of squares `square`, as `reckoned_width` does."""
    cell = slices.kernel.cell_m
    width = sqrt(2.0 * slices.radius_m * sqrt(cell * square / slices.carrying_m))
    return reckoned_width(width, cell) if slices.kernel.coupled else (width, 1.0, 0.0)


# Gaps that the slices of a face meet at contact positions: damage of both flanks and the tips of both teeth.
#
# Derived. On the tangent at the contact the coordinate grows with the pinion's arc R_b ψ²/2 and falls with the gear's
# (see `flank_chords`). A tooth ends at its tip: the pinion's leaves a gap that has no edge beyond, the gear's
# one that has none before. Gaps that touch are one. A slice meets the gap that holds the normal, else the nearest one.

SAME_M = 1e-12


class FaceGaps(NamedTuple):
    """What slices meet at positions, (positions, slices) each, in the terms of `two_edges.gap_sink` [m].

    `notch_m` is the depth in the middle of the gap, 0 at a tip; `floor_m` that below the normal, 0 on land; `covered`:
    the part of a slice that has the gap, 0 where there is none but those of the tips; `on_damage`: that part where the
    normal lies in damage, else 0; `tips_m` (positions, slices, 2): left and right
    of a slice without damage.
    """

    left_m: FloatArray
    right_m: FloatArray
    notch_m: FloatArray
    floor_m: FloatArray
    on_damage: FloatArray
    covered: FloatArray
    tips_m: FloatArray

    @property
    def nearest_tip_m(self) -> FloatArray:
        """The nearer one of both tips (positions, slices)."""
        return np.minimum(self.tips_m[..., 0], self.tips_m[..., 1])


def face_gaps(pair: GearPair, pinion: FlankChords, gear: FlankChords, position_m: FloatArray) -> FaceGaps:
    """Return the gaps at contact positions s (k,) [m], which may lie beyond the path of contact.

    Parameters
    ----------
    pair : GearPair
    pinion, gear : FlankChords
        Of as many slices.
    position_m : (k,)
    """
    shape = (position_m.size, pinion.intervals.size)
    gaps = FaceGaps(*(np.zeros(shape) for shape in (*(6 * [shape]), (*shape, 2))))
    tips = tuple(0.5 * g.signed_base_radius_m * g.tip_roll_rad**2 for g in (pair.pinion, pair.gear))
    room = np.empty((2, pinion.low.shape[1] + gear.low.shape[1] + 2))
    _fill(pair.line_of_action_m, pinion, gear, tips[0], tips[1], np.ascontiguousarray(position_m), room, gaps)
    return gaps


@entry(cache=True)
def _fill(
    line: float,
    pinion: FlankChords,
    gear: FlankChords,
    tip_1: float,
    tip_2: float,
    position: FloatArray,
    room: FloatArray,
    gaps: FaceGaps,
) -> None:
    # The floor in the middle of a gap stays the same while the contact moves over a pit of the pinion alone.
    known_at, known = np.full(pinion.intervals.size, np.inf), np.zeros(pinion.intervals.size)
    base_1, half_1 = pinion.base_radius_m, pinion.half_angle_rad
    base_2, half_2 = gear.base_radius_m, gear.half_angle_rad
    count_1, from_1, to_1, face_1, pits_1 = pinion.intervals, pinion.low, pinion.high, pinion.face_m, pinion.pits
    count_2, from_2, to_2, face_2, pits_2 = gear.intervals, gear.low, gear.high, gear.face_m, gear.pits
    crossing_1, row_1, low_1, high_1 = pinion.lines
    crossing_2, row_2, low_2, high_2 = gear.lines
    part_1, part_2 = pinion.covered, gear.covered
    left_m, right_m, notch_m, floor_m, on_damage, covered, tips_m = gaps
    for i in range(position.size):
        roll_1, roll_2 = position[i] / base_1, (line - position[i]) / base_2
        arc_1, arc_2 = 0.5 * base_1 * roll_1**2, 0.5 * base_2 * roll_2**2
        height_1, height_2 = _height(arc_1, base_1, half_1), _height(arc_2, base_2, half_2)
        room[0, 0], room[1, 0] = tip_1 - arc_1, NO_EDGE
        room[0, 1], room[1, 1] = -NO_EDGE, arc_2 - tip_2
        behind, ahead = _nearest(room, 2)
        for j in range(count_1.size):
            tips_m[i, j, 0], tips_m[i, j, 1] = -behind, ahead
            if count_1[j] == 0 and count_2[j] == 0:
                left_m[i, j], right_m[i, j] = -behind, ahead
                continue
            part = max(part_1[j] if count_1[j] else 0.0, part_2[j] if count_2[j] else 0.0)
            covered[i, j] = part
            filled = 0
            for k in range(count_1[j]):
                room[0, filled], room[1, filled] = from_1[j, k] - arc_1, to_1[j, k] - arc_1
                filled += 1
            for k in range(count_2[j]):
                room[0, filled], room[1, filled] = arc_2 - to_2[j, k], arc_2 - from_2[j, k]
                filled += 1
            damaged = filled
            room[0, filled], room[1, filled] = tip_1 - arc_1, NO_EDGE
            room[0, filled + 1], room[1, filled + 1] = -NO_EDGE, arc_2 - tip_2
            low, high = _nearest(room, filled + 2)
            left_m[i, j], right_m[i, j] = -low, high
            if low > -0.5 * NO_EDGE and high < 0.5 * NO_EDGE:
                middle = 0.5 * (low + high)
                if count_2[j] > 0 or abs(arc_1 + middle - known_at[j]) > SAME_M:
                    known_at[j] = arc_1 + middle
                    at_1, at_2 = _height(arc_1 + middle, base_1, half_1), _height(arc_2 - middle, base_2, half_2)
                    known[j] = depth_on_line(j, at_1, face_1, pits_1, crossing_1, row_1, low_1, high_1)
                    known[j] += depth_on_line(j, at_2, face_2, pits_2, crossing_2, row_2, low_2, high_2)
                notch_m[i, j] = known[j]
            for k in range(damaged):
                if room[0, k] < 0.0 < room[1, k]:
                    on_damage[i, j] = part
                    floor_m[i, j] = depth_on_line(j, height_1, face_1, pits_1, crossing_1, row_1, low_1, high_1)
                    if count_2[j] > 0:
                        floor_m[i, j] += depth_on_line(j, height_2, face_2, pits_2, crossing_2, row_2, low_2, high_2)
                    break


@entry(cache=True)
def _nearest(room: FloatArray, count: int) -> tuple[float, float]:
    """Return the gap that holds 0, else the nearest one, grown by all intervals that it touches."""
    first, least = 0, np.inf
    for k in range(count):
        away = max(room[0, k], -room[1, k])
        if away < least:
            first, least = k, away
    low, high = room[0, first], room[1, first]
    grown = True
    while grown:
        grown = False
        for k in range(count):
            if room[0, k] <= high and room[1, k] >= low and (room[0, k] < low or room[1, k] > high):
                low, high = min(low, room[0, k]), max(high, room[1, k])
                grown = True
    return low, high


@njit(cache=True)
def _height(arc: float, base_radius: float, half_angle: float) -> float:
    """Return the height of a point of the flank at an arc, signed as the radius; NaN beside the involute [m]."""
    square = 2.0 * arc / base_radius
    if square <= 0.0:
        return np.nan
    return involute.height(sqrt(square), abs(base_radius), half_angle)


# UnevenTeeth: a tooth that is softer in a part of the face, by a crack whose depth is not the same everywhere.
#
# Derived. A sound tooth is slices on springs that hang together (`tooth_kernel`): per unit of its compliance C the
# deflection t under line loads q solves (1 + L) t = q, 1 + L the inverse of T and L 1 = 0. A crack softens the
# springs, the one of slice i from 1/C to 1/(C + Δ_i), and with them what slices hang together by, so that T keeps its
# length:
#
#     (k L + 1 - φ_i) t = q,    φ_i = Δ_i/(C + Δ_i),    k = 1 - mean φ
#
# An even crack is C + Δ times the T of the sound tooth. A tooth that is rigid across the face (l → ∞) has the mean
# stiffness of its slices. Finite elements in three dimensions: `tests.reference.finite_elements.part_crack`.
#
# Pinion and gear tooth are one kernel of this form. Under an even load it gives way as both together do in each slice.


class UnevenTeeth(NamedTuple):
    """Of pinion and gear tooth at positions (k,): C (2, k), and Δ (2, k, n) on the slices [m/N]."""

    sound_m_per_n: FloatArray
    added_m_per_n: FloatArray

    def at(self, chosen: np.ndarray) -> UnevenTeeth:
        """Return them at some of the positions."""
        return UnevenTeeth(self.sound_m_per_n[:, chosen], self.added_m_per_n[:, chosen])

    def kernel(self, unit: ToothKernel, i: int, face_width_m: float, kappa_per_pa: float) -> ToothKernel:
        """Return γ T of both teeth at position i; `unit` is that of sound teeth."""
        matrix = _softened(tooth_matrix(unit), self.sound_m_per_n[:, i], self.added_m_per_n[:, i])
        gamma = float(self.sound_m_per_n[:, i].sum()) * face_width_m / kappa_per_pa
        strength, decay = _generators(matrix)
        return ToothKernel(
            gamma * strength, decay, gamma * np.diagonal(matrix).copy(), gamma * float(matrix.sum(axis=1).mean())
        )


def _softened(unit: FloatArray, sound: FloatArray, added: FloatArray) -> FloatArray:
    """Return T (n, n) of two teeth over the sum of their C (2,), from that of sound ones and Δ (2, n)."""
    count, shares = len(unit), sound / sound.sum()
    deflection, hanging, softer = np.zeros(count), np.zeros(count), 0.0
    for share, own, more in zip(shares, sound, added, strict=True):
        if share == 0.0:
            continue
        lost = more / (own + more)
        kept = 1.0 - lost.mean()
        # with 1 + L = inverse of T, times T: no inverse is needed, and a rigid tooth has none
        alone = np.linalg.solve(kept * np.eye(count) + unit * (lost.mean() - lost), np.ones(count))
        deflection += share * alone
        hanging += share * (1.0 - (1.0 - lost) * alone) / kept
        softer += share / kept
    kept = 1.0 / softer
    springs = (1.0 - kept * hanging) / deflection
    found = np.linalg.solve(kept * np.eye(count) + unit * (springs - kept), unit)
    return 0.5 * (found + found.T)


def _generators(matrix: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return p and q (n,) of a matrix T_ij = p_i Π q_k, j < k <= i, from three diagonals."""
    beside, next_but_one = np.diagonal(matrix, -1), np.diagonal(matrix, -2)
    decay = np.ones(len(matrix))
    decay[1:-1] = next_but_one / beside[1:]
    strength = np.append(1.0, beside / decay[1:])
    return strength, decay


# PairRest: compliance of a pair without its contact, by how it gives way across the face.
#
# Fitted to finite elements of teeth on their rings in three dimensions (extruded, bore clamped, free ends, read at the
# tooth's centre line, so that it adds to the contact's kernel). Of a gear's compliance c
#
#     c_t          is rigid across the face: the torsion of its body (`body_coupling.ring_torsion`)
#     c - c_t      bends with the load at its place, over the length l (`tooth_kernel`)
#     l            = 1.75 m (1 - exp(-b/(2.4 m))), m the module: narrow faces stay together more
#
# For the pair 18/47 the tilt compliance and the deflection under loads on a part of the face are within 6.5 % of the
# finite elements from b = 6.7 modules on, 7.1 % at 4 and 10.1 % at 2 (`tests.reference.finite_elements.face_kernel`);
# of single gears tilt errs by up to 21 %, the other way on either.

WIDE_MODULES, NARROW_MODULES = 1.75, 2.4
"""Length l of wide faces over the module, and the face width, in modules, over which it is reached."""


class PairRest(NamedTuple):
    """At positions (k,): `rigid_m_per_n`, and `tooth_m_per_n` that bends over `length_m` (one number).

    `uneven`: what is softer in a part of the face, beside it; None: nothing is.
    """

    rigid_m_per_n: FloatArray
    tooth_m_per_n: FloatArray
    length_m: float
    uneven: UnevenTeeth | None = None

    def at(self, chosen: np.ndarray) -> PairRest:
        """Return it at some of the positions."""
        uneven = None if self.uneven is None else self.uneven.at(chosen)
        return PairRest(self.rigid_m_per_n[chosen], self.tooth_m_per_n[chosen], self.length_m, uneven)


def pair_rest(
    pair: GearPair,
    teeth: tuple[ToothCompliance, ToothCompliance],
    options: StiffnessOptions,
    standing: tuple[float, float] = (1.0, 1.0),
    added_m_per_n: FloatArray | None = None,
) -> PairRest:
    """Return the rest of pinion and gear tooth (k,) each; without foundation no body twists.

    `standing` is the share of the face, at its end, over which either tooth still stands; `added_m_per_n` (2, k, n)
    what is added to slices of either tooth, beside its compliance.
    """
    whole = np.add(teeth[0].total, teeth[1].total)
    bends, softer = np.zeros_like(whole), np.zeros_like(whole)
    alone = []
    for gear, tooth, share in zip((pair.pinion, pair.gear), teeth, standing, strict=True):
        twist = 0.0
        if options.foundation != "none":
            twist = ring_torsion(gear, pair.poisson_ratio) / (pair.youngs_modulus_pa * pair.face_width_m)
        own = np.maximum(tooth.total - twist, 0.0)
        bends += own
        if share < 1.0:
            softer += (strip_factor(pair, share) - 1.0) * own
        alone.append(own)
    uneven = None if added_m_per_n is None else UnevenTeeth(np.stack(alone), added_m_per_n)
    return PairRest(whole - bends, bends + softer, bending_length_m(pair), uneven)


def strip_factor(pair: GearPair, share: float) -> float:
    """Return by how much teeth must bend more for a strip at an end of the face to be a tooth of its own.

    Derived. Of t - l² t'' = C b q with free ends, an even load on the share f at one end sinks, on its mean, by

        (C/f) F [1 - (l/(f b)) sinh((1 - f) b/l) sinh(f b/l)/sinh(b/l)],

    since what is beside it helps; where nothing is there, by (C/f) F.
    """
    if share <= 0.0:
        return 1.0  # nothing stands that could carry
    width = pair.face_width_m / bending_length_m(pair)
    helped = sinh((1.0 - share) * width) * sinh(share * width) / (share * width * sinh(width))
    return 1.0 / (1.0 - helped)


def bending_length_m(pair: GearPair) -> float:
    """Return the length across the face over which teeth bend together [m]."""
    module = pair.pinion.module_m * cos(pair.helix_rad)
    return WIDE_MODULES * module * (1.0 - exp(-pair.face_width_m / (NARROW_MODULES * module)))


# Slices of helical teeth: what each meets and how its teeth give way, at its own place on the path.
#
# A slice beside the path of contact is that at the end of the path, and misses what the corner of the tip leaves
# there. Damage is found by each slice on its own line across the face, at the slice's own place: contact lines cross
# it aslant.

POINTS = 2049
"""Of curves over the path that slices are interpolated in."""
CORNERS = 0.3
"""How far beside the path corners are followed, in base pitches; farther slices miss more by as much as they go on."""


def helical_gaps(pair: GearPair, place_m: FloatArray, pinion: FlankChords, gear: FlankChords) -> FaceGaps:
    """Return the gaps of damage and tips at places of slices (k, n) [m]; both flanks have n slices."""
    places = np.ascontiguousarray(_on_path(pair, place_m).T)
    alone = [face_gaps(pair, one_line(pinion, j), one_line(gear, j), own) for j, own in enumerate(places)]
    return FaceGaps(*(np.concatenate(of_slices, axis=1) for of_slices in zip(*alone, strict=True)))


def helical_missing_m(pair: GearPair, place_m: FloatArray, relief: TipRelief | None) -> FloatArray:
    """Return what relief and corners leave out at places of slices (k, n) [m]."""
    start, end, reach = pair.contact_start_m, pair.contact_end_m, CORNERS * pair.base_pitch_m
    # Curves begin and end anew at the ends of the path, where relief stops and corners take over.
    parts = (
        np.linspace(start - reach, start, POINTS // 4)[:-1],
        np.linspace(start, end, POINTS),
        np.linspace(end, end + reach, POINTS // 4)[1:],
    )
    along = np.concatenate(parts)
    curve = sum(missing_at_m(pair, side, relief, along) for side in Side)
    beyond = np.abs(place_m - np.clip(place_m, along[0], along[-1]))
    return np.asarray(np.interp(place_m, along, curve) + beyond)


def helical_rest(pair: GearPair, place_m: FloatArray, options: StiffnessOptions) -> PairRest:
    """Return how both teeth give way at places of slices (k, n) [m], each slice as at its own height.

    Rigid across the face is what a body does in the middle of the line: its torsion, and its bending along the axis.
    """
    along = np.linspace(pair.contact_start_m, pair.contact_end_m, POINTS)
    place, own, rigid = _on_path(pair, place_m), [], np.zeros(len(place_m))
    middle = carrying_middle_m(pair, 0.5 * (place_m[:, 0] + place_m[:, -1]))
    for side, rolls in zip(Side, rolls_at(pair, along), strict=True):
        body = axial_part(pair, side, rolls, options)
        if options.foundation != "none":
            twist = ring_torsion(pair.member(side), pair.poisson_ratio) / (pair.youngs_modulus_pa * pair.face_width_m)
            body = body + twist
        bends = np.maximum(tooth_compliance(pair, side, rolls, options).total - body, 0.0)
        own.append(np.interp(place, along, bends))
        rigid += np.interp(middle, along, body)
    sound = np.stack([one.min(axis=1) for one in own])
    added = np.stack(own) - sound[:, :, np.newaxis]
    mean = np.sum([one.mean(axis=1) for one in own], axis=0)
    return PairRest(rigid, mean, bending_length_m(pair), UnevenTeeth(sound, added))


def _on_path(pair: GearPair, place_m: FloatArray) -> FloatArray:
    return np.asarray(np.clip(place_m, pair.contact_start_m, pair.contact_end_m))


# FaceSlices of a tooth pair at its contact positions, from geometry, gaps, lead and compliance.


class FaceOptions(NamedTuple):
    """How contacts across the face are reckoned.

    `line_load_n_per_m`: a typical load, which sets from which depth slices count as not carrying; `edge_radius_m`: of
    the edges of damage, 0 for sharp ones; `coupled`: whether slices act on each other.
    """

    line_load_n_per_m: float
    edge_radius_m: float = 0.0
    coupled: bool = True


def contact_kappa(pair: GearPair) -> float:
    """Return κ = 2/(π E*) = 4 (1 - ν²)/(π E) of gears of one material [1/Pa]; over cos β_b in the transverse plane."""
    return 4.0 * (1.0 - pair.poisson_ratio**2) / (pi * pair.youngs_modulus_pa) / cos(pair.base_helix_rad)


def pair_faces(
    pair: GearPair,
    gaps: FaceGaps,
    position_m: FloatArray,
    rest: PairRest,
    options: FaceOptions,
    lead_m: FloatArray | None = None,
    radii_m: FloatArray | None = None,
    rough: FloatArray | None = None,
) -> list[FaceSlices]:
    """Return the slices at positions s (k,) [m].

    Parameters
    ----------
    pair : GearPair
    gaps : FaceGaps
        At these positions, (k, n).
    position_m : (k,)
    rest : PairRest
        Compliance of the pair without its contact, (k,).
    options : FaceOptions
    lead_m : (n,), (k, n) or None
        Missing material across the face, of any sign; None: none.
    radii_m : (k, n) or None
        Relative radii of curvature of the slices [m]; None: as in the middle.
    rough : (k, n) or None
        Parts of slices that are rough land; None: none.
    """
    count = gaps.left_m.shape[1]
    leads = np.zeros(count) if lead_m is None else np.ascontiguousarray(lead_m, dtype=np.float64)
    cell = pair.face_width_m / count
    face = cell * (np.arange(count) + 0.5) - 0.5 * pair.face_width_m
    rolls = {Side.DRIVER: position_m / pair.pinion.base_radius_m}
    rolls[Side.DRIVEN] = (pair.line_of_action_m - position_m) / pair.gear.signed_base_radius_m
    first, second = (centre_line_depth(pair, side, roll) for side, roll in rolls.items())
    depth = np.sqrt(first * second)
    radius = position_m * (pair.line_of_action_m - position_m) / pair.line_of_action_m
    kappa = contact_kappa(pair)
    unit = unit_tooth(count, pair.face_width_m, rest.length_m)
    spread = spread_of_cells(cell / _reference_width(pair))
    family = kernel_family(count, cell, _typical_depth(pair))
    kernels = line_kernels(family, depth, pair.poisson_ratio, coupled=options.coupled)
    lengths = carrying_length(gaps, leads, cell, radius, kappa * options.line_load_n_per_m)
    out = []
    for i in range(position_m.size):
        here = FaceGaps(*(np.ascontiguousarray(array[i]) for array in gaps))
        slices = FaceSlices(
            left_m=here.left_m,
            right_m=here.right_m,
            notch_m=here.notch_m,
            floor_m=here.floor_m,
            rough=np.zeros(count) if rough is None else np.ascontiguousarray(rough[i]),
            covered=here.covered,
            lead_m=leads if leads.ndim == 1 else leads[i],
            face_m=face,
            tips_m=here.tips_m,
            spread=spread,
            kernel=kernels[i],
            teeth=_teeth(unit, rest, i, pair.face_width_m, kappa),
            radius_m=float(radius[i]),
            radii_m=np.full(count, radius[i]) if radii_m is None else np.ascontiguousarray(radii_m[i]),
            rounding_m=options.edge_radius_m,
            kappa_per_pa=kappa,
            compliance_m_per_n=float(rest.rigid_m_per_n[i]),
            carrying_m=float(lengths[i]),
        )
        out.append(slices)
    return out


def _teeth(unit: ToothKernel, rest: PairRest, i: int, face_width_m: float, kappa_per_pa: float) -> ToothKernel:
    """Return how the teeth give way at position i."""
    if rest.uneven is not None:
        return rest.uneven.kernel(unit, i, face_width_m, kappa_per_pa)
    return tooth_kernel(unit, float(rest.tooth_m_per_n[i]), face_width_m, kappa_per_pa)


def _reference_width(pair: GearPair) -> float:
    """Return Hertz's half width of the reference force in the middle of the path [m]."""
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m)])
    return float(half_width(pair, middle, pair.reference_force_n)[0])


def _typical_depth(pair: GearPair) -> float:
    """Return Weber and Banaschek's depth in the middle of the path [m]."""
    middle = 0.5 * (pair.contact_start_m + pair.contact_end_m)
    rolls = {
        Side.DRIVER: middle / pair.pinion.base_radius_m,
        Side.DRIVEN: (pair.line_of_action_m - middle) / pair.gear.signed_base_radius_m,
    }
    return float(
        np.sqrt(np.prod([float(centre_line_depth(pair, side, np.array([roll]))[0]) for side, roll in rolls.items()]))
    )


def carrying_length(
    gaps: FaceGaps, lead_m: FloatArray, cell_m: float, radius_m: FloatArray, load_m: float
) -> FloatArray:
    """Return L (...,) [m] of slices (..., n): each weighted by how little it lies below the least sunk one.

    Derived: a slice that lies lower by several κq [m] (`load_m`, of a typical load) does not carry; one that sinks with
    all others does. The weight is smooth, so that L is continuous over the position. A slice that a gap
    covers in part counts by its parts.
    """
    round_m = 2.0 * np.asarray(radius_m)[..., np.newaxis]
    near = np.maximum(np.minimum(gaps.left_m, gaps.right_m), 0.0)
    floor = np.where(gaps.floor_m > 0.0, gaps.floor_m, np.inf)
    sunk = np.minimum(near**2 / round_m, floor) + lead_m
    partly = (gaps.covered > 0.0) & (gaps.covered < 1.0)
    land = np.where(partly, lead_m + np.maximum(gaps.nearest_tip_m, 0.0) ** 2 / round_m, np.inf)
    least = np.minimum(sunk, land).min(axis=-1, keepdims=True)
    weight, beside = (1.0 / (1.0 + ((depth - least) / (4.0 * load_m)) ** 2) for depth in (sunk, land))
    whole = np.where(partly, gaps.covered, 1.0)
    return np.asarray(cell_m * (whole * weight + (1.0 - whole) * beside).sum(axis=-1))
