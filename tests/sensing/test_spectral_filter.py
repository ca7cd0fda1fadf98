from __future__ import annotations

import numpy as np
import pytest

from siggen.sensing.modal_path import housing_modes, modal_accelerance
from siggen.sensing.spectral_filter import filter_length, frequencies, record_of, record_spectrum

FS = 51200.0


def test_a_response_that_is_applied_is_the_response_that_was_given() -> None:
    history, samples = 5120, 20480
    length = filter_length(history, samples)
    grid = frequencies(length, FS)
    bins = np.arange(200, 8000, 650)
    rng = np.random.default_rng(2)
    given = rng.standard_normal(bins.size) + 1j * rng.standard_normal(bins.size)
    response = np.zeros(grid.size, dtype=complex)
    response[bins] = given
    t = np.arange(length) / FS
    force = sum(np.cos(2 * np.pi * grid[b] * t + 0.3 * b) for b in bins)
    spectrum = record_spectrum(force[:-samples], force[-samples:], length)
    output = record_of(spectrum * response, length, samples)
    turns = np.exp(1j * (2 * np.pi * np.outer(grid[bins], t[-samples:]) + 0.3 * bins[:, None]))
    expected = (given[:, None] * turns).real.sum(axis=0)
    np.testing.assert_allclose(output, expected, atol=1e-9)


def test_the_start_of_a_record_shows_no_transient() -> None:
    """The record begins as the end of a much longer one does, filtered with all of its past."""
    modes = housing_modes(np.array([320.0, 2000.0]), np.array([0.012, 0.02]), lowest_mass_kg=20.0, exponent=2.0)
    rng = np.random.default_rng(4)
    force = rng.standard_normal(131072) + np.sin(2 * np.pi * 318.7 * np.arange(131072) / FS)

    def filtered(samples: int, history: int) -> np.ndarray:
        length = filter_length(history, samples)
        path = modal_accelerance(modes, np.ones((1, 2)), np.ones(2), frequencies(length, FS))[0]
        given = force[force.size - samples - history :]
        return record_of(record_spectrum(given[:history], given[history:], length) * path, length, samples)

    short, long = filtered(10240, 20480), filtered(10240, 120000)
    # 0.4 s are 9.7 decay times of the lower mode: e^-9.7 = 6e-5 of an amplitude a few times the rms
    assert np.abs(short - long)[:2048].max() < 5e-4 * long.std()


def test_a_record_longer_than_the_filter_is_refused() -> None:
    with pytest.raises(ValueError, match="length"):
        record_spectrum(np.zeros(10), np.zeros(10), 16)


def test_missing_history_is_rest() -> None:
    spectrum = record_spectrum(np.ones(2), np.array([1.0, 1.0]), 8)
    np.testing.assert_allclose(np.fft.irfft(spectrum, 8), 0.0, atol=1e-15)
