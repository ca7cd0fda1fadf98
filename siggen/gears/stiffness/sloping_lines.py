"""Contact lines of helical teeth, which slope over flanks and damage: how long they are and what damage takes of them.

Derived. The face is cut into slices, each at its own place on the path of contact. A slice counts by the part of it
that is on the path, and is lost by the part whose line lies in a chord of the damage of either flank (`flank_chords`),
both exact for a straight line across the slice. A line that loses a share of its length touches harder on the rest, as
on spur teeth: its contact gives way by 1/(1 - share), its teeth as before.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.damage.flank_chords import FlankChords, flank_chords
from siggen.gears.damage.tooth_damage import ToothDamage
from siggen.gears.damage.whole_loss import WHOLE_FACE
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.helical import slice_shifts_m
from siggen.names import Side

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
