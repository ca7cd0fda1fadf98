"""SpeedRamp: speed that changes linearly over the record, with an acceleration that comes and goes smoothly (derived).

Over [0, D] the speed is f = A + a t with a = (B - A)/D. Before 0 and after D the acceleration blends in and out along
the cubic 3x² - 2x³, so that no jump of the acceleration shakes the train; outside of that the speed is constant. A
blend takes half a second, or less where the speed would otherwise change to below half or above one and a half times
A or B.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray

LONGEST_BLEND_S = 0.5


@dataclass(frozen=True, slots=True)
class SpeedRamp:
    """Speed from `start_hz` at time 0 to `end_hz` at `duration_s`; equal speeds are constant at all times."""

    start_hz: float
    end_hz: float
    duration_s: float

    def __post_init__(self) -> None:
        for name in ("start_hz", "end_hz", "duration_s"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0.0):
                raise ValueError(f"{name}: received {value}; allowed are finite values above 0")

    @property
    def slope_hz_s(self) -> float:
        """Acceleration over the record [Hz/s]."""
        return (self.end_hz - self.start_hz) / self.duration_s

    @property
    def slowest_hz(self) -> float:
        """Lowest speed at any time, before and after the record included."""
        before = self.start_hz - 0.5 * self.slope_hz_s * self._blend_s(self.start_hz)
        after = self.end_hz + 0.5 * self.slope_hz_s * self._blend_s(self.end_hz)
        return min(before, after, self.start_hz, self.end_hz)

    def turns(self, time_s: FloatArray) -> FloatArray:
        """Return the revolutions (k,) since time 0."""
        a, fade_in, fade_out = self.slope_hz_s, self._blend_s(self.start_hz), self._blend_s(self.end_hz)
        inside = np.clip(time_s, 0.0, self.duration_s)
        if a == 0.0:  # powers cost most, and nobody sees them
            early, late = np.minimum(time_s, 0.0), np.maximum(time_s - self.duration_s, 0.0)
            return self.start_hz * inside + self.start_hz * early + self.end_hz * late
        result = self.start_hz * inside + 0.5 * a * inside**2
        early, x = np.minimum(time_s, 0.0), self._early(time_s)
        before_hz = self.start_hz - 0.5 * a * fade_in
        result = result + before_hz * early + a * fade_in**2 * (x**4 / 4.0 - x**5 / 10.0 - 0.15)
        late, y = np.maximum(time_s - self.duration_s, 0.0), self._late(time_s)
        past = 0.5 * y**2 - y**4 / 4.0 + y**5 / 10.0 + 0.5 * (late / fade_out - y)
        return result + self.end_hz * late + a * fade_out**2 * past

    def speed_hz(self, time_s: FloatArray) -> FloatArray:
        """Return the speed (k,) [Hz]."""
        if self.slope_hz_s == 0.0:
            return np.full_like(time_s, self.start_hz)
        a, x, y = self.slope_hz_s, self._early(time_s), self._late(time_s)
        inside = self.start_hz + a * np.clip(time_s, 0.0, self.duration_s)
        fading_in = a * self._blend_s(self.start_hz) * (x**3 - 0.5 * x**4 - 0.5)
        return inside + fading_in + a * self._blend_s(self.end_hz) * (y - y**3 + 0.5 * y**4)

    def acceleration_hz_s(self, time_s: FloatArray) -> FloatArray:
        """Return the acceleration (k,) [Hz/s]."""
        if self.slope_hz_s == 0.0:
            return np.zeros_like(time_s)
        x, y = self._early(time_s), self._late(time_s)
        return self.slope_hz_s * (3.0 * x**2 - 2.0 * x**3) * (1.0 - 3.0 * y**2 + 2.0 * y**3)

    def _blend_s(self, speed_hz: float) -> float:
        slope = abs(self.slope_hz_s)
        return LONGEST_BLEND_S if slope * LONGEST_BLEND_S <= speed_hz else speed_hz / slope

    def _early(self, time_s: FloatArray) -> FloatArray:
        """Return how far the acceleration has blended in, 0 to 1."""
        return np.clip(1.0 + time_s / self._blend_s(self.start_hz), 0.0, 1.0)

    def _late(self, time_s: FloatArray) -> FloatArray:
        """Return how far the acceleration has blended out, 0 to 1."""
        return np.clip((time_s - self.duration_s) / self._blend_s(self.end_hz), 0.0, 1.0)
