from __future__ import annotations

import numpy as np
import pytest

from siggen.sensing.tones import Lines, carrier_lines, harmonic_lines, lines_signal, single_lines

FS = 51200.0


def flat(lines: Lines, samples: int = 51200) -> np.ndarray:
    return lines_signal(lines, np.ones(lines.frequency_hz.size, dtype=complex), FS, samples)


def test_lines_are_cosines_behind_a_filter() -> None:
    lines = single_lines(np.array([25.3, 4321.0]), np.array([2.0, 0.5]), np.random.default_rng(1))
    response = np.array([0.5j, -2.0])
    t = np.arange(51200) / FS
    expected = sum(
        (a * h * np.exp(1j * (2 * np.pi * f * t + p))).real
        for f, a, p, h in zip(lines.frequency_hz, lines.amplitude, lines.phase_rad, response, strict=True)
    )
    np.testing.assert_allclose(lines_signal(lines, response, FS, 51200), expected, atol=1e-10)


def test_hum_has_harmonics_that_fall_with_their_number() -> None:
    lines = harmonic_lines(50.0, 0.3, 3, np.random.default_rng(2))
    spectrum = np.abs(np.fft.rfft(flat(lines))) * 2.0 / 51200
    np.testing.assert_allclose(spectrum[[50, 100, 150]], [0.3, 0.15, 0.1], rtol=1e-9)
    assert flat(lines).std() == pytest.approx(lines.rms, rel=1e-9)


def test_a_carrier_has_sidebands_at_twice_the_electrical_frequency() -> None:
    lines = carrier_lines(4000.0, 50.0, 1.0, 2, np.random.default_rng(2))
    spectrum = np.abs(np.fft.rfft(flat(lines))) * 2.0 / 51200
    np.testing.assert_allclose(spectrum[[3800, 3900, 4000, 4100, 4200]], [1 / 3, 1 / 2, 1.0, 1 / 2, 1 / 3], rtol=1e-9)


def test_lines_beyond_the_band_are_left_out() -> None:
    assert not flat(single_lines(np.array([25600.0, 40000.0]), np.ones(2), np.random.default_rng(0))).any()
