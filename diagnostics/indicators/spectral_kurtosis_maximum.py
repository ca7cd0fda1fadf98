"""Largest spectral kurtosis of a record over frequency."""

from __future__ import annotations

import math

import numpy as np


def spectral_kurtosis_maximum(spectral_kurtosis: np.ndarray) -> float:
    """Return max SK(f) without the two outermost bins at either end; NaN where no band is defined.

    Parameters
    ----------
    spectral_kurtosis : (k,) float64
        SK over frequency; NaN where a band is empty.

    Notes
    -----
    Stationary Gaussian noise: about 0, a few 2/sqrt(frames) above; impulses raise it. It depends on the frame's length.
    The outermost bins hold the mean and the anti-alias edge, where spectra are real. Source: Antoni 2006.
    """
    inner = spectral_kurtosis[2:-2]
    defined = inner[np.isfinite(inner)]
    return float(defined.max()) if defined.size else math.nan
