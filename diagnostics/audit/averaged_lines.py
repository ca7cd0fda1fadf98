"""Averaged lines of a set as arrays, without shaft and mesh orders, and what detectors take of them.

A local event of a few degrees is spread over all orders. Where healthy residuals are weak or Gaussian, it is their only
outlier, so the band is not known beforehand. Kurtosis of a band: Stewart's FM4 in a band; envelope and dyadic bands:
Antoni and Randall 2006 (kurtogram). The bank is derived.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnostics.signal.innovations import SHAFT_ORDERS

WHITENING_ORDERS = 10
"""Lines on each side whose median size a line is divided by."""

LOWEST_ORDER = SHAFT_ORDERS + 1
STEP = 2.0**0.5
WIDTHS = (1, 2, 3, 4, 6, 8, 12)
"""Widths of bands in steps of half an octave; the last ones hold nearly all orders."""

LOCAL_SHARE = 1.0 / 20.0
"""Part of the revolution over which local energy is averaged: about a pitch of a pinion."""

KURTOGRAM_PARTS = (1, 2, 3, 4, 6, 8, 12, 16)
TINY = 1e-30


def order_bands(highest: int) -> tuple[tuple[int, int], ...]:
    """Return bands of shaft orders (low, high), both included, half an octave to all orders wide.

    Parameters
    ----------
    highest : int
        Highest order that is held.
    """
    edges = [LOWEST_ORDER]
    while edges[-1] < highest:
        edges.append(min(round(LOWEST_ORDER * STEP ** len(edges)), highest))
    if len(edges) > 2 and edges[-1] < 1.1 * edges[-2]:
        edges[-2:] = edges[-1:]
    found = [(edges[k], edges[k + width]) for width in WIDTHS for k in range(len(edges) - width)]
    whole = (edges[0], edges[-1])
    return tuple(dict.fromkeys([*found, whole])) if len(edges) > 1 else ()


def steps_for(orders: int) -> int:
    """Return angle steps, a power of two, that hold the squares of that many orders without folding."""
    return int(2 ** np.ceil(np.log2(max(4 * orders, 8))))


def analytic(lines: np.ndarray, low: int, high: int, steps: int) -> np.ndarray:
    """Return the analytic signal of a band over one revolution, (..., steps) complex128."""
    from scipy import fft

    kept = np.zeros((*lines.shape[:-1], steps), dtype=np.complex128)
    kept[..., low : high + 1] = lines[..., low : high + 1]
    return np.asarray(fft.ifft(kept, axis=-1)) * steps


def band_bank(residual: np.ndarray, reference: np.ndarray | None = None) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return kurtosis, local energy and energy of every band, logarithms each.

    Parameters
    ----------
    residual : (records, channels, orders) complex128
        Residual lines, or their difference from the reference.
    reference : (records, channels, orders) complex128, optional
        Residual lines of the reference; energy is then relative to its energy in the band, else to that of the whole
        residual.

    Returns
    -------
    (records, channels, columns) float64
        NaN where a channel was not measured.
    tuple of str
        What each column is, with its band.
    """
    columns, names = [], []
    every = np.square(np.abs(residual)).sum(axis=-1)
    steps = steps_for(residual.shape[-1])
    for low, high in order_bands(residual.shape[-1] - 1):
        wave = analytic(residual, low, high, steps)
        whole = every if reference is None else np.square(np.abs(reference[..., low : high + 1])).sum(axis=-1)
        energy = np.square(np.abs(residual[..., low : high + 1])).sum(axis=-1)
        columns += [log_kurtosis(wave.real), log_local_energy(wave), np.log10((energy + TINY) / (whole + TINY))]
        names += [f"{what}, orders {low} to {high}" for what in ("kurtosis", "local energy", "energy")]
    found = np.stack(columns, axis=-1) if columns else np.empty((*residual.shape[:-1], 0))
    return np.where(np.isfinite(found), found, np.nan), tuple(names)


def log_kurtosis(wave: np.ndarray) -> np.ndarray:
    """Return log10 of the kurtosis of waves without mean, (..., steps) to (...)."""
    square = np.square(wave)
    return np.asarray(np.log10(np.square(square).mean(axis=-1) / (np.square(square.mean(axis=-1)) + TINY) + TINY))


def log_local_energy(wave: np.ndarray) -> np.ndarray:
    """Return log10 of the largest energy within a twentieth of the revolution over the mean, of analytic signals."""
    power = np.square(wave.real) + np.square(wave.imag)
    width = max(round(LOCAL_SHARE * power.shape[-1]), 1)
    total = np.cumsum(np.concatenate([power, power[..., : width - 1]], axis=-1), axis=-1)
    local = total[..., width - 1 :] - np.concatenate([np.zeros((*power.shape[:-1], 1)), total[..., :-width]], axis=-1)
    return np.asarray(np.log10(local.max(axis=-1) / width / (power.mean(axis=-1) + TINY) + TINY))


def kurtogram_maximum(residual: np.ndarray) -> np.ndarray:
    """Return the largest excess of the envelope's kurtosis over all bands of 1/2-1/3 trees, (records, channels).

    Parameters
    ----------
    residual : (records, channels, orders) complex128
        Residual lines.

    Notes
    -----
    <|e|^4>/<|e|^2>^2 - 2: 0 for Gaussian noise, -1 for a tone. Source: Antoni 2007, on an averaged revolution.
    """
    orders, steps = residual.shape[-1] - LOWEST_ORDER, steps_for(residual.shape[-1])
    found = []
    for parts in KURTOGRAM_PARTS:
        edges = LOWEST_ORDER + np.round(np.linspace(0, orders, parts + 1)).astype(int)
        for low, high in zip(edges[:-1].tolist(), (edges[1:] - 1).tolist(), strict=True):
            if high - low < 4:
                continue
            wave = analytic(residual, low, high, steps)
            power = np.square(wave.real) + np.square(wave.imag)
            found.append(np.square(power).mean(axis=-1) / (np.square(power.mean(axis=-1)) + TINY) - 2.0)
    return np.max(found, axis=0) if found else np.full(residual.shape[:2], np.nan)


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
