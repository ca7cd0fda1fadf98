"""Lines of a frequency inverter."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from siggen.keys.distributions import Uniform
from siggen.keys.number import Number, Within, at
from siggen.noise.lines import LinesPart
from siggen.noise.source import Draws, NoisyChannel, Part, Source
from siggen.sensing.tones import carrier_lines

CARRIER_SIDEBANDS = 2
"""On either side of the carrier of an inverter (assumed)."""
MODULATION_HZ = Uniform(low=45.0, high=50.0)
"""Electrical frequency of the motor (assumed)."""


class Inverter(Source):
    """Carrier of a frequency inverter with sidebands in even multiples of the motor's electrical frequency."""

    key: ClassVar[str] = "inverter"
    about: ClassVar[str] = ""
    meaning: ClassVar[str] = "RMS of the inverter's lines at"

    carrier_hz: Annotated[Number, Within(above=0)] = Field(
        description="switching frequency, drawn per gearbox; its k-th sidebands have 1/(1 + k) of the amplitude"
    )
    amplitude_m_s2: Annotated[Number, Within(least=0)] = Field(
        description="amplitude of a line, drawn per record and axis; with `background` per gearbox"
    )

    def part(self, channel: NoisyChannel, draws: Draws) -> Part:
        """Return its lines behind the sensor."""
        rng = draws.record(self.key)
        amplitude = at(self.amplitude_m_s2, draws.level("inverter.amplitude_m_s2", rng))
        carrier_hz = at(self.carrier_hz, draws.specimen("inverter.carrier_hz"))
        # the electrical frequency belongs to the record: all sensors see the same motor
        modulation_hz = at(MODULATION_HZ, draws.shared("inverter.modulation_hz"))
        lines = carrier_lines(carrier_hz, modulation_hz, amplitude, CARRIER_SIDEBANDS, rng)
        return LinesPart(lines, channel, sensed=True)
