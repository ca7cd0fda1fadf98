"""Bearing: ball and roller bearings of the catalogues, how they give way and how long they last.

Sizes are those of dimension series 02 of ISO 15 (ball bearings 623 to 629 and 6200 to 6244, roller bearings NU 2).
Deflection by Palmgren, as catalogues give it, without clearance (mm, N):

    ball      delta = 4.4e-4 Q^(2/3) D^(-1/3)     Q = 4.37 F/Z     D = 0.3 of the height (bore to outer ring), Z = 9
    roller    delta = 7.7e-5 Q^0.9 l^(-0.8)       Q = 4.08 F/Z     l = D = 0.27 of it, in 0.78 of the circle

Load rating of ball bearings by ISO 281, C = 1.3 f_c Z^(2/3) D^1.8 with f_c = 59; life (C/F)^3 million turns.
"""

from __future__ import annotations

from bisect import bisect_left
from math import pi
from typing import NamedTuple

BALLS = 9
LEAST_LIFE_H = 20_000.0
"""Usual for machines that run eight hours a day (catalogues: 20,000 to 30,000 h)."""
SERIES_02_MM = (
    (3, 10, 4), (4, 13, 5), (5, 16, 5), (6, 19, 6), (7, 22, 7), (8, 24, 8), (9, 26, 8), (10, 30, 9), (12, 32, 10),
    (15, 35, 11), (17, 40, 12), (20, 47, 14), (25, 52, 15), (30, 62, 16), (35, 72, 17), (40, 80, 18), (45, 85, 19),
    (50, 90, 20), (55, 100, 21), (60, 110, 22), (65, 120, 23), (70, 125, 24), (75, 130, 25), (80, 140, 26),
    (85, 150, 28), (90, 160, 30), (95, 170, 32), (100, 180, 34), (105, 190, 36), (110, 200, 38), (120, 215, 40),
    (130, 230, 40), (140, 250, 42), (150, 270, 45), (160, 290, 48), (170, 310, 52), (180, 320, 52), (190, 340, 55),
    (200, 360, 58), (220, 400, 65), (240, 440, 72),
)  # fmt: skip
"""Bore, outer diameter and width, from the smallest bore."""
BORES_MM = tuple(bore for bore, *_ in SERIES_02_MM)


class BearingSize(NamedTuple):
    """Bore, height between bore and outer ring on both sides together, and width [mm]; with rollers or balls."""

    bore_mm: float
    height_mm: float
    width_mm: float
    rollers: bool = False

    @property
    def outer_mm(self) -> float:
        """Outer diameter [mm]."""
        return self.bore_mm + self.height_mm

    @property
    def kind(self) -> str:
        """What it is called."""
        return "roller" if self.rollers else "ball"

    def stiffness_n_per_m(self, force_n: float) -> float:
        """Return dF/d(delta) under a radial force [N/m]."""
        if self.rollers:
            roller_mm = 0.27 * self.height_mm
            count = 0.78 * pi * (self.bore_mm + 0.5 * self.height_mm) / roller_mm
            return float(1e3 * force_n / (0.9 * 7.7e-5 * (4.08 * force_n / count) ** 0.9 / roller_mm**0.8))
        ball_mm = 0.3 * self.height_mm
        deflection_mm = 4.4e-4 * (4.37 * force_n / BALLS) ** (2.0 / 3.0) / ball_mm ** (1.0 / 3.0)
        return float(1.5e3 * force_n / deflection_mm)


def bearing_from(least_bore_mm: float) -> BearingSize:
    """Return the smallest ball bearing of the series with at least this bore; beyond the largest, one of its shape."""
    place = bisect_left(BORES_MM, least_bore_mm)
    if place == len(BORES_MM):
        return bearing_like(least_bore_mm)
    bore_mm, outer_mm, width_mm = map(float, SERIES_02_MM[place])
    return BearingSize(bore_mm, outer_mm - bore_mm, width_mm)


def life_h(bearing: BearingSize, force_n: float, speed_hz: float) -> float:
    """Return the basic rating life of a ball bearing at a radial force and speed [h]."""
    rating_n = 1.3 * 59.0 * BALLS ** (2.0 / 3.0) * (0.3 * bearing.height_mm) ** 1.8
    return float(1e6 * (rating_n / force_n) ** 3 / (3600.0 * speed_hz))


def step_above_mm(bore_mm: float) -> float:
    """Return the next bore of the series above a diameter: the shoulder that a bearing of this bore rests on [mm]."""
    place = bisect_left(BORES_MM, bore_mm * (1.0 + 1e-9))
    return float(BORES_MM[place]) if place < len(BORES_MM) else 1.1 * bore_mm


def bearing_like(bore_mm: float) -> BearingSize:
    """Return a bearing of any bore, with the mean shape of the series: outer ring 1.6 d + 12 mm."""
    return BearingSize(bore_mm, 0.6 * bore_mm + 12.0, 0.2 * bore_mm + 10.0)
