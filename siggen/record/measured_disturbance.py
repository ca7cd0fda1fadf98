"""What recordings showed on a channel, made anew: modulated noise, and lines of orders or frequencies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import LineTable, NoiseModulation, at
from siggen.dynamics.drive.comb import harmonic_sum, turns_of
from siggen.sensing.modulation import SHAFT_LINES, level_course, shaft_course, shaft_phasors


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


@dataclass(frozen=True, slots=True)
class Turning:
    """Angle of the pinion at the samples of a record (n,) [rad], and turns of the gear per turn of the pinion."""

    angle_rad: FloatArray
    gear_order: float


def noise_strength(section: NoiseModulation, draws: Draws, turning: Turning, fs_hz: float) -> FloatArray:
    """Return M (n,) of mean 1; the phases of the shafts belong to the gearbox, what chance does to the record."""
    rng = draws.record("noise_spectrum.modulation")
    numbers = {
        name: at(getattr(section, name), draws.level(f"noise_spectrum.modulation.{name}", rng))
        for name in ("pinion_depth", "gear_depth", "level_std", "level_time_ms")
    }
    lines = []
    for shaft, order in (("pinion", 1.0), ("gear", turning.gear_order)):
        uniforms = [draws.specimen(f"noise_spectrum.modulation.{shaft}.{k}") for k in range(SHAFT_LINES)]
        phasors = shaft_phasors(numbers[f"{shaft}_depth"], 2.0 * pi * np.array(uniforms))
        lines.append(harmonic_sum(turns_of(turning.angle_rad, order), phasors))
    memory = 1e-3 * numbers["level_time_ms"] * fs_hz
    level = level_course(turning.angle_rad.size, numbers["level_std"], memory, rng)
    return np.asarray(shaft_course(lines) * level)


def table_lines(section: LineTable, draws: Draws, turning: Turning, fs_hz: float) -> FloatArray:
    """Return the sum of all lines (n,); those from half the sampling rate on are left out."""
    rng = draws.record("lines")
    time_s = np.arange(turning.angle_rad.size) / fs_hz
    top_rad_s = pi * fs_hz
    angle, total = turning.angle_rad, np.zeros(turning.angle_rad.size)
    for order, hz, amplitude in zip(section.order, section.frequency_hz, section.amplitude_m_s2, strict=True):
        phase = 2.0 * pi * rng.random()
        size = amplitude * at(section.factor, rng.random())
        fastest = 2.0 * pi * hz + order * float(np.diff(angle).max()) * fs_hz
        if fastest < top_rad_s:
            total += size * np.cos(2.0 * pi * hz * time_s + order * angle + phase)
    return total
