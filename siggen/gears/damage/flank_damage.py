"""A damaged flank as a tuple of pits and spalls, each an outline on the flank with a flat or dished floor.

Source: paper A (Influence of Tooth Pitting on TVMS and Vibration Response of a Spur Gear Pair), sections 2.1 and 3.1:
elliptic cylinders with the semi-axis a along the face and b along the height; the damaged region is their union.
Spalls: derived.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import gcd, isfinite, sqrt
from typing import TypeAlias

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.damage.covering import hidden_rows, hides
from siggen.gears.damage.outlines import Ellipse, Outline
from siggen.gears.damage.row_columns import COLUMNS
from siggen.gears.damage.whole_loss import takes_whole_contact
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear

FLOORS = ("flat", "dish")
SPALL_FLOORS = (*FLOORS, "length_squared")
READINGS = ("axial", "radial", "arc")


@dataclass(frozen=True, slots=True)
class Pit:
    """One pit of elliptical outline.

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

    @property
    def kind(self) -> str:
        """Kind of damage."""
        return "pit"

    @property
    def outline(self) -> Ellipse:
        """The pit's ellipse."""
        return Ellipse(self.height_m, self.face_m, self.semi_axis_face_m, self.semi_axis_profile_m)


@dataclass(frozen=True, slots=True)
class Spall:
    """One spall of any outline.

    Parameters
    ----------
    gear : str
        'pinion' or 'gear'.
    tooth : int
        Tooth index, from 0.
    outline : Ellipse or Polygon
        On the flank's plane of height and face.
    depth_m : float
        Depth normal to the tooth's centre plane [m]; of a dish at its deepest.
    floor : str
        'flat'; 'dish': an ellipse's is half an ellipsoid, a polygon's is half an elliptic cylinder with its axis
        across the face, depth sqrt(1 - u^2) with u = -1 and 1 at the polygon's lowest and highest point: like the
        flank that rolls over it, such a floor is curved along the profile and straight across the face;
        'length_squared': flat, its depth set by `length_squared_depth_m`.
    """

    gear: str
    tooth: int
    outline: Outline
    depth_m: float
    floor: str = "flat"

    @property
    def kind(self) -> str:
        """Kind of damage."""
        return "spall"


Damage: TypeAlias = tuple[Pit | Spall, ...]


@dataclass(frozen=True, slots=True)
class DamageProblem:
    """One reason why a damage cannot be: which pit or spall of the damage, what came, what is allowed.

    `name` is the attribute to blame, or 'contact' for a contact length that is wholly lost.
    """

    index: int
    received: str
    allowed: str
    kind: str = "pit"
    name: str = ""

    def __str__(self) -> str:
        """One line: pit or spall, what was received, what is allowed."""
        return f"{self.kind} {self.index}: received {self.received}; allowed: {self.allowed}"


def pits_of(damage: Iterable[Pit | Spall], which: str, tooth: int) -> Damage:
    """Return the pits and spalls on one tooth of 'pinion' or 'gear'."""
    return tuple(pit for pit in damage if pit.gear == which and pit.tooth == tooth)


def damaged_teeth(damage: Iterable[Pit | Spall], which: str) -> tuple[int, ...]:
    """Return the damaged teeth of 'pinion' or 'gear', ascending."""
    return tuple(sorted({pit.tooth for pit in damage if pit.gear == which}))


def pit_rows(pits: Iterable[Pit | Spall]) -> FloatArray:
    """Return the pits and spalls of one flank as rows (n, 13).

    Columns: `siggen.gears.damage.row_columns`. Sorted, without duplicates and without what a deeper one hides: a
    union depends on none of these, and neither does any bit of what follows.

    Raises
    ------
    ValueError
        If one is not finite, has no extent, an unknown floor or edges that cross.
    """
    pits = tuple(pits)
    for index, pit in enumerate(pits):
        for problem in _own_problems(index, pit):
            raise ValueError(str(problem))
    found = [row for pit in pits for row in pit.outline.rows(pit.depth_m, pit.floor == "dish")]
    rows = np.unique(np.array(found, dtype=np.float64).reshape(-1, COLUMNS), axis=0)
    return rows[~hidden_rows(rows)] if len(rows) > 1 else rows


def hides_damage(one: Pit | Spall, two: Pit | Spall) -> bool:
    """Return whether `two` lies wholly inside `one` on the same flank and nowhere deeper; False where it is unsure."""
    if (one.gear, one.tooth) != (two.gear, two.tooth):
        return False
    own, other = (np.array(p.outline.rows(p.depth_m, p.floor == "dish")) for p in (one, two))
    return all(any(hides(larger, row) for larger in own) for row in other)


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


def length_squared_depth_m(gear: SpurGear, outline: Outline, depth_per_square_length_per_m: float) -> float:
    """Return the depth c l^2 of a spall whose arc along the involute, clipped to the flank, is l [m].

    Measured spalls of growing length follow c = 16.3 um/mm^2 = 16.3 1/m.
    """
    return depth_per_square_length_per_m * profile_arc_m(gear, outline) ** 2


def profile_arc_m(gear: SpurGear, outline: Outline) -> float:
    """Return the arc along the involute that an outline spans, clipped to the flank [m]."""
    low, high = gear.roll_at_height(np.clip(outline.height_range_m, *flank_heights(gear)))
    return float(0.5 * gear.base_radius_m * (high - low) * (high + low))


