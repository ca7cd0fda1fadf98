"""How rubbing rises and falls over a pitch: nothing at the pitch point of a single pair, a mean of 1."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.mesh.asperities import rubbing_course
from tests.dynamics.pair_runs import gear_pair


def test_a_single_pair_does_not_rub_where_it_rolls() -> None:
    pair = gear_pair()
    course = rubbing_course(pair, 1.0, 4096)
    ratio = (pair.contact_end_m - pair.contact_start_m) / pair.base_pitch_m
    pitch_point = pair.pinion.base_radius_m * np.tan(pair.working_pressure_angle_rad)
    place = (pitch_point - pair.contact_start_m) / pair.base_pitch_m
    assert ratio - 1.0 < place < 1.0  # one pair alone
    assert course[round(place * 4096)] < 0.01 * course.max()
    assert course.mean() == pytest.approx(1.0)


def test_loads_that_do_not_slide_more_here_than_there_rub_evenly() -> None:
    # with the exponent 0 only the shares count, and they add up to the whole load
    np.testing.assert_allclose(rubbing_course(gear_pair(), 0.0), 1.0, rtol=1e-12)


def test_a_pair_alone_rubs_in_proportion_to_its_distance_from_the_pitch_point() -> None:
    pair = gear_pair()
    course = rubbing_course(pair, 1.0, 4096)
    ratio = (pair.contact_end_m - pair.contact_start_m) / pair.base_pitch_m
    pitch_point = pair.pinion.base_radius_m * np.tan(pair.working_pressure_angle_rad)
    place = (pitch_point - pair.contact_start_m) / pair.base_pitch_m
    phases = np.arange(4096) / 4096
    alone = (phases > ratio - 1.0) & (np.abs(phases - place) > 0.05)
    slope = course[alone] / np.abs(phases[alone] - place)
    np.testing.assert_allclose(slope, slope[0], rtol=1e-9)
