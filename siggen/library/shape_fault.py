"""Damage of a user's own kind as a section of a state: it is passed in, and no file names it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from siggen.arrays import FloatArray
from siggen.damage.fault import Fault, HitTeeth
from siggen.damage.growth import Growth
from siggen.damage.lost_shape import LostShape
from siggen.damage.part import Parts
from siggen.errors import Problem, UsageError
from siggen.gears.gear_pair import Gear, GearPair
from siggen.library.damage import Damage
from siggen.names import Side


class ShapeFault(Fault):
    """A depth of any shape on one flank."""

    words: ClassVar[tuple[str, ...]] = ("damage",)
    needs_pairs: ClassVar[bool] = True

    kind: Literal["shape"] = "shape"
    gear: str = Field(description="damaged gear")
    number: int = Field(description="place in its state")
    damage: Any = Field(exclude=True, description="what the user passed in")

    def drawn(self, growth: Growth) -> Parts:
        """Return the shape on its tooth."""
        return (self._on(growth.pair),)

    def _on(self, pair: GearPair) -> LostShape:
        return shape_of(self.damage, pair.driver if self.side == Side.DRIVER else pair.driven, self.side)

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong with its depths."""
        for name, received, allowed in self._on(pair).place_problems(pair):
            yield Problem(name, received, f"allowed: {allowed}")

    def hit_teeth(self) -> HitTeeth:
        """Yield its tooth."""
        yield "tooth", self.gear, (self.damage.tooth,)


def shape_of(damage: Damage, gear: Gear, side: Side) -> LostShape:
    """Return a damage of a user's own kind on a gear of a pair, as contacts know it."""
    shape: Callable[..., Any] = partial(_missing_m, damage, gear)
    return LostShape(side, damage.tooth, shape, type(damage).__name__.lower())


def _missing_m(damage: Damage, gear: Gear, profile_m: FloatArray, face_m: FloatArray) -> FloatArray:
    """Return the depths that a damage of a user's own kind gives, one for each point.

    Raises
    ------
    UsageError
        If it gives something else.
    """
    found = damage.missing_m(gear, profile_m, face_m)
    depths = np.asarray(found) if isinstance(found, (np.ndarray, list, tuple)) else np.full(0, np.nan)
    if depths.dtype.kind not in "fiu" or depths.shape != profile_m.shape:
        form = f"an array {depths.shape} of {depths.dtype}" if isinstance(found, np.ndarray) else f"{found!r:.60}"
        allowed = f"an array {profile_m.shape} of numbers [m], a depth for each point"
        raise UsageError(f"missing_m: received {form}; allowed: {allowed}")
    return depths.astype(np.float64)
