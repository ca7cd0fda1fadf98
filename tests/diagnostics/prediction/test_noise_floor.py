"""The spectral density between the lines is that of Welch's method, by the computation of scipy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import welch

from diagnostics.prediction.noise_floor import SEGMENT_S, spectral_density


@pytest.mark.parametrize(("samples", "fs_hz"), [(40_000, 12_800.0), (3_000, 12_800.0), (20_001, 10_001.0)])
def test_the_density_is_that_of_scipy(samples: int, fs_hz: float) -> None:
    signal = 5.0 + np.random.default_rng(1).standard_normal(samples)
    found = spectral_density(signal, fs_hz)
    expected = welch(signal, fs_hz, nperseg=min(samples, round(SEGMENT_S * fs_hz)))
    np.testing.assert_allclose(found[0], expected[0], rtol=1e-12)
    np.testing.assert_allclose(found[1], expected[1], rtol=1e-9, atol=1e-9 * expected[1].max())
