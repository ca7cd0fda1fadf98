"""SampledExcitation: inputs on a grid as coarse as they allow, with cubic splines in between (derived).

Shaft forces, bearing tones and slow variations move far slower than a step of integration. The grid is doubled until
the spline, half an interval from its knots, errs by less than a millionth of the largest value of its input.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from siggen.arrays import FloatArray
from siggen.dynamics.drive.drive import Rotation
from siggen.dynamics.drive.excitation import Excitation

COARSEST_HZ = 2000.0
LARGEST_ERROR = 1e-6
CHECKED = 64
"""Midpoints, spread over the whole time, at which the error is measured."""
MARGIN = 4
"""Knots beyond either end, where a spline knows less."""


class SampledExcitation:
    """Inputs of an excitation from `first_s` to `last_s`; at `finest_hz` and above it asks the excitation itself."""

    def __init__(
        self, excitation: Excitation, drive: Rotation, first_s: float, last_s: float, finest_hz: float
    ) -> None:
        self._excitation = excitation
        self._spline: CubicSpline | None = None
        rate = COARSEST_HZ
        while rate < finest_hz:
            knots = first_s + np.arange(-MARGIN, np.ceil((last_s - first_s) * rate) + MARGIN + 1) / rate
            spline = CubicSpline(knots, excitation.inputs(knots, drive))
            chosen = np.linspace(MARGIN, knots.size - MARGIN - 2, CHECKED).astype(np.int64)
            middle = 0.5 * (knots[chosen] + knots[chosen + 1])
            wanted = excitation.inputs(middle, drive)
            if (np.abs(spline(middle) - wanted) <= LARGEST_ERROR * np.abs(wanted).max(axis=0)).all():
                self._spline = spline
                return
            del spline, knots  # large, before the next ones
            rate *= 2.0

    def inputs(self, time_s: FloatArray, drive: Rotation) -> FloatArray:
        """Return the inputs (k, m) at the times (k,) [s]."""
        if self._spline is None:
            return self._excitation.inputs(time_s, drive)
        return np.ascontiguousarray(self._spline(time_s))
