"""What the stored samples of a channel look like as bytes, whatever the level of the signal.

A state that went through another converter, another format or another program can be told by it. Source: derived.
"""

from __future__ import annotations

import math

import numpy as np

BYTES = ("converter_step_log2", "longest_run")
MOST_CODES, NEAREST = 2.0**26, 0.01
FIRST = 16384
"""Samples of a signal without steps, of which some differ by less than the largest over 2^26."""


def sample_bytes(signal: np.ndarray) -> dict[str, float]:
    """Return by name: log2 of the converter's step, longest run of equal samples.

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
    return {"converter_step_log2": _step_log2(stored), "longest_run": _longest_run(stored)}


def _longest_run(stored: np.ndarray) -> float:
    held = np.flatnonzero(stored[1:] == stored[:-1])
    ends = np.flatnonzero(np.diff(held, append=stored.size + 1) > 1)
    return 1.0 + float(np.diff(ends, prepend=-1).max(initial=0))


def _step_log2(stored: np.ndarray) -> float:
    # sorting is dear: the first samples bound the step from above, and show it where all are multiples of their step
    step = _finest_difference(stored[:FIRST])
    if not _reaches(stored, step):
        return math.nan
    if math.frexp(step)[0] != 0.5 or _off_codes(stored, step).any():
        step = _finest_difference(stored)
    if math.isinf(step) or not _reaches(stored, step):
        return math.nan
    return math.log2(step) if float(_off_codes(stored, step).mean()) < NEAREST else math.nan


def _finest_difference(stored: np.ndarray) -> float:
    """Return the smallest difference of two samples that differ; infinite without such."""
    distinct = np.unique(stored).astype(np.float64)  # float32 sorts in half the time
    return float(np.diff(distinct).min(initial=math.inf))


def _reaches(stored: np.ndarray, step: float) -> bool:
    """Return whether a float32 could hold these samples as multiples of the step."""
    return max(float(stored.max()), -float(stored.min())) < MOST_CODES * step


def _off_codes(stored: np.ndarray, step: float) -> np.ndarray:
    """Return how far samples lie from multiples of the step, in steps; of powers of two without rounding."""
    codes = stored.astype(np.float64)
    codes /= step
    codes -= np.round(codes)
    return np.abs(codes, out=codes)
