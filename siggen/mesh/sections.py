"""Exact losses of contact length, area and second moment of a pitted tooth, and the area of its damage.

Derived: unions of outlines (ellipses: paper A, section 2.1), neither summed nor rasterised; see
`siggen.damage.union`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import ArrayLike

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit
from siggen.damage.flank_damage import pit_rows
from siggen.damage.heights import flank_heights
from siggen.damage.kinks import section_kinks
from siggen.damage.part import ToothDamage
from siggen.damage.row_columns import COLUMNS
from siggen.damage.union import (
    Intervals,
    active_pits,
    add_intervals,
    covered_length,
    depth_moments,
    interval_room,
    lengths_covered,
    stretch_room,
)
from siggen.gears import involute
from siggen.gears.spur_gear import SpurGear
from siggen.mesh.pitted_beams import flank_area, section_losses

GOLDEN = 0.5 * (sqrt(5.0) - 1.0)


@dataclass(frozen=True, slots=True)
class SectionLoss:
    """Losses of contact length [m], area [m2] and second moment about the shifted neutral axis [m4], each (k,)."""

    contact_length_m: FloatArray
    area_m2: FloatArray
    inertia_m4: FloatArray


def contact_length_loss(pits: Iterable[ToothDamage], face_width_m: float, height_m: ArrayLike) -> FloatArray:
    """Return the face length that the pits of one flank cover at heights x (k,) [m].

    Parameters
    ----------
    pits : iterable of ToothDamage
        Pits of one tooth; their `gear` and `tooth` are not read.
    face_width_m : float
        Face width; pits are clipped to it [m].
    height_m : (k,)
        Heights above the base circle [m].
    """
    height = np.atleast_1d(np.asarray(height_m, dtype=np.float64))
    return lengths_covered(height, pit_rows(pits), height, np.empty((0, COLUMNS)), face_width_m)


def section_loss(gear: SpurGear, pits: Iterable[ToothDamage], face_width_m: float, height_m: ArrayLike) -> SectionLoss:
    """Return what the pits of one tooth take from its sections at heights x (k,).

    Parameters
    ----------
    gear : SpurGear
    pits : iterable of ToothDamage
        Pits of one tooth; their `gear` and `tooth` are not read.
    face_width_m : float
        [m].
    height_m : (k,)
        Heights on the involute, above the base circle [m].

    Raises
    ------
    ValueError
        If a height is off the involute or nothing remains of a section.
    """
    height = np.atleast_1d(np.asarray(height_m, dtype=np.float64))
    thickness = np.atleast_1d(gear.half_thickness_m(gear.roll_at_height(height)))
    losses = _losses_at(height, thickness, pit_rows(pits), face_width_m)
    if not np.all(np.isfinite(losses)):
        raise ValueError(
            "pits consume a whole section of the tooth; allowed: depth below the local half tooth thickness"
        )
    losses.setflags(write=False)
    return SectionLoss(losses[0], losses[1], losses[2])


@entry(cache=True)
def _losses_at(height: FloatArray, thickness: FloatArray, pits: FloatArray, face_width: float) -> FloatArray:
    room = pits.shape[0]
    intervals, active = interval_room(room), np.empty(room, np.int64)
    stretches, moments = stretch_room(room), np.empty(3)
    out = np.zeros((3, height.size))
    for i in range(height.size):
        count = active_pits(height[i], pits, active)
        filled = add_intervals(height[i], pits, active, count, face_width, intervals, 0)
        depth_moments(height[i], pits, intervals, filled, stretches, moments)
        out[0, i] = covered_length(intervals, filled)
        out[1, i], out[2, i] = section_losses(thickness[i], face_width, moments)
    return out


def union_area_m2(gear: SpurGear, pits: Iterable[ToothDamage], face_width_m: float, measure: str = "arc") -> float:
    """Return the area of the union of the pits of one flank, clipped to face and rack-cut involute [m2].

    Parameters
    ----------
    gear : SpurGear
    pits : iterable of ToothDamage
        Pits of one tooth; their `gear` and `tooth` are not read.
    face_width_m : float
        [m].
    measure : str
        'arc': on the flank itself, an element of height dx = R_b psi cos(psi - alpha_2) dpsi counting as its arc R_b
        psi dpsi; 'axial': in the plane of face and height, where one ellipse has the area pi a b.
    """
    if measure not in ("arc", "axial"):
        raise ValueError(f"received measure {measure!r}; allowed: 'arc', 'axial'")
    rows = pit_rows(pits)
    kinks = involute.rolls_at_heights(section_kinks(rows, face_width_m), gear.base_radius_m, gear.base_half_angle_rad)
    area = flank_area(
        kinks,
        *gear.flank_rolls_rad,
        rows,
        gear.base_radius_m,
        gear.base_half_angle_rad,
        face_width_m,
        measure == "arc",
    )
    return float(area)


def largest_contact_length_loss(gear: SpurGear, pits: Iterable[ToothDamage], face_width_m: float) -> float:
    """Return the largest face length that the pits of one flank cover at any height of the involute [m].

    Derived: between kinks the covered length is a constant plus ends of merged intervals, straight or +a sqrt(1 -
    u^2), hence concave, and a golden section finds its maximum. At the end of a piece the limit from inside counts.
    """
    rows = pit_rows(pits)
    ends = flank_heights(gear)
    cuts = np.unique(np.clip(np.concatenate([section_kinks(rows, face_width_m), ends]), *ends))
    return float(_largest_covered(cuts, rows, face_width_m))


@njit(cache=True)
def _covered_at(
    x: float, pits: FloatArray, face_width: float, active: IntArray, count: int, intervals: Intervals
) -> float:
    return covered_length(intervals, add_intervals(x, pits, active, count, face_width, intervals, 0))


@entry(cache=True)
def _largest_covered(cuts: FloatArray, pits: FloatArray, face_width: float) -> float:
    room = pits.shape[0]
    intervals, active = interval_room(room), np.empty(room, np.int64)
    best = 0.0
    for k in range(cuts.size - 1):
        low, high = cuts[k], cuts[k + 1]
        middle = 0.5 * (low + high)
        count = active_pits(middle, pits, active)
        at_middle = _covered_at(middle, pits, face_width, active, count, intervals)
        active[:count] = intervals.owner[:count]
        at_low = _covered_at(low, pits, face_width, active, count, intervals)
        at_high = _covered_at(high, pits, face_width, active, count, intervals)
        best = max(best, at_low, at_middle, at_high)
        # Bound of a concave function from its ends and its middle: most pieces need no search.
        if 2.0 * at_middle - min(at_low, at_high) <= best:
            continue
        one, two = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        length_one = _covered_at(one, pits, face_width, active, count, intervals)
        length_two = _covered_at(two, pits, face_width, active, count, intervals)
        for _ in range(40):
            if length_one > length_two:
                high, two, length_two = two, one, length_one
                one = high - GOLDEN * (high - low)
                length_one = _covered_at(one, pits, face_width, active, count, intervals)
            else:
                low, one, length_one = one, two, length_two
                two = low + GOLDEN * (high - low)
                length_two = _covered_at(two, pits, face_width, active, count, intervals)
        best = max(best, length_one, length_two)
    return best
