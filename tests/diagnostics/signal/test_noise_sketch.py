"""Sketches of noise tell twins of the noise from records that meet the gear at one angle."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.signal.noise_sketch import noise_sketch
from diagnostics.signal.order_domain import angle_grid, resample_to_angle

TEETH, FS_HZ, PINION_HZ, PER_TOOTH = (18, 47), 12_800.0, 12.0, 128
ACCUSED = 0.3
"""As of the audit."""


def sketch(noise: np.ndarray, gear_turn: float, pinion_turn: float) -> np.ndarray:
    """Return the sketch of a record with lines of the gear's shaft three times as strong as its noise."""
    turns = pinion_turn + PINION_HZ * np.arange(noise.size) / FS_HZ
    orders = np.arange(700, 1390, 2)  # the upper half of the band, which the sketch reads
    phase = np.random.default_rng(5).random(orders.size)
    gear = gear_turn + (turns - pinion_turn) * TEETH[0] / TEETH[1]
    lines = np.cos(2.0 * np.pi * (orders[:, None] * gear + phase[:, None])).sum(axis=0)
    signal = 3.0 * lines / lines.std() + noise
    pulses = (np.arange(np.ceil(turns[0]), np.floor(turns[-1]) + 1.0) - pinion_turn) / PINION_HZ
    grid = angle_grid(pulses, TEETH[0] * PER_TOOTH)
    return noise_sketch(signal, FS_HZ, resample_to_angle(signal, FS_HZ, grid), TEETH, grid)


def likeness(first: np.ndarray, second: np.ndarray) -> float:
    return abs(float(np.vdot(first, second).real)) / first.size


def noise(seed: int, seconds: float) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(round(FS_HZ * seconds))


@pytest.mark.parametrize("seconds", [1.8, 4.0])
def test_gears_that_start_at_one_angle_are_no_twins_and_copied_noise_is(seconds: float) -> None:
    first = sketch(noise(1, seconds), 0.3, 0.1)
    # independent sketches of 1024 phases scatter by 0.03; 0.2 is where the audit sees them end
    assert likeness(first, sketch(noise(2, seconds), 0.3, 0.7)) < 0.2
    # averages over m turns keep 1 - 1/m of a copy: 0.95 times 0.87 at eight turns of the gear
    assert likeness(first, sketch(noise(1, seconds), 0.8, 0.7)) > 2.0 * ACCUSED


def test_four_turns_of_the_gear_suffice_and_three_leave_its_lines() -> None:
    turns_s = TEETH[1] / TEETH[0] / PINION_HZ
    four, three = 4.9 * turns_s, 3.5 * turns_s
    # at four turns 3/4 of a copy are left, of its phases a little less
    assert likeness(sketch(noise(1, four), 0.3, 0.1), sketch(noise(1, four), 0.8, 0.7)) > ACCUSED + 0.2
    assert likeness(sketch(noise(1, four), 0.3, 0.1), sketch(noise(2, four), 0.3, 0.7)) < 0.2
    assert likeness(sketch(noise(1, three), 0.3, 0.1), sketch(noise(2, three), 0.3, 0.7)) > ACCUSED
