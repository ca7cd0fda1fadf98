"""Bearing: ball and roller bearings of the catalogues, how they give way and how long they last.

Bore, outer diameter and width are those of ISO 15, dimension series 10, 02 and 03: ball bearings 60, 62 and 63, roller
bearings NU 10, NU 2 and NU 3. Deflection by Palmgren, as catalogues give it, without clearance (mm, N):

    ball      delta = 4.4e-4 Q^(2/3) D^(-1/3)     Q = 4.37 F/Z
    roller    delta = 7.7e-5 Q^0.9 l^(-0.8)       Q = 4.08 F/Z     l = D = 0.27 of the height, in 0.78 of the circle

Catalogues of makers (from memory: 6005 to 6007, 6205 to 6209, 6305 to 6307) have balls of 0.28 to 0.31 of the height
from bore to outer ring, and 10 to 12 of them in series 60, 9 or 10 in 62, 7 or 8 in 63; here a number for each series.

Load rating of ball bearings by ISO 281, C = 1.3 f_c Z^(2/3) D^1.8 with f_c = 59; life (C/F)^3 million turns.
"""

from __future__ import annotations

from bisect import bisect_left
from math import pi
from typing import NamedTuple

BALLS = {60: 11, 62: 9, 63: 8}
BALL_SHARE = {60: 0.29, 62: 0.3, 63: 0.3}
"""Series -> diameter of a ball over the height between bore and outer ring."""
ROLLERS = {60: "NU 10", 62: "NU 2", 63: "NU 3"}
CODES = {10: "00", 12: "01", 15: "02", 17: "03"}
"""Bore [mm] -> its number in a name; below 10 mm the bore itself, from 20 mm on a fifth of it."""
USUAL_SERIES = 62
LEAST_LIFE_H = 20_000.0
"""Usual for machines that run eight hours a day (catalogues: 20,000 to 30,000 h)."""
SIZES_MM = {
    60: (
        (4, 12, 4), (5, 14, 5), (6, 17, 6), (7, 19, 6), (8, 22, 7), (9, 24, 7), (10, 26, 8), (12, 28, 8), (15, 32, 9),
        (17, 35, 10), (20, 42, 12), (25, 47, 12), (30, 55, 13), (35, 62, 14), (40, 68, 15), (45, 75, 16), (50, 80, 16),
        (55, 90, 18), (60, 95, 18), (65, 100, 18), (70, 110, 20), (75, 115, 20), (80, 125, 22), (85, 130, 22),
        (90, 140, 24), (95, 145, 24), (100, 150, 24), (105, 160, 26), (110, 170, 28), (120, 180, 28), (130, 200, 33),
        (140, 210, 33), (150, 225, 35), (160, 240, 38), (170, 260, 42), (180, 280, 46), (190, 290, 46), (200, 310, 51),
        (220, 340, 56), (240, 360, 56),
    ),
    62: (
        (3, 10, 4), (4, 13, 5), (5, 16, 5), (6, 19, 6), (7, 22, 7), (8, 24, 8), (9, 26, 8), (10, 30, 9), (12, 32, 10),
        (15, 35, 11), (17, 40, 12), (20, 47, 14), (25, 52, 15), (30, 62, 16), (35, 72, 17), (40, 80, 18), (45, 85, 19),
        (50, 90, 20), (55, 100, 21), (60, 110, 22), (65, 120, 23), (70, 125, 24), (75, 130, 25), (80, 140, 26),
        (85, 150, 28), (90, 160, 30), (95, 170, 32), (100, 180, 34), (105, 190, 36), (110, 200, 38), (120, 215, 40),
        (130, 230, 40), (140, 250, 42), (150, 270, 45), (160, 290, 48), (170, 310, 52), (180, 320, 52), (190, 340, 55),
        (200, 360, 58), (220, 400, 65), (240, 440, 72),
    ),
    63: (
        (4, 16, 5), (5, 19, 6), (6, 22, 7), (7, 26, 9), (8, 28, 9), (9, 30, 10), (10, 35, 11), (12, 37, 12),
        (15, 42, 13), (17, 47, 14), (20, 52, 15), (25, 62, 17), (30, 72, 19), (35, 80, 21), (40, 90, 23), (45, 100, 25),
        (50, 110, 27), (55, 120, 29), (60, 130, 31), (65, 140, 33), (70, 150, 35), (75, 160, 37), (80, 170, 39),
        (85, 180, 41), (90, 190, 43), (95, 200, 45), (100, 215, 47), (105, 225, 49), (110, 240, 50), (120, 260, 55),
        (130, 280, 58), (140, 300, 62), (150, 320, 65), (160, 340, 68), (170, 360, 72), (180, 380, 75), (190, 400, 78),
        (200, 420, 80), (220, 460, 88), (240, 500, 95),
    ),
}  # fmt: skip
"""Series -> bore, outer diameter and width, from the smallest bore."""
BORES_OF_MM = {series: tuple(bore for bore, *_ in sizes) for series, sizes in SIZES_MM.items()}
BORES_MM = BORES_OF_MM[USUAL_SERIES]


