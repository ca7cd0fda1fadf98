"""NA4: fourth moment of the residual signal over the squared mean variance of the machine's records so far."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np


def na4(residuals: Sequence[np.ndarray]) -> float:
    """Return N sum (r_M - mean)^4 / {(1/M) sum_j sum (r_j - mean)^2}^2 of the last record.

    Parameters
    ----------
    residuals : sequence of (n,) float64
        Residual signals (average without shaft orders and mesh harmonics, sidebands kept) of one machine in
        chronological order, the last one judged; simulated states of one specimen stand in order of severity.

    Notes
    -----
    With one record: the kurtosis of the residual (Gaussian 3, sine 1.5). Unlike kurtosis it grows with the level of the
    residual against the history. MATLAB's `gearConditionMetrics` takes the residual in chronological order too. NaN
    where no record varies. Source: Zakrajsek, Townsend & Decker 1993.
    """
    fourth, second = zip(*(central_moments(residual) for residual in residuals), strict=True)
    return na4_of_moments(fourth[-1], second)


def na4_of_moments(fourth: float, history: Sequence[float]) -> float:
    """Return mu_4 / mean(mu_2 of the history)^2; NaN where that mean is zero or anything is undefined.

    Parameters
    ----------
    fourth : float
        Fourth central moment of the record that is judged.
    history : sequence of float
        Variances of the records up to and including it (NA4), or of those that may count as healthy (NA4*).
    """
    variance = float(np.mean(np.asarray(history, dtype=np.float64))) if len(history) else math.nan
    return fourth / variance**2 if variance > 0.0 else math.nan


def central_moments(signal: np.ndarray) -> tuple[float, float]:
    """Return the fourth and the second central moment."""
    squared = np.square(signal - signal.mean())
    return float(np.mean(squared * squared)), float(np.mean(squared))
