from __future__ import annotations

import numpy as np
import pytest

from siggen.arrays import FloatArray
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import tip_gap_m
from siggen.gears.planetary import InternalPair, ring_round
from siggen.names import Side
from tests.dynamics.pair_runs import gear_pair
from tests.gears.builders import spur_gear

DISTANCES = np.array([0.1, 0.2, 0.4, 0.8]) * 1e-3


@pytest.mark.parametrize(
    ("which", "expected_um"), [(Side.DRIVEN, [0.74, 2.8, 10.4, 38.0]), (Side.DRIVER, [0.24, 0.97, 3.9, 15.9])]
)
def test_the_gaps_of_both_ends_are_those_of_an_independent_computation(which: str, expected_um: list[float]) -> None:
    pair = gear_pair()
    position = pair.contact_start_m - DISTANCES if which == Side.DRIVEN else pair.contact_end_m + DISTANCES
    # The expected ones are given to two or three digits.
    np.testing.assert_allclose(1e6 * tip_gap_m(pair, which, position), expected_um, rtol=0.011)


@pytest.mark.parametrize("which", list(Side))
def test_near_the_end_the_gap_is_the_parabola_of_the_curvatures(which: str) -> None:
    pair, small = gear_pair(), 1e-6
    end = pair.contact_start_m if which == Side.DRIVEN else pair.contact_end_m
    own = pair.member(which)
    tip = own.base_radius_m * own.tip_roll_rad
    relative = end * (pair.line_of_action_m - end) / pair.line_of_action_m
    law = (tip / own.base_radius_m) ** 2 / (2.0 * relative) * small**2
    found = tip_gap_m(pair, which, np.array([end - small if which == Side.DRIVEN else end + small]))[0]
    # Second order in a distance of 1e-6 m against radii of 1e-3 m; angles of 1 rad leave 3e-18 m of 8e-11 m.
    assert found == pytest.approx(law, rel=3e-3)


def planet_in_ring() -> InternalPair:
    return ring_round(GearPair(spur_gear(25, 2e-3, 8e-3), spur_gear(26, 2e-3, 8e-3), 20e-3, 206e9, 0.3), 77)


def turned_until_touching_m(pair: InternalPair, which: str, position_m: float) -> float:
    """Return by how much the mate turns until its flank meets a corner, along the line of action.

    Both flanks as points in the plane, from the planet's centre at (0, 0) and the ring's at (-a, 0) for a planet on the
    right of the ring's centre; the ring's corner is its tip, the planet's its own. Angles of flanks are read at the
    corner's distance from the mate's centre.
    """
    planet, ring, slant = pair.pinion, pair.gear, pair.working_pressure_angle_rad
    a = pair.working_centre_distance_m

    def flank(radius_m: FloatArray, base_m: float, origin: float) -> FloatArray:
        roll = np.sqrt((radius_m / base_m) ** 2 - 1.0)
        return origin + roll - np.arctan(roll)

    of_planet = slant - position_m / planet.base_radius_m
    of_ring = slant - (position_m - pair.line_of_action_m) / ring.base_radius_m
    if which == "pinion":
        radius = np.array([planet.tip_radius_m])
        angle = flank(radius, planet.base_radius_m, of_planet)
        x, y = a + radius * np.cos(angle), radius * np.sin(angle)
        missed = np.arctan2(y, x) - flank(np.hypot(x, y), ring.base_radius_m, of_ring)
        return float(abs(missed[0]) * ring.base_radius_m)
    radius = np.array([ring.tip_radius_m])
    angle = flank(radius, ring.base_radius_m, of_ring)
    x, y = radius * np.cos(angle) - a, radius * np.sin(angle)
    missed = np.arctan2(y, x) - flank(np.hypot(x, y), planet.base_radius_m, of_planet)
    return float(abs(missed[0]) * planet.base_radius_m)


@pytest.mark.parametrize("which", list(Side))
def test_corners_in_a_ring_leave_the_gap_of_turned_outlines_and_less_than_outside(which: str) -> None:
    pair = planet_in_ring()
    for distance in DISTANCES:
        position = pair.contact_start_m - distance if which == Side.DRIVEN else pair.contact_end_m + distance
        found = tip_gap_m(pair, which, np.array([position]))[0]
        assert found == pytest.approx(turned_until_touching_m(pair, which, position), rel=1e-6)
    own = pair.member(which)
    end = pair.contact_start_m if which == Side.DRIVEN else pair.contact_end_m
    relative = end * (pair.line_of_action_m - end) / pair.line_of_action_m
    parabola = own.tip_roll_rad**2 / (2.0 * relative) * 1e-4**2
    small = tip_gap_m(pair, which, np.array([end - 1e-4 if which == Side.DRIVEN else end + 1e-4]))[0]
    assert small == pytest.approx(parabola, rel=0.02)  # second order in 0.1 mm
    assert small < 0.25 * 42.9e-6 * (1e-4 / 0.886e-3) ** 2 * 1.1  # of sun and planet 0.15 pitches beside their path
    inside = np.linspace(pair.contact_start_m, pair.contact_end_m, 101)
    assert (tip_gap_m(pair, which, inside) == 0.0).all()