class BearingSize(NamedTuple):
    """Bore, height between bore and outer ring on both sides together, and width [mm]; with rollers or balls.

    `series`: of the catalogue, or that whose shape it has.
    """

    bore_mm: float
    height_mm: float
    width_mm: float
    rollers: bool = False
    series: int = USUAL_SERIES

    @property
    def outer_mm(self) -> float:
        """Outer diameter [mm]."""
        return self.bore_mm + self.height_mm

    @property
    def kind(self) -> str:
        """What it is called."""
        return "roller" if self.rollers else "ball"

    @property
    def balls(self) -> int:
        """Number of balls."""
        return BALLS[self.series]

    @property
    def ball_mm(self) -> float:
        """Diameter of a ball [mm]."""
        return BALL_SHARE[self.series] * self.height_mm

    @property
    def pitch_mm(self) -> float:
        """Diameter of the circle of the balls' centres [mm]."""
        return self.bore_mm + 0.5 * self.height_mm

    @property
    def designation(self) -> str:
        """Name in the catalogue, such as 6207 or NU 207; of a bore without one, its series and bore."""
        head = ROLLERS[self.series] if self.rollers else f"{self.series}"
        if (self.bore_mm, self.outer_mm, self.width_mm) not in SIZES_MM[self.series]:
            return f"{head}, bore {self.bore_mm:.4g} mm"
        bore = round(self.bore_mm)
        return f"{head}{bore if bore < 10 else CODES.get(bore, f'{bore // 5:02d}')}"

    def stiffness_n_per_m(self, force_n: float) -> float:
        """Return dF/d(delta) under a radial force [N/m]."""
        if self.rollers:
            roller_mm = 0.27 * self.height_mm
            count = 0.78 * pi * (self.bore_mm + 0.5 * self.height_mm) / roller_mm
            return float(1e3 * force_n / (0.9 * 7.7e-5 * (4.08 * force_n / count) ** 0.9 / roller_mm**0.8))
        deflection_mm = 4.4e-4 * (4.37 * force_n / self.balls) ** (2.0 / 3.0) / self.ball_mm ** (1.0 / 3.0)
        return float(1.5e3 * force_n / deflection_mm)


def bearing_from(least_bore_mm: float, series: int = USUAL_SERIES) -> BearingSize:
    """Return the smallest ball bearing of a series with at least this bore; beyond the largest, one of its shape."""
    place = bisect_left(BORES_OF_MM[series], least_bore_mm)
    if place == len(BORES_OF_MM[series]):
        return bearing_like(least_bore_mm)
    bore_mm, outer_mm, width_mm = map(float, SIZES_MM[series][place])
    return BearingSize(bore_mm, outer_mm - bore_mm, width_mm, series=series)


def life_h(bearing: BearingSize, force_n: float, speed_hz: float) -> float:
    """Return the basic rating life of a ball bearing at a radial force and speed [h]."""
    rating_n = 1.3 * 59.0 * bearing.balls ** (2.0 / 3.0) * bearing.ball_mm**1.8
    return float(1e6 * (rating_n / force_n) ** 3 / (3600.0 * speed_hz))


def step_above_mm(bore_mm: float) -> float:
    """Return the next bore of the series above a diameter: the shoulder that a bearing of this bore rests on [mm]."""
    place = bisect_left(BORES_MM, bore_mm * (1.0 + 1e-9))
    return float(BORES_MM[place]) if place < len(BORES_MM) else 1.1 * bore_mm


def bearing_like(bore_mm: float) -> BearingSize:
    """Return a bearing of any bore, with the mean shape of the series: outer ring 1.6 d + 12 mm."""
    return BearingSize(bore_mm, 0.6 * bore_mm + 12.0, 0.2 * bore_mm + 10.0)
