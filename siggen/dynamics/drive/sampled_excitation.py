"""SampledExcitation: inputs on a grid as coarse as they allow, with cubic splines in between (derived).

Shaft forces, bearing tones and slow variations move far slower than a step of integration. The grid is doubled until
the spline, half an interval from its knots, errs by less than a millionth of the largest value of its input.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.drive.drive import Rotation
from siggen.dynamics.drive.excitation import Excitation
from siggen.uniform_spline import UniformSpline

COARSEST_HZ = 2000.0
LARGEST_ERROR = 1e-6
CHECKED = 64
"""Midpoints, spread over the whole time, at which the error is measured."""
MARGIN = 4
"""Knots beyond either end, where a spline knows less; even, so that a finer grid begins on a knot of the coarser."""


class SampledExcitation:
    """Inputs of an excitation from `first_s` to `last_s`; at `finest_hz` and above it asks the excitation itself.

    So it does where a source is sharp: between the knots of a coarse grid a pulse could pass unseen.

    With `window_s` a spline covers that much from the first time asked for, and the next one follows when it is passed:
    memory does not grow with the duration.
    """

    def __init__(
        self,
        excitation: Excitation,
        drive: Rotation,
        first_s: float,
        last_s: float,
        finest_hz: float,
        window_s: float | None = None,
    ) -> None:
        self._excitation, self._drive = excitation, drive
        self._last_s, self._finest_hz, self._window_s = last_s, finest_hz, window_s
        self._rate_hz, self._until_s = COARSEST_HZ, -np.inf
        self._spline: UniformSpline | None = None
        if window_s is None:
            self._cover(first_s, last_s)

    def inputs(self, time_s: FloatArray, drive: Rotation) -> FloatArray:
        """Return the inputs (k, m) at the times (k,) [s], which ascend, from one call to the next too."""
        if self._window_s is not None and time_s[-1] > self._until_s:
            self._cover(time_s[0], min(max(time_s[0] + self._window_s, time_s[-1]), self._last_s))
        if self._spline is None:
            return self._excitation.inputs(time_s, drive)
        return self._spline(time_s)

    def seat_force_rows(self, places: Sequence[str]) -> FloatArray:
        """Return the forces (places, m) on seats per unit of the inputs, as `Excitation`."""
        return self._excitation.seat_force_rows(places)

    def _cover(self, first_s: float, last_s: float) -> None:
        """Make the spline of a span, no coarser than the one before; none if its grid were finer than the steps."""
        self._spline, self._until_s = None, last_s
        coarser: FloatArray | None = None
        while self._rate_hz < self._finest_hz and self._excitation.sharp_turn_rad == 0.0:
            knots = _knots(first_s, last_s, self._rate_hz)
            values = self._values(knots, coarser)
            spline = UniformSpline(knots[0], 1.0 / self._rate_hz, values)
            if self._is_close(spline, knots):
                self._spline = spline
                return
            self._rate_hz *= 2.0
            coarser = values

    def _values(self, knots: FloatArray, coarser: FloatArray | None) -> FloatArray:
        """Return the inputs (k, m) at knots, every other one of which may be known from a grid of half the rate."""
        if coarser is None:
            return self._excitation.inputs(knots, self._drive)
        fresh = self._excitation.inputs(knots[1::2], self._drive)
        values = np.empty((knots.size, fresh.shape[1]))
        values[1::2] = fresh
        values[::2] = coarser[MARGIN // 2 :][: values[::2].shape[0]]
        return values

    def _is_close(self, spline: UniformSpline, knots: FloatArray) -> bool:
        """Return whether the spline errs little half an interval from knots."""
        chosen = np.linspace(MARGIN, knots.size - MARGIN - 2, CHECKED).astype(np.int64)
        middle = 0.5 * (knots[chosen] + knots[chosen + 1])
        wanted = self._excitation.inputs(middle, self._drive)
        return bool((np.abs(spline(middle) - wanted) <= LARGEST_ERROR * np.abs(wanted).max(axis=0)).all())


def _knots(first_s: float, last_s: float, rate_hz: float) -> FloatArray:
    """Return the knots of a grid; those with even numbers are knots at half the rate, to the last bit."""
    numbers = np.arange(-MARGIN, np.ceil((last_s - first_s) * rate_hz) + MARGIN + 1)
    return np.asarray(first_s + numbers / rate_hz)
