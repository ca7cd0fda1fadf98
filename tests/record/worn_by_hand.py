"""Wear of a pair of spring-like teeth, and its transmission error at rest, slowly and by hand.

Shares no code with the package: adaptive quadrature of the base-circle beam, contact after Yang and Sun or Weber and
Banaschek written out, Archard's law by small steps of equal turns, halving for every position of rest.
"""

from __future__ import annotations

from math import cos, pi, sqrt, tan

import numpy as np
from scipy.interpolate import CubicSpline

from tests.gears.stiffness.slow_quadrature import Outline, alpha_form


class SlowPair:
    """A pair on a grid of places per base pitch from s_A on, relief as a parabola before both tips."""

    def __init__(self, pair, relief_m, relief_length_m, per_pitch):
        self.per_pitch = per_pitch
        pinion, gear = pair.pinion, pair.gear
        angle = pinion.pressure_angle_rad
        base = [0.5 * g.module_m * g.teeth * cos(angle) for g in (pinion, gear)]
        tips = [0.5 * g.module_m * g.teeth + g.addendum_coefficient * g.module_m for g in (pinion, gear)]
        line = sum(base) * tan(angle)
        first, last = line - sqrt(tips[1] ** 2 - base[1] ** 2), sqrt(tips[0] ** 2 - base[0] ** 2)
        self.pitch, self.line, self.width = 2 * pi * base[0] / pinion.teeth, line, pair.face_width_m
        count = int((last - first) / self.pitch * per_pitch) + 1
        self.s = first + self.pitch / per_pitch * np.arange(count)
        self.modulus, self.nu = pair.youngs_modulus_pa / (1 - pair.poisson_ratio**2), pair.poisson_ratio
        self.teeth = self._teeth(pair, (pinion, gear), base)
        self.depth = self._depths((pinion, gear), base)
        self.radius = self.s * (line - self.s) / line
        reached = [np.clip(1 - to_tip / relief_length_m, 0, None) for to_tip in (last - self.s, self.s - first)]
        self.relief = relief_m * (reached[0] ** 2 + reached[1] ** 2)
        # By one turn of the driver, for a unit load.
        v_1, v_2 = self.s / base[0], (line - self.s) / base[1]
        slide = np.abs(v_1 - v_2) / self.width
        self.factors = slide / v_1, slide / v_2 * base[0] / base[1]

    def _teeth(self, pair, gears, base):
        some = np.linspace(self.s[0], self.s[-1], 41)
        total = np.zeros(some.size)
        for gear, radius, way in zip(gears, base, (some, self.line - some), strict=True):
            total += [alpha_form(pair, gear, place / radius).sum() for place in way]
        return CubicSpline(some, total)(self.s)

    def _depths(self, gears, base):
        """Product of the distances to both centre lines along the line of action."""
        product = np.ones(self.s.size)
        for gear, radius, way in zip(gears, base, (self.s, self.line - self.s), strict=True):
            outline = Outline(gear)
            rolls = way / radius
            product *= [outline.h(roll) / cos(roll - outline.half) for roll in rolls]
        return product

    def rest(self, force, worn, law):
        """Approach (n,) over one pitch of the newest pair, and the load (k,) along the path."""
        missing = self.relief + worn
        low, high = np.zeros(self.per_pitch), np.full(self.per_pitch, 1e-3)
        newest = np.arange(self.s.size) % self.per_pitch
        for _ in range(50):
            middle = 0.5 * (low + high)
            load = self._loads(middle[newest] - missing, law)
            less = np.bincount(newest, load) < force
            low, high = np.where(less, middle, low), np.where(less, high, middle)
        approach = 0.5 * (low + high)
        return approach, self._loads(approach[newest] - missing, law)

    def _loads(self, penetration, law):
        plain = 4 / (pi * self.modulus * self.width)
        deep = np.maximum(penetration, 0.0)
        found = deep / (self.teeth + plain)
        for _ in range(0 if law == "linear" else 8):
            half = np.sqrt(8 * np.maximum(found, 1e-9) * self.radius / (pi * self.modulus * self.width))
            bracket = np.log(2 * np.sqrt(self.depth) / half) - self.nu / (2 * (1 - self.nu))
            found = deep / (self.teeth + plain * bracket)
        return found

    def worn(self, force, largest_m, steps):
        """Depths of both gears when the deeper one has a largest depth, by steps of equal growth."""
        depths = [np.zeros(self.s.size), np.zeros(self.s.size)]
        for number in range(steps):
            _, load = self.rest(force, depths[0] + depths[1], "linear")
            wanted = largest_m * (number + 1) / steps
            rates = [factor * load for factor in self.factors]
            grows = [rate > 0 for rate in rates]
            turns = min(
                np.min((wanted - d[g]) / r[g]) for d, r, g in zip(depths, rates, grows, strict=True)
            )  # fmt: skip
            depths = [d + turns * r for d, r in zip(depths, rates, strict=True)]
        return depths
