"""Complex order lines of averaged revolutions without shaft and mesh orders, as arrays over records and channels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

SHAFT_ORDERS = 8
"""Orders 0 ... 8 are no residual: couplings and rotors press there, up to 4x, and no tooth.

`diagnostics.signal.difference_signal` leaves out 0 to 2, as the toolboxes do. There a strong 3x of a coupling changes
every share of energy.
"""

WHITENING_ORDERS = 10
"""Lines on each side whose median size a line is divided by."""


def line_array(waveforms: Sequence[Sequence[np.ndarray]]) -> np.ndarray:
    """Return averaged waveforms as one array.

    Parameters
    ----------
    waveforms : (records) of (channels) of (orders,) complex64
        Lines from order 0 on, of different numbers; an empty one was not measured.

    Returns
    -------
    (records, channels, orders) complex128
        Zero above the last line of a record, NaN where nothing was measured.
    """
    most = max((lines.size for row in waveforms for lines in row), default=0)
    found = np.zeros((len(waveforms), len(waveforms[0]) if waveforms else 0, max(most, 1)), dtype=np.complex128)
    for record, row in enumerate(waveforms):
        for channel, lines in enumerate(row):
            found[record, channel, : lines.size] = lines
            if lines.size == 0:
                found[record, channel] = np.nan
    return found


def residual_lines(lines: np.ndarray, teeth: np.ndarray) -> np.ndarray:
    """Return lines without shaft orders 0 to 8 and without all mesh harmonics; sidebands stay.

    Parameters
    ----------
    lines : (records, channels, orders) complex128
        As of `line_array`.
    teeth : (records,) int
        Teeth of the shaft that was averaged.
    """
    order = np.arange(lines.shape[-1])
    left_out = (order <= SHAFT_ORDERS) | (order[None, :] % np.asarray(teeth)[:, None] == 0)
    return np.asarray(np.where(left_out[:, None, :], 0.0, lines))


def whitened(lines: np.ndarray) -> np.ndarray:
    """Return lines divided by the median size of the lines around them, so that all orders count alike.

    Parameters
    ----------
    lines : (records, channels, orders) complex128
        Residual lines; those that are zero stay zero and do not count in the medians.
    """
    size = np.abs(lines)
    counted = np.where(size > 0.0, size, np.nan)
    pad = [(0, 0)] * (lines.ndim - 1) + [(WHITENING_ORDERS, WHITENING_ORDERS)]
    around = np.lib.stride_tricks.sliding_window_view(
        np.pad(counted, pad, constant_values=np.nan), 2 * WHITENING_ORDERS + 1, axis=-1
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        ordered = np.sort(around, axis=-1)  # NaN last
        count = np.isfinite(ordered).sum(axis=-1)
        middle = np.take_along_axis(ordered, np.maximum(count // 2, 0)[..., None].clip(0, ordered.shape[-1] - 1), -1)
        return np.where(size > 0.0, lines / middle[..., 0], lines)
