"""A toy source, as somebody would add one: a drift of the amplifier, straight over the record, of either sign."""

from __future__ import annotations

from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from siggen.arrays import FloatArray
from siggen.keys.number import Number, Within, at
from siggen.noise.source import Draws, NoisePart, NoisyChannel, Source


class ToyDrift(Source):
    """What a user writes about it."""

    key: ClassVar[str] = "toy_drift"
    about: ClassVar[str] = "drift of the amplifier; "
    meaning: ClassVar[str] = "drift per second in"
    per: ClassVar[tuple[str, str]] = ("_per_s", "/s")

    size_m_s2_per_s: Annotated[Number, Within(least=0)] = Field(description="drawn per record and axis")

    def part(self, channel: NoisyChannel, draws: Draws) -> NoisePart:
        rng = draws.record(self.key)
        return _Slope(at(self.size_m_s2_per_s, draws.level("toy_drift.size_m_s2_per_s", rng)), channel.fs_hz)


class _Slope:
    def __init__(self, label: float, fs_hz: float) -> None:
        self.label, self._fs_hz = label, fs_hz

    def take(self, first: int, angle_rad: FloatArray) -> FloatArray:
        return self.label * (first + np.arange(angle_rad.size)) / self._fs_hz
