"""Kinematics and zone of load of a ball bearing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from siggen.drivetrain.bearings import BallBearing, loaded_bearing
from siggen.rig.bearings import BearingSize

BEARING = BallBearing(9, 7.94e-3, 39.04e-3)


def test_orders_are_those_of_the_catalogue_for_a_6205() -> None:
    orders = (BEARING.outer_order, BEARING.inner_order, BEARING.spin_order, BEARING.cage_order)
    # as printed for this bearing by the bearing data centre of Case Western Reserve University (from memory); BSF there
    # is of both races, so half of 4.7135
    np.testing.assert_allclose(orders, (3.5848, 5.4152, 2.3567, 0.3983), atol=1e-4)


@pytest.mark.parametrize("contact_deg", [0.0, 15.0, 40.0])
@pytest.mark.parametrize("balls", [5, 9, 16])
def test_both_races_share_all_balls(balls: int, contact_deg: float) -> None:
    bearing = BallBearing(balls, 7.94e-3, 39.04e-3, math.radians(contact_deg))
    assert bearing.outer_order + bearing.inner_order == pytest.approx(balls, rel=1e-15)
    twice = BallBearing(2 * balls, 7.94e-3, 39.04e-3, math.radians(contact_deg))
    assert twice.outer_order == 2.0 * bearing.outer_order
    # a ball rolls on both races: what it turns about itself is what its path on either race asks for
    rolled = (
        2.0 * bearing.outer_radius_m * bearing.cage_order,
        2.0 * bearing.inner_radius_m * (1.0 - bearing.cage_order),
    )
    np.testing.assert_allclose(rolled, bearing.spin_order * bearing.ball_diameter_m, rtol=1e-14)


@pytest.mark.parametrize("clearance_m", [0.0, 5e-6, 40e-6])
@pytest.mark.parametrize("contact_deg", [0.0, 25.0])
def test_balls_in_the_zone_bear_the_load(clearance_m: float, contact_deg: float) -> None:
    bearing = BallBearing(9, 7.94e-3, 39.04e-3, math.radians(contact_deg), clearance_m)
    moved = bearing.deflection_m(800.0)

    def share(angle: float) -> float:
        squeezed = moved * math.cos(math.radians(contact_deg)) * math.cos(angle) - 0.5 * clearance_m
        load = math.sqrt(7.94) * (max(squeezed, 0.0) * 1e3 / 4.4e-4) ** 1.5
        return 9 * load * math.cos(math.radians(contact_deg)) * math.cos(angle) / (2.0 * math.pi)

    half = math.acos(0.5 * clearance_m / (moved * math.cos(math.radians(contact_deg))))
    assert 2.0 * quad(share, 0.0, half, epsabs=1e-10)[0] == pytest.approx(800.0, rel=1e-9)
    assert bearing.half_zone_rad(moved) == pytest.approx(half)


def test_without_clearance_the_largest_ball_load_is_that_of_stribeck_at_any_load() -> None:
    for force in (1.0, 300.0, 1e4):
        squeezed = float(BEARING.squeezed_m(BEARING.deflection_m(force), np.zeros(1))[0])
        largest = BEARING.contact_n_per_m15 * squeezed**1.5
        assert largest * 9 / force == pytest.approx(4.37, abs=0.005)  # the figure has three digits


def test_the_deflection_is_that_of_the_catalogues_formula_of_a_whole_bearing() -> None:
    whole = BearingSize(bore_mm=25.0, height_mm=7.94 / 0.3, width_mm=15.0)
    slope = whole.stiffness_n_per_m(600.0)
    step = 1.0
    ours = 2.0 * step / (BEARING.deflection_m(600.0 + step) - BEARING.deflection_m(600.0 - step))
    assert BEARING.balls == whole.balls
    assert ours == pytest.approx(slope, rel=2e-3)  # it has 4.37 in place of the integral, and we a difference


def test_preload_squeezes_all_balls_and_carries_the_load_softly_bent_to_that_of_hertz() -> None:
    """Without load by hand: n balls of stiffness 1.5 K sqrt(G/2), half of which acts along any direction."""
    tight = BallBearing(9, 7.94e-3, 39.04e-3, clearance_m=-10e-6)
    along, across = (
        loaded_bearing(tight, np.zeros(2)).along_n_per_m,
        loaded_bearing(tight, np.zeros(2)).across_n_per_m,
    )
    expected = 0.5 * 9 * 1.5 * tight.contact_n_per_m15 * math.sqrt(5e-6)
    assert along == pytest.approx(expected, rel=1e-12)
    assert across == pytest.approx(expected, rel=1e-12)
    small = loaded_bearing(tight, np.array([1.0, 0.0]))
    assert small.moved_m == pytest.approx(1.0 / expected, rel=1e-3)
    assert small.half_zone_rad == pytest.approx(math.pi)
    # far above the preload it is a bearing without play, less the way that it is ahead
    heavy = [loaded_bearing(one, np.array([5e5, 0.0])).along_n_per_m for one in (tight, BEARING)]
    assert heavy[0] / heavy[1] == pytest.approx(1.0, abs=0.03)
    assert BEARING.deflection_m(0.0) == tight.deflection_m(0.0) == 0.0


def test_preload_that_vanishes_is_no_clearance() -> None:
    none, least = (loaded_bearing(BallBearing(9, 7.94e-3, 39.04e-3, clearance_m=g), FORCE) for g in (0.0, -1e-12))
    assert least.along_n_per_m == pytest.approx(none.along_n_per_m, rel=1e-5)
    assert least.moved_m == pytest.approx(none.moved_m, rel=1e-5)


FORCE = np.array([300.0, 100.0])
