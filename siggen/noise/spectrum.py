"""Noise of a given density, as it is stored; its strength may follow the turning shafts and chance."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field, model_validator

from siggen.arrays import FloatArray
from siggen.drivetrain.comb import harmonic_sum, turns_of
from siggen.errors import Problem
from siggen.keys.distributions import Uniform
from siggen.keys.number import Number, Within, at
from siggen.keys.problems import refusal
from siggen.keys.section import Real, Section
from siggen.names import Side
from siggen.noise.source import Draws, MeasuredPart, NoisePart, NoisyChannel, Source
from siggen.sensing.modulation import SHAFT_LINES, LevelCourse, shaft_course, shaft_phasors
from siggen.sensing.noise import ShapedNoise, shape_taps, tabulated
from siggen.sensing.responses import high_pass_response


class Density(Section):
    """A one-sided density over frequency, straight between its knots in log-log, constant beyond them.

    In a file `file: NAME.csv` stands for both lists: its columns are frequency_hz and density. Its numbers become part
    of the configuration when it is loaded, so that the set needs no file.
    """

    frequency_hz: Annotated[tuple[Real, ...], Field(min_length=2)] = Field(description="knots, ascending, above 0")
    density: Annotated[tuple[Real, ...], Field(min_length=2)] = Field(description="one above 0 for each knot")

    @model_validator(mode="after")
    def _knots(self) -> Density:
        if len(self.frequency_hz) != len(self.density):
            received = f"{len(self.frequency_hz)} frequencies, {len(self.density)} densities"
            raise refusal([Problem("density", received, "allowed: as many as frequencies")])
        rising = all(a < b for a, b in zip(self.frequency_hz, self.frequency_hz[1:], strict=False))
        if not rising or self.frequency_hz[0] <= 0.0:
            raise refusal([Problem("frequency_hz", str(list(self.frequency_hz)), "allowed: ascending, above 0")])
        if min(self.density) <= 0.0:
            raise refusal([Problem("density", f"{min(self.density):g}", "allowed: numbers above 0")])
        return self


SPECTRUM_TAPS = 16_384
"""Of the filter of a sensor's noise: at 25.6 kHz densities are smoothed over 1.6 Hz."""

LEVEL_TIME_MS = Uniform(low=1.0, high=8.0)
"""Correlation time of the random level (measured: the level changes within 10 ms)."""
DEPTHS = "of the power, once per turn of that shaft; 1/√2 and 1/√3 of it at 2x and 3x"


class NoiseModulation(Section):
    """Strength over time M = G exp(s U - s²/2) of noise: by the turning shafts, and by chance; of mean 1."""

    driver_depth: Annotated[Number, Within(least=0, most=1.5)] = Field(default=0.0, description=DEPTHS)
    driven_depth: Annotated[Number, Within(least=0, most=1.5)] = Field(default=0.0, description=DEPTHS)
    level_std: Annotated[Number, Within(least=0, most=2)] = Field(
        default=0.0, description="s of the random level; kurtosis of the noise 3 exp(s²)"
    )


class SensorDensity(Density, Source):
    """Noise of a sensor and its electronics in the channel's unit/√Hz, as of a data sheet or a measurement at rest."""

    key: ClassVar[str] = "noise_spectrum"
    about: ClassVar[str] = "further noise of any density; "
    meaning: ClassVar[str] = "RMS of the noise of given density in"
    broad: ClassVar[bool] = True
    file_columns: ClassVar[tuple[str, ...]] = ("frequency_hz", "density")

    factor: Annotated[Number, Within(least=0, most=1_000_000)] = Field(default=1.0, description="on the whole density")
    modulation: NoiseModulation | None = Field(default=None, description="null: none")

    @property
    def follows_angle(self) -> bool:
        """Whether its strength follows the shafts."""
        return self.modulation is not None

    def part(self, channel: NoisyChannel, draws: Draws) -> NoisePart:
        """Return its noise behind the coupling."""
        rng = draws.record(self.key)
        factor = at(self.factor, draws.level("noise_spectrum.factor", rng))
        noise = self._shaped(factor, channel, rng)
        if self.modulation is None:
            return MeasuredPart(lambda _, angle: noise(angle.size))
        strength = NoiseStrength(self.modulation, draws, channel.gear_order, channel.fs_hz)
        return MeasuredPart(lambda _, angle: noise(angle.size) * np.sqrt(strength.take(angle)))

    def _shaped(self, factor: float, channel: NoisyChannel, rng: np.random.Generator) -> Callable[[int], FloatArray]:
        def density(frequency_hz: FloatArray) -> FloatArray:
            found = tabulated(frequency_hz, self.frequency_hz, self.density)
            if channel.coupling_hz is None:
                return found
            # no logarithm of nothing: at frequency 0 as at the first one above
            over_zero = np.maximum(frequency_hz, frequency_hz[1])
            return np.asarray(found * np.abs(high_pass_response(over_zero, channel.coupling_hz)))

        taps = factor * shape_taps(density, SPECTRUM_TAPS, channel.fs_hz)
        return ShapedNoise(taps, channel.fs_hz, rng).take


class NoiseStrength:
    """M of mean 1, part after part; the phases of the shafts belong to the gearbox, what chance does to the record."""

    def __init__(self, section: NoiseModulation, draws: Draws, gear_order: float, fs_hz: float) -> None:
        rng = draws.record("noise_spectrum.modulation")
        numbers = {
            name: at(getattr(section, name), draws.level(f"noise_spectrum.modulation.{name}", rng))
            for name in ("driver_depth", "driven_depth", "level_std")
        }
        time_ms = at(LEVEL_TIME_MS, draws.level("noise_spectrum.modulation.level_time_ms", rng))
        self._phasors = []
        for shaft, depth, order in zip(Side, ("driver_depth", "driven_depth"), (1.0, gear_order), strict=True):
            uniforms = [draws.specimen(f"noise_spectrum.modulation.{shaft}.{k}") for k in range(SHAFT_LINES)]
            self._phasors.append((order, shaft_phasors(numbers[depth], 2.0 * pi * np.array(uniforms))))
        self._level = LevelCourse(numbers["level_std"], 1e-3 * time_ms * fs_hz, rng)

    def take(self, angle_rad: FloatArray) -> FloatArray:
        """Return M (k,) at the next samples, whose pinion angles (k,) are given."""
        lines = [harmonic_sum(turns_of(angle_rad, order), phasors) for order, phasors in self._phasors]
        return np.asarray(shaft_course(lines) * self._level.take(angle_rad.size))
