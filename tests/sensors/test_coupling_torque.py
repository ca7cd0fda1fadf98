"""Torque sensors: the transmitted torque, the balance of the motor, and couplings that a model has not."""

from __future__ import annotations

import numpy as np
import pytest

from tests.sensors.runs import loaded, problems, record
from tests.sensors.test_encoder import OFF, PERFECT

INPUT = {"kind": "coupling_torque", "name": "input", "range_nm": 1e4, "bits": None}
OUTPUT = {**INPUT, "name": "output", "place": "output_coupling"}
MOTOR = {**PERFECT, "name": "motor", "place": "motor"}
INERTIA = 0.02


def test_it_is_what_the_motor_gives_less_what_its_rotor_takes() -> None:
    config = loaded(INPUT, MOTOR, dynamics__motor_inertia_kg_m2=INERTIA, **OFF)
    channels = record(config).channels
    speed = channels["motor_rotation"].astype(np.float64)
    # the speed holds over the intervals about samples: its difference over two of them is centred at a sample
    accelerations = (speed[2:] - speed[:-2]) * config.fs_hz / 2.0
    wrong, true = (
        np.abs(np.fft.rfft((values - values.mean())[40:-40] * np.hanning(values.size - 80)))
        for values in (channels["input_rotation"][1:-1] - (60.0 - INERTIA * accelerations), channels["input_rotation"])
    )
    low = slice(0, true.size // 20)
    # to a fortieth of fs both differences lose 2 % at its end, (2π/40)² (1/6 + 1/24), and the lines are below it
    assert np.linalg.norm(wrong[low]) < 0.01 * np.linalg.norm(true[low])


def test_its_mean_is_the_transmitted_torque() -> None:
    channels = record(loaded(INPUT, OUTPUT, **OFF)).channels
    # over 6 turns, no whole number of what vibrates
    assert channels["input_rotation"].mean() == pytest.approx(60.0, rel=1e-3)
    assert channels["output_rotation"].mean() == pytest.approx(60.0 * 47 / 18, rel=1e-3)


def test_noise_range_and_bits_are_those_of_every_sensor() -> None:
    noisy = {**INPUT, "name": "noisy", "floor_nm": 0.5, "bits": 16, "range_nm": 1000.0}
    found = record(loaded(INPUT, noisy, {**INPUT, "name": "small", "range_nm": 60.0}, **OFF))
    assert found.labels["noise_floor_noisy_rotation_nm"] == 0.5
    added = found.channels["noisy_rotation"].astype(np.float64) - found.channels["input_rotation"]
    assert np.std(added) == pytest.approx(0.5, rel=0.05)  # 5120 samples: 1 % of a standard deviation
    steps = found.channels["noisy_rotation"] * 2.0**5  # 2000/2^16, to the power of two above
    np.testing.assert_array_equal(steps, np.round(steps))
    assert found.channels["small_rotation"].max() == 60.0
    assert found.labels["clipped_share_small_rotation"] > 0.0


def test_a_coupling_that_the_model_has_not_is_refused() -> None:
    assert "input_coupling, output_coupling" in problems({**INPUT, "place": "pinion"})["sensors.input.place"]
