"""What recordings showed on a channel, made anew: modulated noise, and lines of orders or frequencies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import LineTable, NoiseModulation
from siggen.dynamics.drive.comb import harmonic_sum, turns_of
from siggen.keys.number import at
from siggen.sensing.modulation import SHAFT_LINES, LevelCourse, shaft_course, shaft_phasors


@dataclass(frozen=True, slots=True)
class Draws:
    """Where the numbers of a channel come from.

    Attributes
    ----------
    specimen, shared : name -> uniform of the gearbox, or of the record
    record : name -> generator of this channel and record
    levels : name -> uniform of a level that belongs to the gearbox; None: levels are the record's
    """

    specimen: Callable[[str], float]
    shared: Callable[[str], float]
    record: Callable[[str], np.random.Generator]
    levels: Callable[[str], float] | None = None

    def level(self, name: str, rng: np.random.Generator) -> float:
        """Return the uniform of a level; the generator advances by one either way, so that its noise stays."""
        own = float(rng.random())
        return own if self.levels is None else self.levels(name)


class Turning(NamedTuple):
    """Turns of the gear per turn of the pinion, and how far this turns in a sample of the record at most [rad]."""

    gear_order: float
    largest_step_rad: float


class NoiseStrength:
    """M of mean 1, part after part; the phases of the shafts belong to the gearbox, what chance does to the record."""

    def __init__(self, section: NoiseModulation, draws: Draws, gear_order: float, fs_hz: float) -> None:
        rng = draws.record("noise_spectrum.modulation")
        numbers = {
            name: at(getattr(section, name), draws.level(f"noise_spectrum.modulation.{name}", rng))
            for name in ("pinion_depth", "gear_depth", "level_std", "level_time_ms")
        }
        self._phasors = []
        for shaft, order in (("pinion", 1.0), ("gear", gear_order)):
            uniforms = [draws.specimen(f"noise_spectrum.modulation.{shaft}.{k}") for k in range(SHAFT_LINES)]
            self._phasors.append((order, shaft_phasors(numbers[f"{shaft}_depth"], 2.0 * pi * np.array(uniforms))))
        self._level = LevelCourse(numbers["level_std"], 1e-3 * numbers["level_time_ms"] * fs_hz, rng)

    def take(self, angle_rad: FloatArray) -> FloatArray:
        """Return M (k,) at the next samples, whose pinion angles (k,) are given."""
        lines = [harmonic_sum(turns_of(angle_rad, order), phasors) for order, phasors in self._phasors]
        return np.asarray(shaft_course(lines) * self._level.take(angle_rad.size))


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
