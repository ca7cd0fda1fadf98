"""Material that a part takes from whole flanks, along the line of action: of all teeth of a gear alike, or of one.

It is missing from the contact of its teeth as relief is, and weakens no section: all pairs stay of their kind.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Protocol, TypeAlias, TypeGuard, TypeVar

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.damage.part import NO_TOOTH, Part
from siggen.gears.damage.tooth_damage import Damage, on_teeth
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.missing_material import CORNER_REACH_PITCHES, MissingMaterial, MissingTables
from siggen.names import Side


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
    """Return what back flanks miss (`siggen.gears.geometry.back_flanks`) where single teeth have lost it on both sides.

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
