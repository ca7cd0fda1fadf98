"""Tones of other machines."""

from __future__ import annotations

from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from siggen.keys.number import Number, Within, at
from siggen.keys.section import Whole
from siggen.noise.lines import LinesPart
from siggen.noise.source import Draws, NoisyChannel, Part, Source
from siggen.sensing.tones import single_lines


class Tones(Source):
    """Tones of other machines, such as pumps and fans; every one has a frequency per gearbox."""

    key: ClassVar[str] = "tones"
    about: ClassVar[str] = ""
    meaning: ClassVar[str] = "RMS of the tones of other machines at"

    count: Annotated[Whole, Field(ge=1, le=40)] = Field(default=3, description="number of tones")
    frequency_hz: Annotated[Number, Within(above=0)] = Field(description="frequency, drawn per gearbox for every line")
    amplitude_m_s2: Annotated[Number, Within(least=0)] = Field(
        description="amplitude of a line, drawn per record and axis; with `background` per gearbox"
    )

    def part(self, channel: NoisyChannel, draws: Draws) -> Part:
        """Return its lines behind the sensor."""
        rng, count = draws.record(self.key), range(self.count)
        frequency_hz = [at(self.frequency_hz, draws.specimen(f"tones.{tone}.frequency_hz")) for tone in count]
        amplitude = [at(self.amplitude_m_s2, draws.level(f"tones.{tone}.amplitude_m_s2", rng)) for tone in count]
        return LinesPart(single_lines(np.array(frequency_hz), np.array(amplitude), rng), channel, sensed=True)
