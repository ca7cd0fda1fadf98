"""Stiffness of one tooth pair along the line of action, and of the whole mesh over the pinion's angle.

Source: paper A, section 2.2 (structure); contact laws: `siggen.mesh.hertz`, once per pair. The map from
angle to contact is linear in the roll angle: s = s_A + R_b1 (theta - 2 pi n/z1) for the n-th pair since angle 0.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import ArrayLike

from siggen.arrays import FloatArray, IntArray
from siggen.damage.flank_chords import FlankChords, flank_chords
from siggen.damage.flank_damage import pit_rows
from siggen.damage.part import Damage, ToothDamage, damaged_teeth, pits_of
from siggen.damage.union import lengths_covered
from siggen.damage.whole_loss import WHOLE_FACE
from siggen.gears import involute
from siggen.gears.gear_pair import GearPair
from siggen.gears.helical import slice_shifts_m
from siggen.mesh.body_coupling import coupled_sum
from siggen.mesh.hertz import linear_compliance, weber_banaschek_compliance
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_compliance import ROLL_TOLERANCE, ToothCompliance, tooth_compliance, tooth_compliances
from siggen.names import Side

# Contact lines of helical teeth, which slope over flanks and damage: how long they are and what damage takes of them.
#
# Derived. The face is cut into slices, each at its own place on the path of contact. A slice counts by the part of it
# that is on the path, and is lost by the part whose line lies in a chord of the damage of either flank
# (`flank_chords`), both exact for a straight line across the slice. A line that loses a share of its length touches
# harder on the rest, as on spur teeth: its contact gives way by 1/(1 - share), its teeth as before.

SLICES = 128
"""Of a face: their means err by 1e-5 of the stiffness (tested)."""
POSITIONS = 2049
"""Of lines among which the most damaged one is looked for."""
POINTS = 1025
"""Of curves over the path that slices are interpolated in."""


def path_points_m(pair: GearPair) -> FloatArray:
    """Return the positions on the path at which `line_stiffness` takes compliances (POINTS,) [m]."""
    return np.linspace(pair.contact_start_m, pair.contact_end_m, POINTS)


def line_stiffness(
    pair: GearPair, position_m: FloatArray, contact_m_per_n: FloatArray, teeth_m_per_n: FloatArray, lost: FloatArray
) -> FloatArray:
    """Return the stiffness of a pair whose middle of the face is at positions (k,) (k,) [N/m].

    Parameters
    ----------
    pair : GearPair
    position_m : (k,)
        From `engagement_start_m` to `engagement_end_m`, in any order [m].
    contact_m_per_n, teeth_m_per_n : (POINTS,)
        Compliances of the whole face at `path_points_m` without damage of the contact.
    lost : (k,)
        Share of the line that damage takes; a line that is lost as a whole carries nothing.
    """
    along, place = path_points_m(pair), _places_m(pair, position_m)
    whole = lost >= 1.0 - WHOLE_FACE
    harder = (1.0 / np.where(whole, 1.0, 1.0 - lost))[:, np.newaxis]
    contact, teeth = (np.interp(place, along, curve) for curve in (contact_m_per_n, teeth_m_per_n))
    carried = (_on_path(pair, place) / (harder * contact + teeth)).mean(axis=1)
    return np.asarray(np.where(whole, 0.0, carried))


def line_lengths_m(
    pair: GearPair, position_m: FloatArray, pinion_pits: Iterable[ToothDamage], gear_pits: Iterable[ToothDamage]
) -> tuple[FloatArray, FloatArray]:
    """Return what damage takes of contact lines, and how long they are, (k,) each, measured along the face [m].

    `position_m` (k,): where the middle of the face is, in any order [m].
    """
    place = _places_m(pair, position_m)
    on_path, lost = _on_path(pair, place), np.zeros(place.shape)
    for side, pits in ((Side.DRIVER, pinion_pits), (Side.DRIVEN, gear_pits)):
        chords = flank_chords(pair.member(side), pits, pair.face_width_m, SLICES)
        along = place if side == Side.DRIVER else pair.line_of_action_m - place
        for j in np.flatnonzero(chords.intervals):
            lost[:, j] = np.maximum(lost[:, j], chords.covered[j] * _inside(pair, chords, int(j), along[:, j]))
    slice_m = pair.face_width_m / SLICES
    return slice_m * np.minimum(lost, on_path).sum(axis=1), slice_m * on_path.sum(axis=1)


def largest_line_loss(
    pair: GearPair, pinion_pits: Iterable[ToothDamage], gear_pits: Iterable[ToothDamage]
) -> tuple[float, bool]:
    """Return what damage takes at most of a contact line, along the face [m], and whether it takes a whole line."""
    position = np.linspace(pair.engagement_start_m, pair.engagement_end_m, POSITIONS)
    lost, length = line_lengths_m(pair, position, pinion_pits, gear_pits)
    return float(lost.max()), bool(np.any((length > 0.0) & (lost >= (1.0 - WHOLE_FACE) * length)))


def lost_shares(
    pair: GearPair, position_m: FloatArray, pinion_pits: Iterable[ToothDamage], gear_pits: Iterable[ToothDamage]
) -> FloatArray:
    """Return the share of contact lines that damage takes (k,); 0 where there is no line."""
    lost, length = line_lengths_m(pair, position_m, pinion_pits, gear_pits)
    return np.asarray(lost / np.maximum(length, np.finfo(np.float64).tiny))


def _inside(pair: GearPair, chords: FlankChords, j: int, along_m: FloatArray) -> FloatArray:
    """Return which part of slice j lies in chords of the damage at places on the path of its gear (k,)."""
    half = 0.5 * pair.face_travel_m / SLICES
    one, two = ((along_m + end) * np.abs(along_m + end) / (2.0 * chords.base_radius_m) for end in (-half, half))
    low, span = np.minimum(one, two), np.abs(two - one)
    found = np.zeros(along_m.size)
    for i in range(int(chords.intervals[j])):
        ends = (np.clip((end - low) / span, 0.0, 1.0) for end in (chords.high[j, i], chords.low[j, i]))
        found += np.subtract(*ends)
    return found


def _places_m(pair: GearPair, position_m: FloatArray) -> FloatArray:
    return np.asarray(np.asarray(position_m)[:, np.newaxis] + slice_shifts_m(pair, SLICES))


def _on_path(pair: GearPair, place_m: FloatArray) -> FloatArray:
    """Return the part of every slice (k, n) that is on the path of contact."""
    half = 0.5 * pair.face_travel_m / SLICES
    first, last = (np.clip(place_m + end, pair.contact_start_m, pair.contact_end_m) for end in (-half, half))
    return np.asarray((last - first) / (2.0 * half))


__all__ = [
    "PairCompliance",
    "StiffnessOptions",
    "ToothCompliance",
    "contact_compliance",
    "mesh_stiffness",
    "pair_compliance",
    "pair_stiffness",
    "tooth_compliance",
]


LINEAR = StiffnessOptions()
"""The options of a contact that does not depend on the force."""


@dataclass(frozen=True, slots=True)
class PairCompliance:
    """Compliance of a tooth pair at each contact in its parts: contact (k,) [m/N] and both teeth."""

    contact: FloatArray
    pinion: ToothCompliance
    gear: ToothCompliance

    @property
    def total(self) -> FloatArray:
        """Sum of all parts, (k,) [m/N]."""
        return self.contact + self.pinion.total + self.gear.total


def rolls_at(pair: GearPair, position_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the roll angles (k,) of pinion and gear flank at contact positions s (k,) [rad].

    Raises
    ------
    ValueError
        If a position is not finite or not on the path of contact.
    """
    start, end = pair.contact_start_m, pair.contact_end_m
    slack = ROLL_TOLERANCE * end
    if not bool(np.all((position_m >= start - slack) & (position_m <= end + slack))):
        span = f"{np.min(position_m):.6g} to {np.max(position_m):.6g}"
        raise ValueError(f"position_m {span} m is off the path of contact; allowed: {start:.6g} to {end:.6g} m")
    clipped = np.clip(position_m, start, end)
    return clipped / pair.pinion.base_radius_m, (pair.line_of_action_m - clipped) / pair.gear.signed_base_radius_m


