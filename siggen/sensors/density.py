"""A density of noise over frequency, as a table of knots or as the file that holds one."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from siggen.errors import Problem
from siggen.keys.number import Number, Within
from siggen.keys.problems import refusal
from siggen.keys.section import Real, Section

MOST_LINES = 400


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


class NoiseModulation(Section):
    """Strength over time M = G exp(s U - s²/2) of noise: by the turning shafts, and by chance; of mean 1."""

    pinion_depth: Annotated[Number, Within(least=0, most=1.5)] = Field(
        default=0.0, description="of the power, once per turn of the pinion; 1/√2 and 1/√3 of it twice and three times"
    )
    gear_depth: Annotated[Number, Within(least=0, most=1.5)] = Field(default=0.0, description="the same of the gear")
    level_std: Annotated[Number, Within(least=0, most=2)] = Field(
        default=0.0, description="s of the random level; kurtosis of the noise 3 exp(s²)"
    )
    level_time_ms: Annotated[Number, Within(least=0.1, most=1000)] = Field(
        default=3.0, description="correlation time of the level"
    )


class SensorDensity(Density):
    """Noise of a sensor and its electronics in m/s²/√Hz, such as its data sheet or a measurement at rest gives."""

    factor: Annotated[Number, Within(least=0, most=1_000_000)] = Field(
        default=1.0, description="on the whole density, drawn per record and axis; with `background` per gearbox"
    )
    modulation: NoiseModulation | None = Field(default=None, description="null: none")


class LineTable(Section):
    """Lines that a sensor shows besides: a cos(2π frequency t + order x angle of the pinion), random phases.

    In a file `file: NAME.csv` stands for the lists: its columns are order, frequency_hz and amplitude_m_s2. Its numbers
    become part of the configuration when it is loaded.
    """

    order: Annotated[tuple[Real, ...], Field(min_length=1)] = Field(description="turns per pinion turn; 0 for a tone")
    frequency_hz: Annotated[tuple[Real, ...], Field(min_length=1)] = Field(description="of a tone; 0 for an order")
    amplitude_m_s2: Annotated[tuple[Real, ...], Field(min_length=1)] = Field(description="one for each")
    factor: Annotated[Number, Within(least=0, most=1_000)] = Field(
        default=1.0, description="on each line, drawn per record, axis and line"
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
