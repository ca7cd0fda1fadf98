"""Root mean square of a signal, about zero."""

from __future__ import annotations

import numpy as np


def rms(signal: np.ndarray) -> float:
    """Return sqrt(mean(x^2)) in the unit of the signal.

    Gaussian: sigma; sine: amplitude / sqrt(2). MATLAB's `gearConditionMetrics` takes it of the synchronous average.
    Source: standard literature.
    """
    return float(np.sqrt(np.mean(np.square(signal))))
