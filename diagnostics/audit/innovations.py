"""Averaged lines behind the inverse of their own path: what happens at a tooth stands where it happened.

The path to the sensor smears an event over the pitches behind it. A filter of minimum phase with the size of the
record's own lines takes that back, blindly; what is left ("innovations") has a flat spectrum. Source: minimum phase by
the folded cepstrum (Oppenheim and Schafer), standard literature. Somebody who had not read this audit found that
filters of zero phase, which leave the smear, tell far less.
"""

from __future__ import annotations

import numpy as np

AROUND = 5
"""Lines whose mean power is the size of the path at one of them."""
PITCHES = 2.0
"""How long the path rings at most: longer quefrencies are left to the teeth."""
TINY = 1e-30


def innovations(lines: np.ndarray, teeth: np.ndarray) -> np.ndarray:
    """Return lines behind the inverse of a filter of minimum phase that has their size.

    Parameters
    ----------
    lines : (records, channels, orders) complex128
        Residual lines; those that are zero do not count. Records without lines, or with NaN, stay as they are.
    teeth : (records,) int
        Of the shaft that was averaged.

    Returns
    -------
    (records, channels, orders) complex128
        Zero where `lines` are.
    """
    found = np.array(lines)
    usable = np.isfinite(lines).all(axis=(1, 2)) & (np.abs(lines) > 0.0).any(axis=2).all(axis=1)
    for row in np.flatnonzero(usable).tolist():
        found[row] = lines[row] / _path(lines[row], int(teeth[row]))
    return found


def _path(lines: np.ndarray, teeth: int) -> np.ndarray:
    """Return the filter of one record, (channels, orders) complex128."""
    from scipy import fft
    from scipy.ndimage import convolve1d  # a running mean would carry the rounding of strong lines to weak ones

    even = np.full(AROUND, 1.0 / AROUND)
    counted = convolve1d((np.abs(lines) > 0.0).astype(np.float64), even, axis=-1)
    power = convolve1d(np.square(np.abs(lines)), even, axis=-1)
    order, steps = np.arange(lines.shape[-1]), 2 * (lines.shape[-1] - 1)
    size = np.empty(lines.shape)
    for channel, share in enumerate(counted):
        known = share > 0.5 / AROUND
        size[channel] = np.interp(order, order[known], power[channel, known] / share[known])
    place, longest = np.arange(steps), PITCHES * steps / teeth
    folded = np.where((place > 0) & (place <= longest), 0.5 + 0.5 * np.cos(np.pi * place / (longest + 1.0)), 0.0)
    folded[0] = 0.5
    return np.asarray(np.exp(fft.rfft(fft.irfft(np.log(size + TINY), steps, axis=-1) * folded, axis=-1)))
