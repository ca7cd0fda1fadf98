"""Sums over bosses and bores: closed forms of their areas, and a wall that stays a body around any bore."""

from dataclasses import replace
from math import pi

import pytest

from siggen.drivetrain.box import Seat, common_area_m2
from siggen.drivetrain.box_energy import bore_area, boss_area

LARGE = Seat(0.060, 0.091, 0.0381, 0.0508, 0.0143)
SMALL = Seat(0.125, 0.091, 0.0236, 0.0283, 0.0143)


def test_a_bore_has_the_moments_of_a_disc() -> None:
    area = bore_area(LARGE, 100.0)
    x, y = area.first_m - LARGE.x_m, area.second_m - LARGE.y_m
    # ∫ x^2m y^2n over a disc: R^(2m+2n+2) Γ(m+1/2) Γ(n+1/2) / ((m+n+1) Γ(m+n+1)); odd powers give nothing.
    radius = LARGE.bore_radius_m
    exact = {(0, 0): pi, (2, 0): pi / 4.0, (2, 2): pi / 24.0, (6, 4): pi / 512.0, (1, 0): 0.0}
    for (m, n), of_unit_disc in exact.items():
        found = (area.weight_m2 * x**m * y**n).sum() / radius ** (m + n + 2)
        assert found == pytest.approx(of_unit_disc, rel=1e-12, abs=1e-14)


@pytest.mark.parametrize("other", [SMALL, replace(SMALL, boss_radius_m=LARGE.boss_radius_m, x_m=0.14)])
def test_bosses_that_meet_share_the_area_of_both_circles(other: Seat) -> None:
    one, other = (replace(seat, bore_radius_m=0.012) for seat in (LARGE, other))  # what they share has no hole
    common = common_area_m2(one, other)
    rings = [pi * (seat.boss_radius_m**2 - seat.bore_radius_m**2) for seat in (one, other)]
    errors = []
    for points_per_m in (100.0, 1600.0):
        areas = boss_area(one, [other], points_per_m), boss_area(other, [one], points_per_m)
        found = sum(area.weight_m2.sum() for area in areas)
        errors.append(abs(found - (sum(rings) - common)) / common)
    assert common > 0.05 * rings[1]
    # Where a border leaves a boss, the sum over angles has a kink: of second order, so 16² = 256 times less, by the
    # kink's place between two angles up to some times more.
    assert errors[0] < 0.03
    assert errors[1] < 0.03 / 64.0
