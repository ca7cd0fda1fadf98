"""Averages over whole revolutions of either shaft."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from diagnostics.signal.synchronous_average import (
    asynchronous_part,
    hann_weights,
    synchronous_average,
    whole_revolutions,
)

STEPS = 16
PINION, GEAR = 18, 47


def test_one_grid_serves_both_shafts() -> None:
    # 47 pinion revolutions are 18 gear revolutions: what is locked to one shaft cancels exactly in the other's average
    phase = np.arange(47 * PINION * STEPS) / STEPS
    pinion_locked, gear_locked = np.cos(2 * np.pi * 5 * phase / PINION), np.cos(2 * np.pi * 7 * phase / GEAR)
    pinion = synchronous_average(pinion_locked + gear_locked, PINION, STEPS)
    gear = synchronous_average(pinion_locked + gear_locked, GEAR, STEPS)
    assert (pinion.revolutions, gear.revolutions) == (47, 18)
    np.testing.assert_allclose(pinion.signal, pinion_locked[: PINION * STEPS], atol=1e-12)
    np.testing.assert_allclose(gear.signal, gear_locked[: GEAR * STEPS], atol=1e-12)


def test_noise_falls_with_the_root_of_the_revolutions() -> None:
    noise = np.random.default_rng(3).standard_normal(100 * PINION * STEPS)
    # 288 samples of the average: their spread is known to 1/sqrt(2 * 288) = 4 %, three of which are allowed
    assert synchronous_average(noise, PINION, STEPS).signal.std() == pytest.approx(0.1, rel=0.13)


def test_droop_of_speed_destroys_an_average_by_nominal_speed_but_not_by_pulses() -> None:
    fs_hz, droop = 12_800.0, 0.0023
    time_s = np.arange(round(fs_hz * 47 / 30.0)) / fs_hz
    turns = 30.0 * (1.0 - droop) * time_s
    signal = np.cos(2 * np.pi * PINION * turns)
    measured = np.arange(0, 47) / (30.0 * (1.0 - droop))
    by_pulses, by_nominal = (
        synchronous_average(
            resample_to_angle(signal, fs_hz, angle_grid(pulses, PINION * 128)), PINION, 128
        ).signal.std()
        for pulses in (measured, np.arange(0, 47) / 30.0)
    )
    assert by_pulses == pytest.approx(np.sqrt(0.5), rel=1e-3)
    # 0.23 % of 46 revolutions of order 18 are 1.9 periods of slip: sinc(1.9) leaves less than a tenth
    assert by_nominal < 0.1


def test_hann_weights_keep_the_lines_of_the_shaft() -> None:
    phase = np.arange(11 * GEAR * STEPS) / STEPS
    weighted = synchronous_average(np.cos(2 * np.pi * 48 * phase / GEAR), GEAR, STEPS, hann=True)
    np.testing.assert_allclose(weighted.signal, np.cos(2 * np.pi * 48 * phase[: GEAR * STEPS] / GEAR), atol=1e-12)


def test_less_than_a_revolution_is_refused() -> None:
    assert whole_revolutions(np.zeros(GEAR * STEPS - 1), GEAR, STEPS) == 0
    with pytest.raises(ValueError, match="one revolution needs 752"):
        synchronous_average(np.zeros(GEAR * STEPS - 1), GEAR, STEPS)


@pytest.mark.parametrize("samples", [1, 2, 7, 2304, 293 * 2304])
def test_hann_weights_are_those_of_one_cosine_per_sample(samples: int) -> None:
    direct = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(samples) / samples)
    found = hann_weights(samples)
    assert found.shape == (samples,)
    assert found.min() >= 0.0
    np.testing.assert_allclose(found, direct, rtol=0.0, atol=1e-15)  # a few roundings of values up to one


@pytest.mark.parametrize("teeth", [(18, 47), (29, 91), (20, 48)])
def test_what_is_locked_to_the_gear_leaves_the_same_in_every_turn_of_it(teeth: tuple[int, int]) -> None:
    # also where steps lie on borders of the 2048 bins, as every third one of 48 teeth does: it has one bin in all turns
    period = teeth[1] * 128
    gear = np.cos(2.0 * np.pi * 5.0 * np.arange(teeth[0] * period) / period)
    rest = asynchronous_part(gear.reshape(teeth[1], -1), teeth).reshape(teeth[0], -1)
    np.testing.assert_allclose(rest, np.broadcast_to(rest[0], rest.shape), atol=1e-12)
    assert 0.0 < np.abs(rest).max() <= 2.0 * np.pi * 5.0 / 2048  # what is left changes within a bin alone
