"""Central moments of a signal over powers of its variance."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.kurtosis import UNDEFINED_BELOW


def normalised_moment(signal: np.ndarray, order: int, reference_rms: float | None = None) -> float:
    """Return mu_k / mu_2^(k/2); NaN ("undefined") where the signal does not vary.

    Parameters
    ----------
    signal : (n,) float64
        Signal.
    order : int
        k, even.
    reference_rms : float, optional
        A standard deviation below 1e-9 of it is numerical dust. Default: the rms of the signal.

    Notes
    -----
    k = 4, 6, 8: Gaussian 3, 15, 105; sine 1.5, 2.5, 4.375. Source: standard literature.
    """
    centred = signal - signal.mean()
    deviation = math.sqrt(float(np.mean(centred * centred)))
    reference = math.sqrt(float(np.mean(signal * signal))) if reference_rms is None else reference_rms
    if not deviation > UNDEFINED_BELOW * reference:
        return math.nan
    scaled = centred / deviation
    return float(np.mean((scaled * scaled) ** (order // 2)))
