"""Specimens: drawn by their own keys, so that no change elsewhere changes them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.gearbox.teeth import gear_pair, tooth_law
from tests.config.minimal import design

SPREAD = {
    "gears__module_mm": [2.5, 3.5],
    "gears__pinion__bore_radius_mm": {"one_of": [8, 9, 10]},
    "dynamics__mesh_damping_ratio": [0.05, 0.1],
    "dynamics__gear__bearing__stiffness_n_per_m": {"log": [6e7, 1.2e8]},
    "operating_points": [
        {
            "speed_hz": [20, 35],
            "torque_nm": {"normal": [50, 10], "within": [30, 80]},
        }
    ]
    * 2,
    "sensors__bearing__gain": [0.9, 1.1],
}


DRAWN, OF_MANY = design(**SPREAD), design(**SPREAD, specimens=10**7)


@given(st.integers(0, 10**6))
def test_a_specimen_does_not_depend_on_the_number_of_specimens(specimen):
    assert DRAWN.gearbox(specimen) == OF_MANY.gearbox(specimen)


@pytest.mark.parametrize(
    "change",
    [
        {"gears__face_width_mm": [18, 22]},
        {"gears__gear__bore_radius_mm": [14, 16]},
        {"dynamics__backlash_um": [60, 120]},
        {"dynamics__pinion__mass_kg": [0.4, 0.6]},
        {"sensors__bearing__noise": {"floor_m_s2": {"log": [0.01, 1]}}},
        {"states": {"healthy": {}}},
        {"repeats": 5},
        {"fs_hz": 25_600},
    ],
)
def test_a_new_distribution_or_setting_leaves_all_other_draws_alone(change):
    before, after = DRAWN, design(**SPREAD, **change)
    old, new = before.gearbox(3), after.gearbox(3)
    assert old.pair.pinion.module_m == new.pair.pinion.module_m
    assert old.pair.pinion.bore_radius_m == new.pair.pinion.bore_radius_m
    assert old.law.damping_ratio == new.law.damping_ratio
    assert old.train.first.gear.bearing == new.train.first.gear.bearing
    assert old.channels[0].gain == new.channels[0].gain
    assert before.drawn_points(3)[1] == after.drawn_points(3)[1]


def test_more_operating_points_leave_existing_ones_alone():
    more = design(**{**SPREAD, "operating_points": SPREAD["operating_points"][:1] * 5})
    for point in range(2):
        assert DRAWN.drawn_points(3)[point] == more.drawn_points(3)[point]


def test_operating_points_of_a_specimen_are_drawn_independently():
    speeds = np.array([[DRAWN.drawn_points(i)[k].speed_hz for k in (0, 1)] for i in range(400)])
    # 400 independent pairs: the correlation has a standard deviation of 0.05
    assert abs(np.corrcoef(speeds.T)[0, 1]) < 0.2
    assert len(np.unique(speeds)) == 800


def test_constants_need_no_luck():
    friction = {"boundary_friction": 0.09, "roughness_um": 0.4, "oil_temperature_c": 50.0}
    constants = design(**{f"dynamics__friction__{key}": value for key, value in friction.items()})
    drawn = constants.gearbox(5)
    assert drawn.pair == gear_pair(constants.config.gears)
    assert drawn.law == tooth_law(constants.config.dynamics)
    assert drawn.channels[0].gain == 1.0
