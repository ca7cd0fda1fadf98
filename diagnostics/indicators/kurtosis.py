"""Kurtosis of a signal: fourth central moment over the squared second one."""

from __future__ import annotations

import math

import numpy as np

UNDEFINED_BELOW = 1e-9
"""A standard deviation below this share of the rms of the signal (or of a reference) is numerical dust."""


def kurtosis(signal: np.ndarray, reference_rms: float | None = None) -> float:
    """Return mu_4 / mu_2^2; NaN ("undefined") where the signal does not vary.

    Parameters
    ----------
    signal : (n,) float64
        Raw record, synchronous average or a part of it.
    reference_rms : float, optional
        What "does not vary" is measured by: a standard deviation below 1e-9 of it. Default: the rms of the signal.

    Notes
    -----
    Gaussian: 3; sine: 1.5. MATLAB's `gearConditionMetrics` takes it of the synchronous average. Source: standard
    literature.
    """
    centred = signal - signal.mean()
    squared = centred * centred
    variance = float(squared.mean())
    reference = math.sqrt(float(np.mean(signal * signal))) if reference_rms is None else reference_rms
    if not math.sqrt(variance) > UNDEFINED_BELOW * reference:
        return math.nan
    return float(np.mean(squared * squared)) / variance**2
