"""Modulated noise against the closed forms of its kurtosis, its envelope and its correlation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import hilbert

from siggen.drivetrain.comb import harmonic_sum, turns_of
from siggen.seeding import Stream, generator
from siggen.sensing.modulation import LevelCourse, periodic_course, replayed, shaft_course, shaft_phasors
from siggen.sensing.noise import noise_spectrum

FS, LENGTH = 25600.0, 1 << 21
FREQUENCY = np.arange(LENGTH // 2 + 1) * FS / LENGTH
BAND = np.where((FREQUENCY > 3000.0) & (FREQUENCY < 9000.0), 1.0, 0.0)
"""Noise of 6 kHz: 490,000 independent values, so that Gaussian kurtosis scatters by √(24/490,000) = 0.007."""


def rng(name: int) -> np.random.Generator:
    return generator(5, Stream.BACKGROUND, name)


def noise(drawn: np.random.Generator) -> np.ndarray:
    return np.fft.irfft(BAND * noise_spectrum(1.0, LENGTH, FS, drawn), LENGTH)


def kurtosis(x: np.ndarray) -> float:
    return float((x**4).mean() / (x**2).mean() ** 2)


@pytest.mark.parametrize("std", [0.0, 0.35, 0.64])
def test_a_random_level_raises_kurtosis_and_envelope_variation_as_in_closed_form(std: float) -> None:
    carried = noise(rng(1))
    level = LevelCourse(std, 3e-3 * FS, rng(2)).take(LENGTH)
    # 82 s hold 27,000 independent levels: exp(2 s U) scatters by √((e^(4s²) - 1)/27,000), 1.3 % at s = 0.64
    assert level.mean() == pytest.approx(1.0, abs=0.02)
    signal = carried * np.sqrt(level)
    envelope = np.abs(hilbert(signal))
    assert kurtosis(signal) == pytest.approx(3.0 * np.exp(std**2), rel=0.05)
    variation = (envelope.std() / envelope.mean()) ** 2
    assert variation == pytest.approx(4.0 / np.pi * np.exp(0.25 * std**2) - 1.0, rel=0.03)


def test_the_level_forgets_itself_over_its_time() -> None:
    logarithm = np.log(LevelCourse(0.5, 100.0, rng(3)).take(LENGTH))
    logarithm -= logarithm.mean()
    for lag, expected in ((100, np.exp(-1.0)), (300, np.exp(-3.0))):
        found = (logarithm[lag:] * logarithm[:-lag]).mean() / logarithm.var()
        assert found == pytest.approx(expected, abs=0.04)  # 10,000 independent values


def test_shaft_lines_alone_raise_the_kurtosis_as_in_closed_form() -> None:
    angle = 2.0 * np.pi * 33.0 * np.arange(LENGTH) / FS
    phasors = shaft_phasors(0.3, np.array([0.1, 2.0, 4.0]))
    course = shaft_course([harmonic_sum(turns_of(angle, 1.0), phasors)])
    depths = 0.3 / np.sqrt(np.arange(1.0, 4.0))
    assert course.min() > 0.0
    assert course.mean() == pytest.approx(1.0, abs=1e-3)
    signal = noise(rng(4)) * np.sqrt(course)
    assert kurtosis(signal) == pytest.approx(3.0 * (1.0 + 0.5 * (depths**2).sum()), rel=0.01)
    lines = 2.0 * np.abs((course * np.exp(-1j * np.arange(1, 4)[:, None] * angle)).mean(axis=1))
    np.testing.assert_allclose(lines, depths, rtol=1e-2)  # not a whole number of turns


def test_deep_lines_never_make_a_negative_power() -> None:
    angle = np.linspace(0.0, 20.0, 1000)
    assert shaft_course([harmonic_sum(turns_of(angle, 1.0), shaft_phasors(1.0, np.full(3, np.pi)))]).min() == 0.0


def test_what_is_replayed_returns_every_turn_of_its_shaft_and_a_pitch_every_tooth() -> None:
    angle = np.linspace(-7.0, 90.0, 5000)
    pattern = rng(6).standard_normal(512)
    order = 18 / 47
    found = replayed(angle, order, pattern)
    np.testing.assert_allclose(replayed(angle + 2.0 * np.pi / order, order, pattern), found, atol=1e-9)
    # the table's own points are met exactly
    points = 2.0 * np.pi * np.arange(512) / 512 / order
    np.testing.assert_allclose(replayed(points + 1e-12, order, pattern), pattern, atol=1e-7)
    table = rng(7).random(64)
    over_a_tooth = periodic_course(angle + 2.0 * np.pi / 18, 18, table)
    np.testing.assert_allclose(over_a_tooth, periodic_course(angle, 18, table), atol=1e-9)
