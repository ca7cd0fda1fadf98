"""What the stored samples of a channel look like as bytes, whatever the level of the signal.

A state that went through another converter, another format or another program can be told by it. Source: derived.
"""

from __future__ import annotations

import math

import numpy as np

BYTES = ("converter_step_log2", "odd_share", "longest_run")
MOST_CODES, NEAREST = 2.0**26, 0.01


def sample_bytes(signal: np.ndarray) -> dict[str, float]:
    """Return by name: log2 of the converter's step, share of odd mantissas, longest run of equal samples.

    Parameters
    ----------
    signal : (n,) float
        Samples as they are stored; taken as float32.

    Notes
    -----
    The step is undefined where the samples are no whole multiples of their finest difference. NaN without samples.
    """
    stored = np.ascontiguousarray(signal, dtype="<f4")
    if stored.size < 2:
        return dict.fromkeys(BYTES, math.nan)
    changes = np.flatnonzero(stored[1:] != stored[:-1])
    runs = np.diff(np.concatenate([[-1], changes, [stored.size - 1]]))
    return {
        "converter_step_log2": _step_log2(stored),
        "odd_share": float(np.mean(stored.view("<u4") & 1)),
        "longest_run": float(runs.max()),
    }


def _step_log2(stored: np.ndarray) -> float:
    distinct = np.unique(stored).astype(np.float64)  # float32 sorts in half the time
    if distinct.size < 2:
        return math.nan
    step = float(np.diff(distinct).min())
    if not float(np.abs(distinct).max()) < MOST_CODES * step:
        return math.nan
    codes = stored.astype(np.float64) / step
    return math.log2(step) if float(np.abs(codes - np.round(codes)).mean()) < NEAREST else math.nan
