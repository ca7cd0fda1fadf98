"""Lines of an averaged revolution without those of shafts and meshes, and behind the inverse of their path.

The path to the sensor smears an event over the pitches behind it. A filter of minimum phase with the size of the
record's own lines takes that back, blindly; what is left ("innovations") has a flat spectrum. Source: minimum phase by
the folded cepstrum (Oppenheim and Schafer), standard literature. Somebody who had not read the audit found that filters
of zero phase, which leave the smear, tell far less.
"""

from __future__ import annotations

import numpy as np

TINY = 1e-30

SHAFT_ORDERS = 8
"""Orders 0 ... 8 are no residual: couplings and rotors press there, up to 4x, and no tooth.

`diagnostics.signal.shaft_signals` leaves out 0 to 2, as the toolboxes do. There a strong 3x of a coupling changes
every share of energy.
"""

AROUND = 5
"""Lines whose mean power is the size of the path at one of them."""
PITCHES = 2.0
"""How long the path rings at most: longer quefrencies are left to the teeth."""


def residual_lines(lines: np.ndarray, teeth: np.ndarray) -> np.ndarray:
    """Return lines without shaft orders 0 to 8 and without all mesh harmonics; sidebands stay.

    Parameters
    ----------
    lines : (records, channels, orders) complex128
        From order 0 on.
    teeth : (records,) int
        Teeth of the shaft that was averaged.
    """
    order = np.arange(lines.shape[-1])
    left_out = (order <= SHAFT_ORDERS) | (order[None, :] % np.asarray(teeth)[:, None] == 0)
    return np.asarray(np.where(left_out[:, None, :], 0.0, lines))


def innovations(lines: np.ndarray, teeth: np.ndarray, of: np.ndarray | None = None) -> np.ndarray:
    """Return lines behind the inverse of a filter of minimum phase that has their size, or that of others.

    Parameters
    ----------
    lines : (records, channels, orders) complex128
        Residual lines; those that are zero do not count. Channels without lines, or with NaN, stay as they are.
    teeth : (records,) int
        Of the shaft that was averaged.
    of : (records, channels, orders) complex128, optional
        Lines whose path is taken back, such as those of a healthy record; default: the lines themselves.

    Returns
    -------
    (records, channels, orders) complex128
        Zero where `lines` are.
    """
    found, known = np.array(lines), lines if of is None else of
    for row, channel in np.argwhere(measured_channels(known)).tolist():
        found[row, channel] = lines[row, channel] / _path(known[row, channel], int(teeth[row]))
    return found


def measured_channels(lines: np.ndarray) -> np.ndarray:
    """Return which channels hold lines, (records, channels) bool."""
    return np.asarray(np.isfinite(lines).all(axis=-1) & (np.abs(lines) > 0.0).any(axis=-1))


def _path(lines: np.ndarray, teeth: int) -> np.ndarray:
    """Return the filter of one channel of a record, (orders,) complex128."""
    from scipy import fft
    from scipy.ndimage import convolve1d  # a running mean would carry the rounding of strong lines to weak ones

    even = np.full(AROUND, 1.0 / AROUND)
    counted = convolve1d((np.abs(lines) > 0.0).astype(np.float64), even)
    power = convolve1d(np.square(np.abs(lines)), even)
    order, steps, known = np.arange(lines.size), 2 * (lines.size - 1), counted > 0.5 / AROUND
    size = np.interp(order, order[known], power[known] / counted[known])
    place, longest = np.arange(steps), PITCHES * steps / teeth
    folded = np.where((place > 0) & (place <= longest), 0.5 + 0.5 * np.cos(np.pi * place / (longest + 1.0)), 0.0)
    folded[0] = 0.5
    return np.asarray(np.exp(fft.rfft(fft.irfft(np.log(size + TINY), steps) * folded)))
