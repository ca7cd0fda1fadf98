"""Transmission errors of two encoders: the static mesh at low speed, drift, and encoders that are not there."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from siggen.record.specimen_state import specimen_state
from tests.sensors.runs import loaded, problems, record
from tests.sensors.test_encoder import GEAR, OFF, PINION

ERROR = {"kind": "transmission_error", "name": "error", "driver_encoder": "first", "driven_encoder": "second"}
SPALL = {"kind": "spall", "gear": "pinion", "teeth": 18, "face_length_mm": 15, "profile_length_mm": 2, "depth_mm": 0.2}
SLOW: dict[str, Any] = {
    "dynamics__mesh": {"law": "pairs", "tip_relief_um": 15.0},
    "operating_points": [{"speed_hz": 0.5, "torque_nm": 60.0}],
    "states": {"healthy": {}, "severe": {"damage": SPALL}},
    "fs_hz": 2000.0,
    "duration_s": 0.5,
    **OFF,
}


@pytest.mark.slow
@pytest.mark.parametrize("state", [0, 1])
def test_at_low_speed_it_is_that_of_the_mesh_at_rest(state: int) -> None:
    config = loaded(PINION, GEAR, ERROR, **SLOW)
    found = record(config, state)
    error = found.channels["error_line_of_action"].astype(np.float64)
    static = specimen_state(config.gearbox(0), state).static
    angle = found.labels["start_angle_rad"] + np.pi * np.arange(config.samples) / config.fs_hz
    # pairs at rest under this torque, angle by angle, with what is missing; no loop over time
    rest = 1e6 * static.force_n(60.0) / static.stiffness_n_per_m(60.0, angle * 18 / (2 * np.pi))
    wrong = (error - error.mean() - (rest - rest.mean()))[20:-20]
    assert rest.std() > 1.0
    # what moves the gears grows with the square of the speed: 2 % at 2 Hz
    assert wrong.std() < 0.01 * rest.std()


def test_a_disc_off_its_axis_adds_its_eccentricity_at_the_base_circle() -> None:
    off = {**GEAR, "name": "off", "eccentricity": 1e-3}
    of_off = {**ERROR, "name": "of_off", "driven_encoder": "off"}
    config = loaded(PINION, GEAR, ERROR, off, of_off, duration_s=0.4, **OFF)
    channels = record(config).channels
    added = channels["of_off_line_of_action"].astype(np.float64) - channels["error_line_of_action"]
    radius_um = 1e6 * 0.5 * 3e-3 * 47 * np.cos(np.radians(20.0))
    # an angle that is e/r sin ahead: 4.6 turns, so both extremes are there
    assert 0.5 * np.ptp(added) == pytest.approx(1e-3 * radius_um, rel=1e-3)


def test_encoders_that_are_not_there_or_on_the_other_shaft_are_refused() -> None:
    found = problems(PINION, GEAR, {**ERROR, "driven_encoder": "first"})
    assert found["sensors.error.driven_encoder"] == "'first'; allowed: an encoder at place gear or load: second"
    found = problems(PINION, {**ERROR, "driven_encoder": "third"})
    assert found["sensors.error.driven_encoder"].endswith("gear or load: none there is; add one")
    found = problems(PINION, {**GEAR, "pulses_per_turn": 0}, ERROR)
    assert list(found) == ["sensors.second.pulses_per_turn"]
