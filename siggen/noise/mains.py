"""Hum of the power line."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from siggen.keys.number import Number, Within, at
from siggen.keys.usual import Usual
from siggen.noise.lines import LinesPart
from siggen.noise.source import Draws, NoisePart, NoisyChannel, Source
from siggen.sensing.tones import harmonic_lines

HARMONICS = 5
"""Harmonic h has 1/h of the amplitude."""


class Mains(Source):
    """Hum of the power line at the mains frequency and its harmonics, as it is stored."""

    key: ClassVar[str] = "mains"
    about: ClassVar[str] = ""
    meaning: ClassVar[str] = "RMS of mains hum in"

    amplitude_m_s2: Annotated[Number, Within(least=0), Usual(1e-05, 0.5)] = Field(
        description="amplitude of the first line"
    )
    frequency_hz: Annotated[Number, Within(above=0), Usual(15, 450)] = Field(
        default=50.0, description="drawn per gearbox for every line"
    )

    def part(self, channel: NoisyChannel, draws: Draws) -> NoisePart:
        """Return its lines."""
        rng = draws.record(self.key)
        amplitude = at(self.amplitude_m_s2, draws.level("mains.amplitude_m_s2", rng))
        fundamental_hz = at(self.frequency_hz, draws.specimen("mains.frequency_hz"))
        return LinesPart(harmonic_lines(fundamental_hz, amplitude, HARMONICS, rng), channel)
