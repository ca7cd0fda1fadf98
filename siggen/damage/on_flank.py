"""What damage inside an outline on a flank answers: the common answers of pits, spalls and their like.

An outline has its centre on the rack-cut involute and on the face; what reaches beyond is clipped.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from math import isfinite
from typing import Protocol, TypeAlias, TypeGuard, TypeVar

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.covering import holds
from siggen.damage.heights import flank_heights, profile_arc_m
from siggen.damage.outlines import Outline
from siggen.damage.part import NO_TOOTH, Damage, Part, Refusal, ToothDamage, acts_on_tooth, on_teeth
from siggen.damage.sham import Sham
from siggen.errors import mm
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import CORNER_REACH_PITCHES, MissingMaterial, MissingTables
from siggen.gears.spur_gear import SpurGear
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


# Material that a part takes from whole flanks, along the line of action: of all teeth of a gear alike, or of one.
#
# It is missing from the contact of its teeth as relief is, and weakens no section: all pairs stay of their kind.


class FlankLoss(Part, Protocol):
    """A part that takes material from drive flanks over the whole face; `tooth` -1 for all teeth of its gear.

    Attributes
    ----------
    whole_tooth : bool
        Whether nothing of its tooth is left, the back flank neither.
    """

    @property
    def whole_tooth(self) -> bool: ...  # noqa: D102 - see the class

    def missing_m(self, pair: GearPair, position_m: FloatArray) -> FloatArray:
        """Return what it takes at positions s (k,) of a pair, outside of the path of contact too, (k,) [m]."""

    def reach_pitches(self, pair: GearPair) -> float:
        """Return how far beside the path of contact corners may carry [base pitches]."""

    def outlined(self, pair: GearPair) -> Damage:
        """Return what shows on flanks inside an outline, as labels count it: areas, lengths, stiffness."""


Losses: TypeAlias = tuple[FlankLoss, ...]
SomePart = TypeVar("SomePart", bound=Part)


def from_flanks(parts: Iterable[Part]) -> Losses:
    """Return the parts that take material from whole flanks."""
    return tuple(one for one in parts if takes_from_flanks(one))


def with_outlines(parts: Iterable[Part], pair: GearPair) -> Damage:
    """Return the parts on single teeth as labels count them, with what takes single whole flanks inside outlines."""
    parts = tuple(parts)
    return (*on_teeth(parts), *(shown for one in from_flanks(parts) for shown in one.outlined(pair)))


def takes_from_flanks(part: Part) -> TypeGuard[FlankLoss]:
    """Whether a part takes material from whole flanks; any other acts elsewhere."""
    return hasattr(part, "missing_m")


def reach_pitches(pair: GearPair, losses: Losses) -> float:
    """Return how far beside the path of contact the corners of such teeth are followed [base pitches]."""
    return max([CORNER_REACH_PITCHES, *(one.reach_pitches(pair) for one in losses)])


def with_losses(missing: MissingMaterial, pair: GearPair, losses: Losses) -> MissingMaterial:
    """Return the missing material of the same teeth without what `losses` take; the same object without any.

    Of several that take from all teeth that counts which takes most, and of those of one tooth too: the order has no
    effect. What one tooth misses comes to what all miss.
    """
    if not losses:
        return missing
    position = np.linspace(missing.start_m, missing.end_m, missing.pinion.profile_m.shape[1])
    return replace(
        missing,
        pinion=_without(missing.pinion, pair, position, [one for one in losses if one.gear == Side.DRIVER]),
        gear=_without(missing.gear, pair, position, [one for one in losses if one.gear == Side.DRIVEN]),
    )


def on_back_flanks(missing: MissingMaterial, pair: GearPair, losses: Losses) -> MissingMaterial:
    """Return what back flanks miss (`siggen.gears.back_flanks`) where single teeth have lost it on both sides.

    `losses` are those of the drive flanks, `pair` is the one with the gear in front.
    """
    own = [turned(one, pair) for one in losses if one.tooth != NO_TOOTH]
    if not own:
        return missing
    position = np.linspace(missing.start_m, missing.end_m, missing.pinion.profile_m.shape[1])
    # Tables keep the gear that they belong to, parts have the role that it plays.
    return replace(
        missing,
        pinion=_without(missing.pinion, pair, position, [one for one in own if one.gear == Side.DRIVEN]),
        gear=_without(missing.gear, pair, position, [one for one in own if one.gear == Side.DRIVER]),
    )


def turned(part: SomePart, pair: GearPair) -> SomePart:
    """Return what is gone through a tooth as the pair with the gear in front has it, which is `pair`.

    The gear's tooth behind the one that a pair is numbered by is that whose back flank is in contact.
    """
    if part.gear == Side.DRIVER:
        return replace(part, gear=Side.DRIVEN)  # type: ignore[type-var]
    return replace(part, gear=Side.DRIVER, tooth=(part.tooth - 1) % pair.pinion.teeth)  # type: ignore[type-var]


def _without(teeth: MissingTables, pair: GearPair, position_m: FloatArray, losses: list[FlankLoss]) -> MissingTables:
    everywhere = _most(pair, position_m, [one for one in losses if one.tooth == NO_TOOTH])
    profiles, kind, offset = [*(teeth.profile_m + everywhere)], teeth.kind_of_tooth.copy(), teeth.offset_m.copy()
    for tooth in sorted({one.tooth for one in losses} - {NO_TOOTH}):
        own = [one for one in losses if one.tooth == tooth]
        profile = profiles[kind[tooth]] + _most(pair, position_m, own)
        if any(one.whole_tooth for one in own):
            # Out of reach on either side: its place is behind all others', and its flank as far in front of that.
            offset[tooth] -= pair.base_pitch_m
            profile = profile + 2.0 * pair.base_pitch_m
        kind[tooth] = len(profiles)
        profiles.append(profile)
    return MissingTables(np.stack(profiles), kind, offset)


def _most(pair: GearPair, position_m: FloatArray, losses: list[FlankLoss]) -> FloatArray:
    """Return the most that any of them takes at positions (k,) [m]; 0 without any."""
    most = np.zeros(position_m.size)
    for one in losses:
        most = np.maximum(most, one.missing_m(pair, position_m))
    return most