def contact_compliance(
    pair: GearPair,
    position_m: ArrayLike,
    pinion_pits: Iterable[ToothDamage] = (),
    gear_pits: Iterable[ToothDamage] = (),
    options: StiffnessOptions = LINEAR,
    *,
    through_face: bool = False,
) -> FloatArray:
    """Return 1/k_h of a tooth pair at contact positions (k,) [m/N].

    The contact length is what the pits of both flanks together leave of the face.

    Parameters
    ----------
    pair : GearPair
    position_m : (k,)
        Contact positions from the pinion's base tangent point, of helical teeth those of the middle of the face, in any
        order [m].
    pinion_pits, gear_pits : iterables of ToothDamage
        Pits of the two teeth in contact; their `gear` and `tooth` are not read.
    options : StiffnessOptions
        Contact law and its force; the tooth's options are not read.
    through_face : bool
        Whether a contact may lose its whole length; its compliance is infinite there.

    Raises
    ------
    ValueError
        If a position is off the path of contact, or the whole contact length is lost where that is not allowed.

    Source: `siggen.mesh.hertz`; the remaining length as contact length: paper A, section 2.2.
    """
    position = np.atleast_1d(np.asarray(position_m, dtype=np.float64))
    width, lost = pair.face_width_m, _lost_m(pair, position, tuple(pinion_pits), tuple(gear_pits))
    worst = float(np.max(lost, initial=0.0))
    if worst >= width * (1.0 - WHOLE_FACE) and not through_face:
        raise ValueError(f"pits take {worst:.6g} m of contact length; allowed: less than the face width {width:.6g} m")
    open_face = lost >= width * (1.0 - WHOLE_FACE)
    return np.where(open_face, np.inf, _law(pair, position, np.where(open_face, width, width - lost), options))


