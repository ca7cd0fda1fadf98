"""Motor currents: the line of a steady motor, sidebands of an uneven one, and what a motor cannot follow."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.columns.record import RecordFailure
from tests.sensors.runs import line, loaded, record
from tests.sensors.test_encoder import OFF, PERFECT
from tests.simulated import simulate

CLAMP = {"kind": "motor_current", "name": "clamp", "rated_torque_nm": 80.0, "bits": None}
MOTOR = {**PERFECT, "name": "motor", "place": "motor"}
SLIP = 0.03 * 60.0 / 80.0
LINE_HZ = 2 * 30.0 / (1.0 - SLIP)
RIPPLE = {"speed": {"ripple_once": 0.002}}


def test_a_line_of_active_and_magnetising_current_has_a_ripple_once_per_turn_beside_it_by_one_shaft_order() -> None:
    still, moved = (
        record(loaded(CLAMP, MOTOR, duration_s=1.0, variation=variation, **OFF)).channels for variation in ({}, RIPPLE)
    )
    drawn = np.hypot(5.0, 10.0 * 60 / 80)
    assert line(still["clamp_phase_a"], 25_600.0, LINE_HZ) == pytest.approx(drawn, rel=1e-4)
    speed = line(moved["motor_rotation"], 25_600.0, 30.0)
    assert speed == pytest.approx(0.002 * 2 * np.pi * 30.0, rel=0.1)  # the coupling lets the rotor swing by itself too
    slip = 2 * speed / (2 * np.pi * LINE_HZ)
    lag = 30.0 / (LINE_HZ * 0.15)  # shaft frequency over the corner of the torque's lag
    expected = 0.5 * 10.0 / 0.03 * slip / np.hypot(1.0, lag)
    for side_hz in (LINE_HZ - 30.0, LINE_HZ + 30.0):
        assert line(moved["clamp_phase_a"], 25_600.0, side_hz) == pytest.approx(expected, rel=0.01)
        assert line(still["clamp_phase_a"], 25_600.0, side_hz) < 1e-3 * expected


def test_three_phases_sum_to_nothing_but_their_noise() -> None:
    three = {**CLAMP, "axes": ["phase_a", "phase_b", "phase_c"], "floor_a": 0.01}
    channels = record(loaded(three, variation=RIPPLE, **OFF)).channels
    total = sum(channels[f"clamp_phase_{k}"].astype(np.float64) for k in "abc")
    assert np.std(total) == pytest.approx(0.01 * np.sqrt(3.0), rel=0.05)  # 5120 samples: 1 % of a standard deviation


def test_a_speed_that_no_motor_follows_at_one_line_frequency_says_why() -> None:
    config = loaded(CLAMP, variation={"speed": {"start_ratio": 0.5}}, **OFF)
    (failure,) = simulate(config, [0])
    assert isinstance(failure, RecordFailure)
    assert "sensor clamp: the slip would pass 0.15" in failure.reason
