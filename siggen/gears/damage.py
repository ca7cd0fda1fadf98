"""A damaged flank as a tuple of pits, each an ellipse on the flank with a flat or dished floor.

Source: paper A (Influence of Tooth Pitting on TVMS and Vibration Response of a Spur Gear Pair), sections 2.1 and 3.1:
elliptic cylinders with the semi-axis a along the face and b along the height; the damaged region is their union.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import gcd, isfinite, sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from siggen.gears import involute
from siggen.gears.geometry import GearPair
from siggen.gears.kinks import section_kinks
from siggen.gears.spur_gear import SpurGear
from siggen.gears.union import lengths_covered

FloatArray = NDArray[np.float64]

FLOORS = ("flat", "dish")
READINGS = ("axial", "radial", "arc")
WHOLE_FACE = 1e-12
"""Remaining share of the face width below which a contact counts as lost: rounding of the union's ends."""


@dataclass(frozen=True, slots=True)
class Pit:
    """One pit (or spall) of elliptical outline.

    Parameters
    ----------
    gear : str
        'pinion' or 'gear'.
    tooth : int
        Tooth index, from 0.
    height_m : float
        Centre's height x above the base circle, along the tooth centre line [m].
    face_m : float
        Centre's coordinate across the face, 0 to the face width [m].
    semi_axis_face_m, semi_axis_profile_m : float
        Semi-axes across the face and along the height [m].
    depth_m : float
        Depth normal to the tooth's centre plane [m]; of a dish at its centre.
    floor : str
        'flat' or 'dish' (half ellipsoid).
    """

    gear: str
    tooth: int
    height_m: float
    face_m: float
    semi_axis_face_m: float
    semi_axis_profile_m: float
    depth_m: float
    floor: str = "flat"


Damage: TypeAlias = tuple[Pit, ...]


@dataclass(frozen=True, slots=True)
class DamageProblem:
    """One reason why a damage cannot be: the pit's index in the damage, what came, what is allowed."""

    index: int
    received: str
    allowed: str

    def __str__(self) -> str:
        """One line: pit, what was received, what is allowed."""
        return f"pit {self.index}: received {self.received}; allowed: {self.allowed}"


def pits_of(damage: Iterable[Pit], which: str, tooth: int) -> Damage:
    """Return the pits on one tooth of 'pinion' or 'gear'."""
    return tuple(pit for pit in damage if pit.gear == which and pit.tooth == tooth)


def damaged_teeth(damage: Iterable[Pit], which: str) -> tuple[int, ...]:
    """Return the damaged teeth of 'pinion' or 'gear', ascending."""
    return tuple(sorted({pit.tooth for pit in damage if pit.gear == which}))


def pit_rows(pits: Iterable[Pit]) -> FloatArray:
    """Return the pits of one flank as rows (n, 6).

    Columns: height, face coordinate, semi-axes across face and along height, depth [m], dish (0 or 1). Sorted and
    without duplicates: a union depends on neither order nor repetition, and neither does any bit of what follows.

    Raises
    ------
    ValueError
        If a pit is not finite, has no extent or an unknown floor.
    """
    pits = tuple(pits)
    for index, pit in enumerate(pits):
        for problem in _own_problems(index, pit):
            raise ValueError(str(problem))
    rows = [
        (
            pit.height_m,
            pit.face_m,
            pit.semi_axis_face_m,
            pit.semi_axis_profile_m,
            pit.depth_m,
            float(pit.floor == "dish"),
        )
        for pit in pits
    ]
    return np.unique(np.array(rows, dtype=np.float64).reshape(-1, 6), axis=0)


def axial_height(gear: SpurGear, value_m: float, reading: str) -> float:
    """Return the height x along the tooth centre line of a flank point that was measured another way [m].

    Parameters
    ----------
    gear : SpurGear
    value_m : float
        Distance of the point from the base circle [m].
    reading : str
        'axial' (already x), 'radial' (R - R_b) or 'arc' (along the involute, R_b psi^2/2).

    Raises
    ------
    ValueError
        If the value is negative or not finite, or the reading unknown.
    """
    if not (isfinite(value_m) and value_m >= 0.0):
        raise ValueError(f"received height {value_m!r} m above the base circle; allowed: finite and at least 0")
    if reading == "axial":
        return float(value_m)
    ratio = value_m / gear.base_radius_m
    if reading == "radial":
        return float(gear.height_m(sqrt(ratio * (ratio + 2.0))))
    if reading == "arc":
        return float(gear.height_m(sqrt(2.0 * ratio)))
    raise ValueError(f"received height reading {reading!r}; allowed: {', '.join(READINGS)}")


def damage_problems(pair: GearPair, damage: Iterable[Pit]) -> tuple[DamageProblem, ...]:
    """Return everything that makes a damage impossible on a pair without geometry problems; empty for a possible one.

    A pit's centre must lie on the rack-cut involute and on the face; what reaches beyond is clipped. Its depth must
    stay below the half tooth thickness over its whole height (of a dish too: the rule is on the safe side there). No
    contact may lose its whole length, neither by one flank nor by two mating ones together; that is looked for only
    when every pit is possible by itself.
    """
    damage = tuple(damage)
    problems: list[DamageProblem] = []
    for index, pit in enumerate(damage):
        own = tuple(_own_problems(index, pit))
        problems.extend(own or _place_problems(pair, index, pit))
    return tuple(problems or _contact_problems(pair, damage))


