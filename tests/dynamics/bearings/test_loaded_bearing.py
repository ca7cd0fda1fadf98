"""The stiffness of a ball bearing against closed forms, slow quadrature, and a minimum of energy found without it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize

from siggen.drivetrain.bearings import BallBearing, LoadedBearing, loaded_bearing


def bearing(balls: int = 9, clearance_m: float = 0.0, angle_rad: float = 0.0) -> BallBearing:
    return BallBearing(balls, 7.94e-3, 39.04e-3, angle_rad, clearance_m)


def under(one: BallBearing, force_n: float, angles: int = 32) -> LoadedBearing:
    return loaded_bearing(one, np.array([force_n, 0.0]), angles)


def test_without_clearance_the_stiffness_is_harris_closed_form() -> None:
    """Q_max = 4.37 F/(Z cos φ) gives the way, and F ~ δ^1.5 the stiffness 1.5 F/δ along and F/δ across."""
    for force_n, angle in ((1.0, 0.0), (1200.0, 0.0), (1200.0, 0.5)):
        one = bearing(angle_rad=angle)
        ball_n = 4.37 * force_n / (one.balls * np.cos(angle))
        way_m = (ball_n / one.contact_n_per_m15) ** (2.0 / 3.0) / np.cos(angle)
        found = under(one, force_n)
        # 4.37 has three digits; of nine balls the across stiffness is 0.6 % above that of balls everywhere
        np.testing.assert_allclose(found.along_n_per_m, 1.5 * force_n / way_m, rtol=2e-3)
        np.testing.assert_allclose(found.across_n_per_m, force_n / way_m, rtol=1e-2)


@pytest.mark.parametrize("clearance_m", [0.0, 10e-6, 60e-6])
def test_of_many_balls_the_stiffness_is_that_of_the_integral_over_the_zone_of_load(clearance_m: float) -> None:
    def force_n(way_m: float) -> float:
        def load(psi: float) -> float:
            return float(max(way_m * np.cos(psi) - 0.5 * clearance_m, 0.0) ** 1.5 * np.cos(psi))

        half = np.arccos(min(1.0, 0.5 * clearance_m / way_m))
        return float(240 * bearing().contact_n_per_m15 * quad(load, 0.0, half, epsrel=1e-12)[0] / np.pi)

    way, step = 0.5 * clearance_m + 12e-6, 1e-9
    found = under(bearing(240, clearance_m), force_n(way))
    np.testing.assert_allclose(found.moved_m, way, rtol=1e-6)
    np.testing.assert_allclose(found.along_n_per_m, (force_n(way + step) - force_n(way - step)) / (2 * step), rtol=1e-4)
    np.testing.assert_allclose(found.across_n_per_m, force_n(way) / way, rtol=1e-3)  # the sum over 240 balls


@pytest.mark.parametrize("clearance_m", [0.0, 20e-6])
def test_balls_rest_where_their_energy_is_least_and_stiffness_is_how_that_place_follows_the_load(
    clearance_m: float,
) -> None:
    one, force_n = bearing(8, clearance_m, 0.3), 700.0
    places = (np.arange(8) + 0.5) * one.spacing_rad  # one angle of the cage: half a spacing behind the load

    def rest_m(force: tuple[float, float]) -> np.ndarray:
        def energy(um: np.ndarray) -> float:
            along = np.cos(0.3) * 1e-6 * (um[0] * np.cos(places) + um[1] * np.sin(places))
            squeezed = np.maximum(along - 0.5 * clearance_m, 0.0)
            return float(0.4 * one.contact_n_per_m15 * (squeezed**2.5).sum() - 1e-6 * np.dot(force, um)) * 1e3

        steps = {"xatol": 1e-9, "fatol": 1e-16, "maxiter": 4000, "maxfev": 4000}
        return np.asarray(1e-6 * minimize(energy, [30.0, 0.0], method="Nelder-Mead", options=steps).x)

    found, push = under(one, force_n, angles=1), 2.0
    assert found.moved_m == pytest.approx(rest_m((force_n, 0.0))[0], rel=1e-5)
    along = rest_m((force_n + push, 0.0))[0] - rest_m((force_n - push, 0.0))[0]
    across = rest_m((force_n, push))[1] - rest_m((force_n, -push))[1]
    # a search without derivatives finds the place to some 1e-10 m of 1e-8 m
    assert found.along_n_per_m == pytest.approx(2.0 * push / along, rel=1e-2)
    assert found.across_n_per_m == pytest.approx(2.0 * push / across, rel=1e-2)


def test_the_stiffness_turns_with_the_load_and_its_mean_has_settled() -> None:
    one, force = bearing(9, 10e-6), 900.0 * np.array([np.cos(0.7), np.sin(0.7)])
    found, straight = loaded_bearing(one, force), under(one, 900.0)
    np.testing.assert_allclose(np.linalg.eigvalsh(found.stiffness_n_per_m)[::-1], [
        straight.along_n_per_m, straight.across_n_per_m
    ], rtol=1e-12)  # fmt: skip
    np.testing.assert_allclose(found.stiffness_n_per_m @ force, straight.along_n_per_m * force, rtol=1e-12)
    fine = under(one, 900.0, 512)
    np.testing.assert_allclose(straight.along_n_per_m, fine.along_n_per_m, rtol=5e-3)
    np.testing.assert_allclose(straight.across_n_per_m, fine.across_n_per_m, rtol=5e-3)


def test_eight_lines_hold_what_passing_balls_do_and_many_balls_do_nothing() -> None:
    for clearance_m in (0.0, 10e-6, 30e-6):
        found = loaded_bearing(bearing(9, clearance_m), 1200.0 * np.array([0.6, 0.8]))
        place = 2.0 * np.pi * (np.arange(32) + 0.5) / 32
        waves = np.exp(1j * np.outer(np.arange(1, 9), place))
        first, second = (found.passing_lines_m(8) @ waves).real
        rebuilt = np.stack([0.6 * first + 0.8 * second, 0.6 * second - 0.8 * first], axis=1)
        # a ball that is let go leaves a kink, whose lines fall slowly
        assert ((rebuilt - found.passing_m) ** 2).sum() < 0.01 * (found.passing_m**2).sum()
    few, many = (np.abs(under(bearing(balls, 10e-6), 1200.0).passing_m).max() for balls in (9, 90))
    assert many < 1e-2 * few