def _lost_m(pair: GearPair, position_m: FloatArray, pinion_pits: Damage, gear_pits: Damage) -> FloatArray:
    """Return the contact length that pits of two teeth take (k,) [m]; of helical teeth as if all were on the path."""
    if pair.helix_rad != 0.0:
        return lost_shares(pair, position_m, pinion_pits, gear_pits) * pair.face_width_m
    rows_pinion, rows_gear = pit_rows(pinion_pits), pit_rows(gear_pits)
    if not (rows_pinion.size or rows_gear.size):
        return np.zeros(position_m.size)
    roll_pinion, roll_gear = rolls_at(pair, position_m)
    pinion, gear = pair.pinion, pair.gear
    height_pinion = involute.heights(roll_pinion, pinion.base_radius_m, pinion.base_half_angle_rad)
    height_gear = involute.heights(roll_gear, gear.base_radius_m, gear.base_half_angle_rad)
    return lengths_covered(height_pinion, rows_pinion, height_gear, rows_gear, pair.face_width_m)


def _law(pair: GearPair, position_m: FloatArray, length_m: FloatArray, options: StiffnessOptions) -> FloatArray:
    if options.hertz_force_n is None:
        return linear_compliance(pair, length_m)
    return weber_banaschek_compliance(pair, *rolls_at(pair, position_m), length_m, options.hertz_force_n)


def pair_compliance(
    pair: GearPair,
    position_m: ArrayLike,
    options: StiffnessOptions,
    pinion_pits: Iterable[ToothDamage] = (),
    gear_pits: Iterable[ToothDamage] = (),
    *,
    through_face: bool = False,
) -> PairCompliance:
    """Return the compliance of one tooth pair in its parts, (k,) each [m/N].

    Arguments and errors are those of `pair_stiffness`, which is the inverse of the sum.

    Source: paper A, section 2.2 (springs in series).
    """
    position = np.atleast_1d(np.asarray(position_m, dtype=np.float64))
    pinion_pits, gear_pits = tuple(pinion_pits), tuple(gear_pits)
    roll_pinion, roll_gear = rolls_at(pair, position)
    return PairCompliance(
        contact=contact_compliance(pair, position, pinion_pits, gear_pits, options, through_face=through_face),
        pinion=tooth_compliance(pair, Side.DRIVER, roll_pinion, options, pinion_pits),
        gear=tooth_compliance(pair, Side.DRIVEN, roll_gear, options, gear_pits),
    )


def pair_stiffness(
    pair: GearPair,
    position_m: ArrayLike,
    options: StiffnessOptions,
    pinion_pits: Iterable[ToothDamage] = (),
    gear_pits: Iterable[ToothDamage] = (),
    *,
    through_face: bool = False,
) -> FloatArray:
    """Return the stiffness of one tooth pair at contact positions s (k,) [N/m].

    Parameters
    ----------
    pair : GearPair
    position_m : (k,)
        Contact positions from the pinion's base tangent point, s_A to s_E, in any order [m].
    options : StiffnessOptions
    pinion_pits, gear_pits : iterables of ToothDamage
        Pits of the two teeth in contact; their `gear` and `tooth` are not read.
    through_face : bool
        Whether a contact may lose its whole length; the pair has no stiffness there.

    Raises
    ------
    ValueError
        If a position is off the path of contact, or the pits leave no section, or no contact where that is not allowed.

    Source: paper A, section 2.2.
    """
    return 1.0 / pair_compliance(pair, position_m, options, pinion_pits, gear_pits, through_face=through_face).total


