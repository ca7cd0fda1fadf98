from __future__ import annotations

import numpy as np
import pytest

from siggen.gears.geometry.corner_contact import tip_gap_m
from tests.dynamics.pair_runs import gear_pair

DISTANCES = np.array([0.1, 0.2, 0.4, 0.8]) * 1e-3


@pytest.mark.parametrize(
    ("which", "expected_um"), [("gear", [0.74, 2.8, 10.4, 38.0]), ("pinion", [0.24, 0.97, 3.9, 15.9])]
)
def test_the_gaps_of_both_ends_are_those_of_an_independent_computation(which: str, expected_um: list[float]) -> None:
    pair = gear_pair()
    position = pair.contact_start_m - DISTANCES if which == "gear" else pair.contact_end_m + DISTANCES
    # The expected ones are given to two or three digits.
    np.testing.assert_allclose(1e6 * tip_gap_m(pair, which, position), expected_um, rtol=0.011)


@pytest.mark.parametrize("which", ["gear", "pinion"])
def test_near_the_end_the_gap_is_the_parabola_of_the_curvatures(which: str) -> None:
    pair, small = gear_pair(), 1e-6
    end = pair.contact_start_m if which == "gear" else pair.contact_end_m
    own = pair.member(which)
    tip = own.base_radius_m * own.tip_roll_rad
    relative = end * (pair.line_of_action_m - end) / pair.line_of_action_m
    law = (tip / own.base_radius_m) ** 2 / (2.0 * relative) * small**2
    found = tip_gap_m(pair, which, np.array([end - small if which == "gear" else end + small]))[0]
    # Second order in a distance of 1e-6 m against radii of 1e-3 m; angles of 1 rad leave 3e-18 m of 8e-11 m.
    assert found == pytest.approx(law, rel=3e-3)


@pytest.mark.parametrize("which", ["gear", "pinion"])
def test_on_the_path_of_contact_no_corner_leaves_a_gap(which: str) -> None:
    pair = gear_pair()
    inside = np.linspace(pair.contact_start_m, pair.contact_end_m, 101)
    assert (tip_gap_m(pair, which, inside) == 0.0).all()
