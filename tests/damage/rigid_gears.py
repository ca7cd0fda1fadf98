"""By how much a rigid gear lags behind a rigid pinion until teeth touch, from their outlines alone.

Shares no code with the package: points of the pinion's flanks, their corners among them, and the corners of the gear's
teeth, turned about the centres and compared in polar coordinates about the other one.
"""

from __future__ import annotations

from math import cos, pi, sqrt, tan

import numpy as np
from scipy.optimize import brentq

POINTS = 4001
FARTHEST_RAD = 0.02


def involute_angle(radius, base):
    """Polar angle of an involute counted from its start on the base circle."""
    along = np.sqrt(np.maximum((radius / base) ** 2 - 1.0, 0.0))
    return along - np.arctan(along)


class RigidGears:
    """A pair without errors; teeth are numbered so that number n of either meets, and meets at its tips at angle n."""

    def __init__(self, pair):
        pinion, gear = pair.pinion, pair.gear
        angle = pinion.pressure_angle_rad
        self.base = [0.5 * g.module_m * g.teeth * cos(angle) for g in (pinion, gear)]
        self.tip = [0.5 * g.module_m * g.teeth + g.module_m * g.addendum_coefficient for g in (pinion, gear)]
        self.teeth = pinion.teeth, gear.teeth
        self.distance = sum(self.base) / cos(angle)
        self.angle = angle
        self.pitch = 2 * pi * self.base[0] / pinion.teeth
        self.line = sum(self.base) * tan(angle)
        self.start = self.line - sqrt(self.tip[1] ** 2 - self.base[1] ** 2)

    def lag_m(self, pitches, tips_m, gone=()):
        """Way along the line of action (k,) until the first pair touches; tips of the pinion's teeth by number."""
        least = np.full(pitches.size, np.inf)
        for number in range(-3, 4):
            if number in gone:
                continue
            tip = tips_m.get(number, self.tip[0])
            least = np.minimum(least, [self._pair_lag(p - number, tip) for p in pitches])
        return least

    def _pair_lag(self, place, tip):
        """Lag of one pair: pinion's flank points against the gear's involute, the gear's corner against the pinion's.

        The pinion turns against the clock about the origin, the gear's centre lies on the x axis. The line of action
        leaves the pinion's base circle at minus the pressure angle; a flank that meets at s winds off its base circle
        at s/R_b from there.
        """
        s = self.start + place * self.pitch
        base_1, base_2 = self.base
        first = -self.angle + s / base_1
        second = pi - self.angle + (self.line - s) / base_2
        radius = np.linspace(base_1, tip, POINTS)
        points = radius * np.exp(1j * (first - involute_angle(radius, base_1))) - self.distance
        lag = behind(points, second, base_2, self.tip[1])

        def gap(turn):
            about = self.tip[1] * np.exp(1j * (second + turn - involute_angle(self.tip[1], base_2)))
            return behind(np.array([self.distance + about]), first, base_1, tip)

        if not (np.isfinite(gap(0.0)) and np.isfinite(gap(FARTHEST_RAD)) and gap(FARTHEST_RAD) < 0.0):
            return lag
        return min(lag, brentq(gap, 0.0, FARTHEST_RAD) * base_2 if gap(0.0) > 0.0 else 0.0)


def behind(points, start, base, tip):
    """Least way along the line of action by which points lie behind an involute about the origin."""
    radius = np.abs(points)
    inside = (radius <= tip * (1 + 1e-12)) & (radius >= base)
    if not inside.any():
        return np.inf
    flank = start - involute_angle(radius[inside], base)
    return float(np.min(np.angle(points[inside] * np.exp(-1j * flank)))) * base