def _own_problems(index: int, pit: Pit) -> Iterator[DamageProblem]:
    if pit.floor not in FLOORS:
        yield DamageProblem(index, f"floor {pit.floor!r}", ", ".join(FLOORS))
    for name in ("height_m", "face_m"):
        if not isfinite(getattr(pit, name)):
            yield DamageProblem(index, f"{name} {getattr(pit, name)!r}", "finite")
    for name in ("semi_axis_face_m", "semi_axis_profile_m", "depth_m"):
        value = getattr(pit, name)
        if not (isfinite(value) and value > 0.0):
            yield DamageProblem(index, f"{name} {value!r} m", "finite and above 0")


def _place_problems(pair: GearPair, index: int, pit: Pit) -> Iterator[DamageProblem]:
    if pit.gear not in ("pinion", "gear"):
        yield DamageProblem(index, f"gear {pit.gear!r}", "'pinion', 'gear'")
        return
    gear = pair.member(pit.gear)
    if not 0 <= pit.tooth < gear.teeth:
        yield DamageProblem(index, f"tooth {pit.tooth!r}", f"0 to {gear.teeth - 1}")
    if not 0.0 <= pit.face_m <= pair.face_width_m:
        yield DamageProblem(index, f"face_m {pit.face_m:.6g} m", f"centre on the face, 0 to {pair.face_width_m:.6g} m")
    foot, tip = flank_heights(gear)
    if not foot <= pit.height_m <= tip:
        allowed = f"centre on the involute flank, {foot:.6g} to {tip:.6g} m above the base circle"
        yield DamageProblem(index, f"height_m {pit.height_m:.6g} m", allowed)
        return
    ends = np.clip([pit.height_m - pit.semi_axis_profile_m, pit.height_m + pit.semi_axis_profile_m], foot, tip)
    # The thickness has a single maximum along the flank, so its least value over the pit is at an end.
    thickness = float(np.min(gear.half_thickness_m(gear.roll_at_height(ends))))
    if pit.depth_m >= thickness:
        allowed = f"below the half tooth thickness there, {thickness:.6g} m"
        yield DamageProblem(index, f"depth_m {pit.depth_m:.6g} m", allowed)


def flank_heights(gear: SpurGear) -> tuple[float, float]:
    """Return the heights x of the start of the rack-cut involute and of the tip [m]."""
    return float(gear.height_m(gear.involute_start_roll_rad)), float(gear.height_m(gear.tip_roll_rad))


def _contact_problems(pair: GearPair, damage: Damage) -> Iterator[DamageProblem]:
    rows = {
        (which, tooth): pit_rows(pits_of(damage, which, tooth))
        for which in ("pinion", "gear")
        for tooth in damaged_teeth(damage, which)
    }
    none = np.empty((0, 6))
    whole: set[tuple[str, int]] = set()
    for (which, tooth), own in rows.items():
        first, second = (own, none) if which == "pinion" else (none, own)
        if _largest_middle_loss(pair, first, second) >= pair.face_width_m * (1.0 - WHOLE_FACE):
            whole.add((which, tooth))
            yield _whole_face(pair, damage, which, tooth, "")
    shared = gcd(pair.pinion.teeth, pair.gear.teeth)
    for i in damaged_teeth(damage, "pinion"):
        for j in damaged_teeth(damage, "gear"):
            if (i - j) % shared or ("pinion", i) in whole or ("gear", j) in whole:
                continue
            loss = _largest_middle_loss(pair, rows["pinion", i], rows["gear", j])
            if loss >= pair.face_width_m * (1.0 - WHOLE_FACE):
                yield _whole_face(pair, damage, "pinion", i, f" together with gear tooth {j}")


def _whole_face(pair: GearPair, damage: Damage, which: str, tooth: int, mate: str) -> DamageProblem:
    index = next(i for i, pit in enumerate(damage) if pit.gear == which and pit.tooth == tooth)
    received = f"pits of {which} tooth {tooth}{mate} that take the whole contact length"
    return DamageProblem(index, received, f"a loss below the face width {pair.face_width_m:.6g} m everywhere")


def _largest_middle_loss(pair: GearPair, pinion_rows: FloatArray, gear_rows: FloatArray) -> float:
    """Return the largest loss half-way between kinks of the path of contact [m].

    Enough to find a whole loss: where the union closes or opens, two outlines cross, so a closed stretch reaches from
    kink to kink.
    """
    pinion, gear, width = pair.pinion, pair.gear, pair.face_width_m
    length = pair.line_of_action_m
    marks = []
    if pinion_rows.size:
        rolls = involute.rolls_at_heights(
            section_kinks(pinion_rows, width), pinion.base_radius_m, pinion.base_half_angle_rad
        )
        marks.append(rolls * pinion.base_radius_m)
    if gear_rows.size:
        rolls = involute.rolls_at_heights(section_kinks(gear_rows, width), gear.base_radius_m, gear.base_half_angle_rad)
        marks.append(length - rolls * gear.base_radius_m)
    ends = [pair.contact_start_m, pair.contact_end_m]
    cuts = np.unique(np.clip(np.concatenate([*marks, np.array(ends)]), ends[0], ends[1]))
    middle = 0.5 * (cuts[1:] + cuts[:-1])
    pinion_height = pinion.height_m(middle / pinion.base_radius_m)
    gear_height = gear.height_m((length - middle) / gear.base_radius_m)
    return float(np.max(lengths_covered(pinion_height, pinion_rows, gear_height, gear_rows, width)))
