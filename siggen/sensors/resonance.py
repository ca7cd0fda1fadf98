"""A resonance of a sensor or of its mounting."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.keys.number import Number, Within
from siggen.keys.section import Section


class Resonance(Section):
    """A second-order low-pass with a peak: a mass on a spring."""

    frequency_hz: Annotated[Number, Within(above=0)] = Field(description="natural frequency")
    damping_ratio: Annotated[Number, Within(above=0, most=1)] = Field(
        default=0.05, description="the peak is 1 / (2 damping_ratio) high"
    )
