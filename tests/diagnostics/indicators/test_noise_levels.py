"""Levels of noise follow the noise, and not motion that differs from turn to turn at one angle of the pinion."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.indicators.background_levels import NOISE_LEVELS, noise_levels, quiet_gate
from diagnostics.signal.turn_spectrum import turn_lines

TURNS, STEPS, FS_HZ, SHAFT_HZ = 48, 720, 25_600.0, 35.0
NOISE = np.random.default_rng(1).standard_normal((TURNS, STEPS))
HIGH = range(5, 10)
"""Bands from 1 kHz on, whose medians scatter by 0.2 dB at most."""


def levels(turns: np.ndarray) -> np.ndarray:
    found = noise_levels(turn_lines(turns), np.fft.rfft(turns.ravel()), SHAFT_HZ / TURNS, FS_HZ)
    assert tuple(found) == NOISE_LEVELS
    return np.array([found[NOISE_LEVELS[k]] for k in HIGH])


def strokes(size: float) -> np.ndarray:
    """Ring-downs of 2 ms at 2 and 6 kHz behind one tooth, of a size that is drawn anew for every turn."""
    since_s = (np.arange(STEPS) - 400) % STEPS / (STEPS * SHAFT_HZ)
    ring = np.exp(-since_s / 2e-3) * sum(np.sin(2.0 * np.pi * hz * since_s) for hz in (2000.0, 6000.0))
    return size * np.random.default_rng(2).standard_normal((TURNS, 1)) * np.asarray(ring)


def whole_turn(turns: np.ndarray) -> np.ndarray:
    """Levels of bands as medians over the whole turn."""
    power = np.square(np.abs(np.fft.rfft(turns.ravel())))
    edges = (np.geomspace(100.0, 0.4 * FS_HZ, 11) * TURNS / SHAFT_HZ).astype(int)
    return np.array([10.0 * np.log10(np.median(power[edges[k] : edges[k + 1]])) for k in HIGH])


def test_noise_that_is_louder_by_1_db_lies_1_db_higher_in_all_bands() -> None:
    assert levels(NOISE * 10.0**0.05) - levels(NOISE) == pytest.approx(1.0, abs=1e-9)
    other = np.random.default_rng(3).standard_normal(NOISE.shape)
    assert levels(other) - levels(NOISE) == pytest.approx(0.0, abs=0.7)


def test_white_noise_has_the_level_of_its_density() -> None:
    # density 2 var / (steps * shaft): a one-sided density is twice what |X/n|^2 per Hz holds; median of noise -1.6 dB
    expected = 10.0 * np.log10(0.693 / (STEPS * SHAFT_HZ))
    assert levels(NOISE) == pytest.approx(expected, abs=0.5)


def test_strokes_that_differ_from_turn_to_turn_hardly_count() -> None:
    moved = NOISE + strokes(3.0)
    assert (whole_turn(moved) - whole_turn(NOISE)).max() > 2.0
    assert levels(moved) - levels(NOISE) == pytest.approx(0.0, abs=0.5)


def test_the_open_half_turn_lies_where_all_bands_together_are_weakest() -> None:
    loud = NOISE * np.where(np.arange(STEPS) < STEPS // 2, 3.0, 1.0)
    spectrum = np.fft.rfft(loud.ravel())
    gate = quiet_gate(spectrum, [(TURNS * 50, TURNS * 150), (TURNS * 150, TURNS * 300)], TURNS, STEPS)
    assert np.argmax(gate) == pytest.approx(0.75 * STEPS, abs=STEPS / 16)
    assert gate.max() == pytest.approx(1.0, abs=1e-3)
    assert np.count_nonzero(gate) == pytest.approx(STEPS / 2, abs=1)


def test_a_silent_channel_has_no_level() -> None:
    assert np.isnan(levels(np.zeros((TURNS, STEPS)))).all()
