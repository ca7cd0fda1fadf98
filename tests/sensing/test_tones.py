from __future__ import annotations

import numpy as np
import pytest

from siggen.sensing.tones import Lines, harmonic_lines, lines_signal

FS = 51200.0


def test_lines_are_cosines_from_any_sample_on() -> None:
    lines = Lines(np.array([25.3, 4321.0]), np.array([2.0, 0.5]), np.array([0.3, -2.0]))
    t = np.arange(7, 51200) / FS
    expected = sum(
        a * np.cos(2 * np.pi * f * t + p)
        for f, a, p in zip(lines.frequency_hz, lines.amplitude, lines.phase_rad, strict=True)
    )
    np.testing.assert_allclose(lines_signal(lines, FS, 51193, 7), expected, atol=1e-10)


def test_hum_has_harmonics_that_fall_with_their_number() -> None:
    lines = harmonic_lines(50.0, 0.3, 3, np.random.default_rng(2))
    hum = lines_signal(lines, FS, 51200)
    spectrum = np.abs(np.fft.rfft(hum)) * 2.0 / 51200
    np.testing.assert_allclose(spectrum[[50, 100, 150]], [0.3, 0.15, 0.1], rtol=1e-9)
    assert hum.std() == pytest.approx(lines.rms, rel=1e-9)


def test_lines_beyond_the_band_are_left_out() -> None:
    assert not lines_signal(Lines(np.array([25600.0, 40000.0]), np.ones(2), np.zeros(2)), FS, 51200).any()
