"""What an accelerometer does to a vibration and what its surroundings add, apart from white noise and the converter.

Numbers of the instrument are drawn per gearbox and axis, frequencies of other machines per gearbox, levels per record.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.keys.number import Number, Within
from siggen.keys.section import Section, Whole


class Resonance(Section):
    """A second-order low-pass with a peak: a mass on a spring."""

    frequency_hz: Annotated[Number, Within(above=0)] = Field(description="natural frequency")
    damping_ratio: Annotated[Number, Within(above=0, most=1)] = Field(
        default=0.05, description="the peak is 1 / (2 damping_ratio) high"
    )


class PinkNoise(Section):
    """Noise whose power falls as 1/f."""

    density_m_s2_per_sqrt_hz: Annotated[Number, Within(least=0)] = Field(
        description="one-sided density at 100 Hz, drawn per record and axis"
    )


class Mains(Section):
    """Hum of the power line at the mains frequency and its harmonics."""

    amplitude_m_s2: Annotated[Number, Within(least=0)] = Field(
        description="of the fundamental, drawn per record and axis; harmonic h has 1/h of it"
    )
    frequency_hz: Annotated[Number, Within(above=0)] = Field(default=50.0, description="drawn per gearbox")
    harmonics: Annotated[Whole, Field(ge=1, le=40)] = Field(default=3, description="highest harmonic")


class Tones(Section):
    """Tones of other machines, such as pumps and fans; every one has a frequency per gearbox."""

    count: Annotated[Whole, Field(ge=1, le=40)] = Field(default=3, description="number of tones")
    frequency_hz: Annotated[Number, Within(above=0)] = Field(description="drawn per gearbox and tone")
    amplitude_m_s2: Annotated[Number, Within(least=0)] = Field(description="drawn per record, axis and tone")


class Inverter(Section):
    """Carrier of a frequency inverter with sidebands in even multiples of the motor's electrical frequency."""

    carrier_hz: Annotated[Number, Within(above=0)] = Field(description="switching frequency, drawn per gearbox")
    modulation_hz: Annotated[Number, Within(above=0)] = Field(
        default=50.0, description="electrical frequency of the motor, drawn per record"
    )
    amplitude_m_s2: Annotated[Number, Within(least=0)] = Field(
        description="of the carrier, drawn per record and axis; the k-th sidebands have 1/(1 + k) of it"
    )