def damage_problems(pair: GearPair, damage: Iterable[Pit | Spall]) -> tuple[DamageProblem, ...]:
    """Return everything that makes a damage impossible on a pair without geometry problems; empty for a possible one.

    A centre (of a polygon: the middle of its ranges) must lie on the rack-cut involute and on the face; what reaches
    beyond is clipped. The depth must stay below the half tooth thickness over the whole height (of a dish too: the
    rule is on the safe side there). No contact may lose its whole length, neither by one flank nor by two mating ones
    together; that is looked for only when every pit and spall is possible by itself.
    """
    damage = tuple(damage)
    problems: list[DamageProblem] = []
    for index, pit in enumerate(damage):
        own = tuple(_own_problems(index, pit))
        problems.extend(own or _place_problems(pair, index, pit))
    return tuple(problems or _contact_problems(pair, damage))


def _own_problems(index: int, pit: Pit | Spall) -> Iterator[DamageProblem]:
    floors = FLOORS if pit.kind == "pit" else SPALL_FLOORS
    if pit.floor not in floors:
        yield DamageProblem(index, f"floor {pit.floor!r}", ", ".join(floors), pit.kind, "floor")
    for name, received, allowed in pit.outline.problems():
        yield DamageProblem(index, received, allowed, pit.kind, name)
    if not (isfinite(pit.depth_m) and pit.depth_m > 0.0):
        yield DamageProblem(index, f"depth_m {pit.depth_m!r} m", "finite and above 0", pit.kind, "depth_m")


def _place_problems(pair: GearPair, index: int, pit: Pit | Spall) -> Iterator[DamageProblem]:
    if pit.gear not in ("pinion", "gear"):
        yield DamageProblem(index, f"gear {pit.gear!r}", "'pinion', 'gear'", pit.kind, "gear")
        return
    gear, outline = pair.member(pit.gear), pit.outline
    if not 0 <= pit.tooth < gear.teeth:
        yield DamageProblem(index, f"tooth {pit.tooth!r}", f"0 to {gear.teeth - 1}", pit.kind, "tooth")
    if not 0.0 <= outline.face_m <= pair.face_width_m:
        allowed = f"centre on the face, 0 to {pair.face_width_m:.6g} m"
        yield DamageProblem(index, f"face_m {outline.face_m:.6g} m", allowed, pit.kind, "face_m")
    foot, tip = flank_heights(gear)
    if not foot <= outline.height_m <= tip:
        allowed = f"centre on the involute flank, {foot:.6g} to {tip:.6g} m above the base circle"
        yield DamageProblem(index, f"height_m {outline.height_m:.6g} m", allowed, pit.kind, "height_m")
        return
    ends = np.clip(outline.height_range_m, foot, tip)
    # The thickness has a single maximum along the flank, so its least value over the pit is at an end.
    thickness = float(np.min(gear.half_thickness_m(gear.roll_at_height(ends))))
    if pit.depth_m >= thickness:
        allowed = f"below the half tooth thickness there, {thickness:.6g} m"
        yield DamageProblem(index, f"depth_m {pit.depth_m:.6g} m", allowed, pit.kind, "depth_m")


def flank_heights(gear: SpurGear) -> tuple[float, float]:
    """Return the heights x of the start of the rack-cut involute and of the tip [m]."""
    return float(gear.height_m(gear.involute_start_roll_rad)), float(gear.height_m(gear.tip_roll_rad))


def _contact_problems(pair: GearPair, damage: Damage) -> Iterator[DamageProblem]:
    for which, tooth, mate in lost_contacts(pair, damage):
        index, pit = next((i, pit) for i, pit in enumerate(damage) if pit.gear == which and pit.tooth == tooth)
        together = "" if mate is None else f" together with gear tooth {mate}"
        received = (
            f"{_kinds(damage, which, tooth)} of {which} tooth {tooth}{together} that take the whole contact length"
        )
        allowed = f"a loss below the face width {pair.face_width_m:.6g} m everywhere"
        yield DamageProblem(index, received, allowed, pit.kind, "contact")


def _kinds(damage: Damage, which: str, tooth: int) -> str:
    kinds = sorted({pit.kind for pit in pits_of(damage, which, tooth)})
    return " and ".join(f"{kind}s" for kind in kinds)


def lost_contacts(pair: GearPair, damage: Damage) -> Iterator[tuple[str, int, int | None]]:
    """Yield (gear, tooth, None) of flanks without contact length somewhere on the path of contact.

    Then ('pinion', tooth, gear tooth) of meeting flanks that only together leave none.
    """
    rows = {
        (which, tooth): pit_rows(pits_of(damage, which, tooth))
        for which in ("pinion", "gear")
        for tooth in damaged_teeth(damage, which)
    }
    none = np.empty((0, COLUMNS))
    whole: set[tuple[str, int]] = set()
    for (which, tooth), own in rows.items():
        first, second = (own, none) if which == "pinion" else (none, own)
        if takes_whole_contact(pair, first, second):
            whole.add((which, tooth))
            yield which, tooth, None
    shared = gcd(pair.pinion.teeth, pair.gear.teeth)
    for i in damaged_teeth(damage, "pinion"):
        for j in damaged_teeth(damage, "gear"):
            if (i - j) % shared or ("pinion", i) in whole or ("gear", j) in whole:
                continue
            if takes_whole_contact(pair, rows["pinion", i], rows["gear", j]):
                yield "pinion", i, j
