"""Lines of given orders or frequencies, as they are stored."""

from __future__ import annotations

from math import pi
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field, model_validator

from siggen.arrays import FloatArray
from siggen.errors import Problem
from siggen.keys.number import Number, Within, at
from siggen.keys.problems import refusal
from siggen.keys.section import Real
from siggen.keys.usual import Usual
from siggen.noise.source import Draws, MeasuredPart, NoisePart, NoisyChannel, Source

MOST_LINES = 400


class LineTable(Source):
    """Lines that a sensor shows besides: a cos(2π frequency t + order x angle of the pinion), random phases.

    In a file `file: NAME.csv` stands for the lists: its columns are order, frequency_hz and amplitude_m_s2. Its numbers
    become part of the configuration when it is loaded.
    """

    key: ClassVar[str] = "lines"
    about: ClassVar[str] = "lines of given orders or frequencies; "
    meaning: ClassVar[str] = "RMS of the lines of given orders or frequencies in"
    fitted: ClassVar[bool] = True
    file_columns: ClassVar[tuple[str, ...]] = ("order", "frequency_hz", "amplitude_m_s2")
    asks_largest_step: ClassVar[bool] = True

    order: Annotated[tuple[Real, ...], Field(min_length=1)] = Field(description="turns per pinion turn; 0 for a tone")
    frequency_hz: Annotated[tuple[Real, ...], Field(min_length=1)] = Field(description="of a tone; 0 for an order")
    amplitude_m_s2: Annotated[tuple[Real, ...], Field(min_length=1)] = Field(description="one for each")
    factor: Annotated[Number, Within(least=0, most=1_000), Usual(0.02, 50)] = Field(
        default=1.0, description="on each line"
    )

    @model_validator(mode="after")
    def _as_many(self) -> LineTable:
        counts = (len(self.order), len(self.frequency_hz), len(self.amplitude_m_s2))
        if len(set(counts)) > 1 or counts[0] > MOST_LINES:
            received = f"{counts[0]} orders, {counts[1]} frequencies, {counts[2]} amplitudes"
            raise refusal([Problem("order", received, f"allowed: as many of each, at most {MOST_LINES}")])
        if min(*self.order, *self.frequency_hz, *self.amplitude_m_s2) < 0.0:
            raise refusal([Problem("order", "a negative number", "allowed: numbers from 0")])
        return self

    @property
    def follows_angle(self) -> bool:
        """Whether angles count: those of its orders do."""
        return True

    def part(self, channel: NoisyChannel, draws: Draws) -> NoisePart:
        """Return its lines."""
        lines = TableLines(self, draws, channel.fs_hz, channel.largest_step_rad)
        return MeasuredPart(lambda first, angle: lines.at(angle, first))


class TableLines:
    """The sum of all lines, part after part; those from half the sampling rate on are left out.

    `largest_step_rad` is the largest turn of the pinion in a sample of the record.
    """

    def __init__(self, section: LineTable, draws: Draws, fs_hz: float, largest_step_rad: float) -> None:
        rng, self._fs_hz = draws.record("lines"), fs_hz
        self._lines = []
        for order, hz, amplitude in zip(section.order, section.frequency_hz, section.amplitude_m_s2, strict=True):
            phase = 2.0 * pi * rng.random()
            size = amplitude * at(section.factor, rng.random())
            if 2.0 * pi * hz + order * largest_step_rad * fs_hz < pi * fs_hz:
                self._lines.append((order, hz, size, phase))

    def at(self, angle_rad: FloatArray, first: int) -> FloatArray:
        """Return the sum (k,) from sample `first` on, where the pinion's angles (k,) are given."""
        time_s = (np.arange(angle_rad.size) + first) / self._fs_hz
        total = np.zeros(angle_rad.size)
        for order, hz, size, phase in self._lines:
            total += size * np.cos(2.0 * pi * hz * time_s + order * angle_rad + phase)
        return total
