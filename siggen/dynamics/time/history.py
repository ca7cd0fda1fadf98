"""History: the samples before the first one of a record or behind its last, for filters that remember (derived)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from siggen.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class History:
    """What came before sample 0: place/axis -> (h,), the last value one sample before it; empty in a failed response.

    Or what comes behind the last sample, the first value one sample behind it.

    The acceleration before the history is zero where it is shorter than was asked for: the motion began at rest.
    """

    acceleration_m_s2: Mapping[str, FloatArray]
    bearing_force_n: Mapping[str, FloatArray]
    shaft_reading: Mapping[str, FloatArray] = field(default_factory=dict)

    @property
    def parts(self) -> tuple[Mapping[str, FloatArray], ...]:
        """Accelerations, bearing forces and readings of shafts."""
        return self.acceleration_m_s2, self.bearing_force_n, self.shaft_reading
