"""A tooth that has lost its tip over a part of the face only, by a step or by a corner that is broken off.

Derived. In the plane of height and face the tip is gone inside a polygon; a corner is cut by a plane, whose trace is
straight there. What is gone is gone through the tooth, so its outline is damage without a floor: slices inside end at
a lower tip and find an edge there, the others carry (`siggen.gears.contact.face_gaps`). Where gears tilt the moment of
the load that moves across the face turns them.

Material above a contact carries no load, so the tooth is as stiff as before under a contact below the line. What
stands beside a chip is taken to be as stiff as a whole tooth too. Where a part of the tooth is gone down to its root
what stands is a tooth of its width: its compliance is that of the whole over the share that stands.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import isfinite

import numpy as np

from siggen.arrays import FloatArray
from siggen.errors import mm
from siggen.gears.damage.covering import holds
from siggen.gears.damage.flank_damage import pit_rows
from siggen.gears.damage.heights import flank_heights
from siggen.gears.damage.outlines import Outline, Polygon
from siggen.gears.damage.part import Part, Refusal
from siggen.gears.damage.row_columns import COLUMNS, THROUGH_M
from siggen.gears.damage.sham import Sham
from siggen.gears.damage.tooth_damage import ToothDamage, acts_on_tooth, goes_through
from siggen.gears.damage.union import lengths_covered
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.names import Side

BEYOND_TIP_MODULES = 0.1
"""How far above the tip outlines reach: there is no land behind a chip."""


@dataclass(frozen=True, slots=True)
class PartChip:
    """A tooth without a part of its tip.

    Parameters
    ----------
    gear : Side
        Its gear.
    tooth : int
        Tooth index, from 0.
    height_m : float
        What is lost from the tip down, along the radius, at the end of the face where it begins [m].
    width_m : float
        Over which width of the face from that end, face coordinate 0 [m].
    outline : Polygon
        What is gone, in the plane of height and face (`lost_outline`).
    whole_height, whole_face : bool
        Whether the tooth is gone down to its root there, and whether that is all of the face.
    """

    gear: Side
    tooth: int
    height_m: float
    width_m: float
    outline: Polygon
    whole_height: bool = False
    whole_face: bool = False

    @property
    def kind(self) -> str:
        """Kind of damage."""
        return "broken_tooth" if self.whole_height else "chip"

    @property
    def depth_m(self) -> float:
        """Depth that stands for a tooth that is gone through and through [m]."""
        return THROUGH_M

    def rows(self) -> list[tuple[float, ...]]:
        """Return the rows of what is gone."""
        return self.outline.rows(THROUGH_M, dish=False)

    def tooth_compliance_m_per_n(self, pair: GearPair, roll_rad: FloatArray, sound_m_per_n: FloatArray) -> FloatArray:  # noqa: ARG002
        """Return what is added to the compliance of its tooth, sound (k,), under an even load on what stands [m/N]."""
        left = standing_share(pair, self.gear, (self,))
        return sound_m_per_n * ((1.0 - left) / left if left > 0.0 else 0.0)

    def profile_arc_m(self, gear: SpurGear) -> float:  # noqa: ARG002
        """Return 0: no flank sinks into it."""
        return 0.0

    def lost_from_m(self, gear: SpurGear) -> float:
        """Return the radius above which it is gone [m]."""
        return max(gear.tip_radius_m - self.height_m, gear.root_radius_m)

    def lost_width_m(self, gear: SpurGear, radius_m: FloatArray, face_width_m: float) -> FloatArray:  # noqa: ARG002
        """Return over which width it is gone at radii (k,) above its line [m]."""
        return np.full(radius_m.shape, self.width_m)

    def hides(self, other: Part) -> bool:
        """Return whether `other` lies wholly on what is gone of the same tooth; False where it is unsure."""
        if (other.gear, other.tooth) != (self.gear, self.tooth) or not acts_on_tooth(other) or other.outline is None:
            return False
        return holds([*self.rows(), *self._gone_around(other.outline).rows(THROUGH_M, dish=False)], other.rows())

    def _gone_around(self, outline: Outline) -> Polygon:
        """Return what is gone, with all beyond the tip and the ends of the face that an outline reaches: no metal."""
        line = self.outline.corners_m[0][0]
        (_, high), (left, right) = outline.height_range_m, outline.face_range_m
        top, first = max(high, self.outline.height_range_m[1]), min(left, 0.0) - self.width_m
        last = max(right, 0.0) + self.width_m if self.whole_face else self.width_m
        return Polygon(((line, first), (line, last), (top, last), (top, first)), "rectangle")

    def sham(self) -> Sham:
        """Return a sham in its place."""
        return Sham(self)

    def own_problems(self) -> Iterator[Refusal]:
        """Yield a height or a width that is none."""
        for name in ("height_m", "width_m"):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0.0):
                yield Refusal(name, f"{name.removesuffix('_m')} {mm(value)}", "finite and above 0")

    def place_problems(self, pair: GearPair) -> Iterator[Refusal]:
        """Yield a tooth that there is not, a height beyond the tooth, a width beyond the face."""
        gear = pair.member(self.gear)
        if not 0 <= self.tooth < gear.teeth:
            yield Refusal("tooth", f"tooth {self.tooth!r}", f"0 to {gear.teeth - 1}")
        most = gear.tip_radius_m - gear.root_radius_m
        if self.height_m > most:
            yield Refusal("height_m", f"height {mm(self.height_m)}", f"up to {mm(most)}, the height of the tooth")
        if self.width_m > pair.face_width_m:
            allowed = f"up to {mm(pair.face_width_m)}, the face width"
            yield Refusal("width_m", f"width {mm(self.width_m)}", allowed)

    def table_row(self) -> dict[str, object]:
        """Return outline, height and width of what is gone in mm."""
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
            "depth_law": "none",
            "polygon_face_mm": [1e3 * face for _, face in outline.corners_m],
            "polygon_height_mm": [1e3 * height for height, _ in outline.corners_m],
            "chip_height_mm": 0.0 if self.whole_height else 1e3 * self.height_m,
            "chip_width_mm": 1e3 * self.width_m,
        }


def lost_outline(gear: SpurGear, height_m: float, width_m: float) -> Polygon:
    """Return what is gone of a tip, from face coordinate 0 on.

    Parameters
    ----------
    gear : SpurGear
    height_m : float
        From the tip down, along the radius [m].
    width_m : float
        Across the face [m].
    """
    tip, line = float(gear.height_m(gear.tip_roll_rad)), line_height_m(gear, height_m)
    above = tip + BEYOND_TIP_MODULES * gear.module_m
    return Polygon(((line, 0.0), (line, width_m), (above, width_m), (above, 0.0)), "rectangle")


def standing_share(pair: GearPair, side: Side, damage: Iterable[ToothDamage]) -> float:
    """Return the share of the face over which a tooth still stands on its root, beside what is gone through it."""
    rows = pit_rows(one for one in damage if goes_through(one))
    start = np.array([flank_heights(pair.member(side))[0]])
    gone = lengths_covered(start, rows, start, np.empty((0, COLUMNS)), pair.face_width_m)
    return 1.0 - float(gone[0]) / pair.face_width_m


def line_height_m(gear: SpurGear, height_m: float) -> float:
    """Return the height above the base circle, along the tooth's axis, of the line down to which a tip is lost [m].

    Below the base circle, where no flank is, along the radius.
    """
    above_base = gear.tip_radius_m - height_m - gear.base_radius_m
    return (
        above_base if above_base <= 0.0 else float(gear.height_m(gear.roll_at_radius(above_base + gear.base_radius_m)))
    )