def kinds_stiffness(
    pair: GearPair,
    position_m: FloatArray,
    options: StiffnessOptions,
    kinds: Sequence[tuple[Damage, Damage]],
    *,
    through_face: bool = False,
) -> FloatArray:
    """Return the stiffness of one pair with different damage of pinion and gear tooth (kinds, k) [N/m].

    Parameters
    ----------
    pair : GearPair
    position_m : (k,)
        Of spur teeth contact positions as for `pair_stiffness`; of helical teeth where the middle of the face is, from
        `engagement_start_m` to `engagement_end_m` [m].
    options : StiffnessOptions
    kinds : sequence of (Damage, Damage)
        Of the pinion's and the gear's tooth.
    through_face : bool
        Whether a contact may lose its whole length; the pair has no stiffness there.

    Raises
    ------
    ValueError
        As `pair_stiffness`.

    Source: `pair_stiffness`; along the sloping lines of helical teeth `siggen.mesh.mesh_stiffness`.
    """
    at = position_m if pair.helix_rad == 0.0 else path_points_m(pair)
    teeth = []
    for side, rolls, own in zip(Side, rolls_at(pair, at), zip(*kinds, strict=True), strict=True):
        distinct = list(dict.fromkeys(own))
        found = tooth_compliances(pair, side, rolls, options, distinct)
        teeth.append({pits: one.total for pits, one in zip(distinct, found, strict=True)})
    out = np.empty((len(kinds), position_m.size))
    for row, (first, second) in enumerate(kinds):
        pinion, gear = teeth[0][first], teeth[1][second]
        if pair.helix_rad == 0.0:
            contact = contact_compliance(pair, at, first, second, options, through_face=through_face)
            out[row] = 1.0 / (contact + pinion + gear)
            continue
        lost = lost_shares(pair, position_m, first, second)
        if not through_face and float(np.max(lost, initial=0.0)) >= 1.0 - WHOLE_FACE:
            raise ValueError("pits take a whole contact line; allowed: a part of every line")
        out[row] = line_stiffness(pair, position_m, contact_compliance(pair, at, options=options), pinion + gear, lost)
    return out


def mesh_stiffness(
    pair: GearPair,
    angle_rad: ArrayLike,
    options: StiffnessOptions,
    damage: Damage = (),
    *,
    through_face: bool = False,
) -> FloatArray:
    """Return the mesh stiffness over the pinion's angle (k,) [N/m].

    Parameters
    ----------
    pair : GearPair
    angle_rad : (k,)
        Pinion angle since the pair of pinion tooth 0 and gear tooth 0 entered contact; any value [rad]. Pair n of the
        global count is pinion tooth n mod z1 and gear tooth n mod z2, at s = s_A + R_b1 (angle - 2 pi n/z1), of helical
        teeth with `engagement_start_m` for s_A. Zones are closed.
    options : StiffnessOptions
    damage : tuple of ToothDamage
        On any teeth of both gears.
    through_face : bool
        Whether a contact may lose its whole length; such a pair adds nothing.

    Raises
    ------
    ValueError
        If the pits leave no section, or no contact where that is not allowed.

    Source: paper A, section 2.2 (pairs in parallel, only the pair of a damaged tooth is softer); with coupling 'body'
    derived (`siggen.mesh.body_coupling`).
    """
    angle = np.atleast_1d(np.asarray(angle_rad, dtype=np.float64))
    index, count, position = pairs_in_contact(pair, angle)
    pinion_bad, gear_bad = damaged_teeth(damage, Side.DRIVER), damaged_teeth(damage, Side.DRIVEN)
    pinion_tooth, gear_tooth = count % pair.pinion.teeth, count % pair.gear.teeth
    # -1 stands for any healthy tooth: all such pairs are evaluated in one go.
    pinion_key = np.where(np.isin(pinion_tooth, pinion_bad), pinion_tooth, -1)
    gear_key = np.where(np.isin(gear_tooth, gear_bad), gear_tooth, -1)
    total, stiffness = np.zeros(angle.size), np.empty(index.size)
    for first, second in sorted(set(zip(pinion_key.tolist(), gear_key.tolist(), strict=True))):
        chosen = (pinion_key == first) & (gear_key == second)
        kind = pits_of(damage, Side.DRIVER, first), pits_of(damage, Side.DRIVEN, second)
        stiffness[chosen] = kinds_stiffness(pair, position[chosen], options, (kind,), through_face=through_face)[0]
        np.add.at(total, index[chosen], stiffness[chosen])
    if options.coupling == "none":
        return total
    return coupled_sum(pair, options, (index, count, position), stiffness, angle.size)


def pairs_in_contact(pair: GearPair, angle_rad: FloatArray) -> tuple[IntArray, IntArray, FloatArray]:
    """Return (index into `angle_rad`, global pair count n, position s [m]) of every pair in contact, each (m,).

    Positions of helical pairs are those of the middle of the face.
    """
    start, end, pitch = pair.engagement_start_m, pair.engagement_end_m, pair.base_pitch_m
    travel = angle_rad * pair.pinion.base_radius_m
    newest = np.floor(travel / pitch).astype(np.int64)
    indices, counts, positions = [], [], []
    # One pair more on either side: at a zone edge rounding may put the floor on the wrong pair.
    for back in range(-1, ceil(pair.total_contact_ratio) + 2):
        count = newest - back
        position = start + (travel - count * pitch)
        inside = (position >= start) & (position <= end)
        indices.append(np.flatnonzero(inside))
        counts.append(count[inside])
        positions.append(position[inside])
    return np.concatenate(indices), np.concatenate(counts), np.concatenate(positions)
