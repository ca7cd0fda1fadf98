"""Material that a part takes from whole flanks, along the line of action: of all teeth of a gear alike, or of one.

It is missing from the contact of its teeth as relief is, and weakens no section: all pairs stay of their kind.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Protocol, TypeGuard

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.damage.part import NO_TOOTH, Part
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.missing_material import MissingMaterial, ToothTables


class FlankLoss(Part, Protocol):
    """A part that takes material from the drive flanks over the whole face; `tooth` -1 for all teeth of its gear."""

    def missing_m(self, pair: GearPair, position_m: FloatArray) -> FloatArray:
        """Return what it takes at positions s (k,) of a pair, outside of the path of contact too, (k,) [m]."""


Losses = tuple[FlankLoss, ...]


def from_flanks(parts: Iterable[Part]) -> Losses:
    """Return the parts that take material from whole flanks."""
    return tuple(one for one in parts if takes_from_flanks(one))


def takes_from_flanks(part: Part) -> TypeGuard[FlankLoss]:
    """Whether a part takes material from whole flanks; any other acts elsewhere."""
    return hasattr(part, "missing_m")


def with_losses(missing: MissingMaterial, pair: GearPair, losses: Losses) -> MissingMaterial:
    """Return the missing material of the same teeth without what `losses` take; the same object without any.

    Several that take from the same flank leave what the one leaves that takes most: the order has no effect.
    """
    if not losses:
        return missing
    position = np.linspace(missing.start_m, missing.end_m, missing.pinion.profile_m.shape[1])
    return replace(
        missing,
        pinion=_without(missing.pinion, pair, position, [one for one in losses if one.gear == "pinion"]),
        gear=_without(missing.gear, pair, position, [one for one in losses if one.gear == "gear"]),
    )


def _without(teeth: ToothTables, pair: GearPair, position_m: FloatArray, losses: list[FlankLoss]) -> ToothTables:
    profile = teeth.profile_m
    for one in losses:
        if one.tooth != NO_TOOTH:
            raise ValueError(f"tooth: received {one.tooth}; allowed: {NO_TOOTH}, all teeth")
    if losses:
        profile = profile + np.max([one.missing_m(pair, position_m) for one in losses], axis=0)
    return replace(teeth, profile_m=profile)
