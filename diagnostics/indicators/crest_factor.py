"""Crest factor of a signal: largest magnitude over rms."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.rms import rms


def crest_factor(signal: np.ndarray) -> float:
    """Return max |x| / rms(x); NaN for a signal of zeros.

    Sine: sqrt(2). MATLAB's `gearConditionMetrics` takes it of the synchronous average. Source: standard literature.
    """
    level = rms(signal)
    return float(np.abs(signal).max()) / level if level > 0.0 else math.nan
