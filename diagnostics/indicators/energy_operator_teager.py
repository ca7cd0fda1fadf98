"""Energy operator (Teager): kurtosis of x_i^2 - x_(i-1) x_(i+1)."""

from __future__ import annotations

import numpy as np

from diagnostics.indicators.kurtosis import kurtosis


def teager_energy(signal: np.ndarray) -> np.ndarray:
    """Return x_i^2 - x_(i-1) x_(i+1) of a periodic signal, (n,); of A cos(w i) it is A^2 sin^2(w)."""
    return np.asarray(signal * signal - np.roll(signal, 1) * np.roll(signal, -1))


def energy_operator_teager(residual: np.ndarray) -> float:
    """Return the kurtosis of the Teager energy of a residual signal; NaN where that energy does not vary.

    Parameters
    ----------
    residual : (n,) float64
        One revolution without shaft orders and mesh harmonics; periodic, so that no sample is lost at its ends.

    Notes
    -----
    A single tone has constant energy, so the value is undefined. It depends on the angle steps per revolution. Source:
    Ma 1995; Teager's operator after Kaiser 1990.
    """
    return kurtosis(teager_energy(residual))
