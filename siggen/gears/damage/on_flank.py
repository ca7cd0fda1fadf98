"""What damage inside an outline on a flank answers: the common answers of pits, spalls and their like.

An outline has its centre on the rack-cut involute and on the face; what reaches beyond is clipped.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import Protocol

import numpy as np

from siggen.arrays import FloatArray
from siggen.errors import mm
from siggen.gears.damage.covering import holds
from siggen.gears.damage.heights import flank_heights, profile_arc_m
from siggen.gears.damage.outlines import Outline
from siggen.gears.damage.part import Part, Refusal
from siggen.gears.damage.sham import Sham
from siggen.gears.damage.tooth_damage import ToothDamage, acts_on_tooth
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.names import Side

FLOORS = ("flat", "dish")


class Outlined(Protocol):
    """What the answers below need to know."""

    @property
    def gear(self) -> Side: ...  # noqa: D102 - see ToothDamage

    @property
    def tooth(self) -> int: ...  # noqa: D102

    @property
    def kind(self) -> str: ...  # noqa: D102

    @property
    def outline(self) -> Outline: ...  # noqa: D102

    @property
    def depth_m(self) -> float: ...  # noqa: D102

    @property
    def floor(self) -> str: ...  # noqa: D102

    @property
    def floors(self) -> tuple[str, ...]: ...  # noqa: D102

    def rows(self) -> list[tuple[float, ...]]: ...  # noqa: D102


class OnFlank:
    """Answers of a damage with an `outline`, a `depth_m` and a `floor` that is one of its `floors`."""

    __slots__ = ()

    @property
    def floors(self) -> tuple[str, ...]:
        """Floors that the kind can have."""
        return FLOORS

    def rows(self: Outlined) -> list[tuple[float, ...]]:
        """Return the rows of the outline with its floor."""
        return self.outline.rows(self.depth_m, self.floor == "dish")

    def tooth_compliance_m_per_n(self, pair: GearPair, roll_rad: FloatArray, sound_m_per_n: FloatArray) -> float:  # noqa: ARG002
        """Return 0: all that it takes is in its rows."""
        return 0.0

    def profile_arc_m(self: Outlined, gear: SpurGear) -> float:
        """Return the arc that the outline spans, clipped to the flank [m]."""
        return profile_arc_m(gear, self.outline)

    def hides(self: Outlined, other: Part) -> bool:
        """Return whether `other` lies wholly inside on the same flank and nowhere deeper; False where it is unsure."""
        if (self.gear, self.tooth) != (other.gear, other.tooth) or not acts_on_tooth(other) or other.outline is None:
            return False
        return holds(self.rows(), other.rows())

    def sham(self: ToothDamage) -> Sham:
        """Return a sham in its place."""
        return Sham(self)

    def own_problems(self: Outlined) -> Iterator[Refusal]:
        """Yield an unknown floor, an impossible outline, a depth that is none."""
        found = list(floor_problems(self))
        yield from (refusal for refusal in found if refusal.name == "floor")
        yield from (Refusal(*problem) for problem in self.outline.problems())
        yield from (refusal for refusal in found if refusal.name != "floor")

    def place_problems(self: Outlined, pair: GearPair) -> Iterator[Refusal]:
        """Yield a tooth that there is not, a centre off the flank, a depth beyond the half tooth thickness.

        The depth must stay below it over the whole height (of a dish too: the rule is on the safe side there).
        """
        gear, outline = pair.member(self.gear), self.outline
        if not 0 <= self.tooth < gear.teeth:
            yield Refusal("tooth", f"tooth {self.tooth!r}", f"0 to {gear.teeth - 1}")
        if not 0.0 <= outline.face_m <= pair.face_width_m:
            allowed = f"centre on the face, 0 to {mm(pair.face_width_m)}"
            yield Refusal("face_m", f"face {mm(outline.face_m)}", allowed)
        foot, tip = flank_heights(gear)
        if not foot <= outline.height_m <= tip:
            allowed = f"centre on the involute flank, {1e3 * foot:.6g} to {mm(tip)} above the base circle"
            yield Refusal("height_m", f"height {mm(outline.height_m)}", allowed)
            return
        ends = np.clip(outline.height_range_m, foot, tip)
        # The thickness has a single maximum along the flank, so its least value over the outline is at an end.
        thickness = float(np.min(gear.half_thickness_m(gear.roll_at_height(ends))))
        if self.depth_m >= thickness:
            allowed = f"below the half tooth thickness there, {mm(thickness)}"
            yield Refusal("depth_m", f"depth {mm(self.depth_m)}", allowed)

    def table_row(self: Outlined) -> dict[str, object]:
        """Return place, size, outline and floor in mm."""
        outline = self.outline
        across, along = outline.semi_axes_m
        return {
            "gear": self.gear,
            "tooth": self.tooth,
            "kind": self.kind,
            "shape": outline.shape,
            "height_mm": 1e3 * outline.height_m,
            "face_mm": 1e3 * outline.face_m,
            "semi_axis_face_mm": 1e3 * across,
            "semi_axis_profile_mm": 1e3 * along,
            "depth_mm": 1e3 * self.depth_m,
            "depth_law": self.floor,
            "polygon_face_mm": [1e3 * face for _, face in outline.corners_m],
            "polygon_height_mm": [1e3 * height for height, _ in outline.corners_m],
        }


def floor_problems(damage: Outlined) -> Iterator[Refusal]:
    """Yield an unknown floor and a depth that is none."""
    if damage.floor not in damage.floors:
        yield Refusal("floor", f"floor {damage.floor!r}", ", ".join(damage.floors))
    if not (isfinite(damage.depth_m) and damage.depth_m > 0.0):
        yield Refusal("depth_m", f"depth {mm(damage.depth_m)}", "finite and above 0")
