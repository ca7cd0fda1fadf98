"""Lines of raw records that come from no gear: at one frequency in all records, beside the orders of the shafts.

A line is a bin over the median of the bins around it, up to the last one below half the rate. Bins near an order of a
shaft do not count where orders stand out. Of the others those count that stand highest, or vary most, over all records
of the set: a line of one frequency in gearboxes of all speeds comes from no gear. Source: derived.
"""

from __future__ import annotations

import numpy as np

from diagnostics.records.recording import Recording

AROUND, POOLED, KEPT_LINES = 80, 8, 12
"""Bins whose median a bin is divided by, bins of which the highest is kept, and frequencies that are columns, twice."""

LOW_AROUND = 16
"""In place of `AROUND` where the floor falls with frequency: below the 80th bin. Of the first 16 none counts."""

NEAR_ORDER_BINS, REGION, STANDING = 2, 640, 1.5
"""Orders hide lines only in regions of so many bins where the median beside them is 1.5 times that of the others."""

TINY = 1e-30


def shaft_rates_hz(record: Recording) -> tuple[float, ...]:
    """Return the mean speeds of the first two shafts [Hz] by the pulses; none with fewer than two pulses."""
    pulses = np.asarray(record.tacho_s, dtype=np.float64)
    if pulses.size < 2 or not pulses[-1] > pulses[0]:
        return ()
    first, (driver, driven) = float((pulses.size - 1) / (pulses[-1] - pulses[0])), record.teeth
    return first, first * driver / driven


def line_contrast(signal: np.ndarray, fs_hz: float, rates_hz: tuple[float, ...]) -> np.ndarray:
    """Return how far lines stand over the median of the bins around them, (bins / 8,) float32 [dB].

    Parameters
    ----------
    signal : (n,) float64
    fs_hz : float
        Sampling frequency [Hz].
    rates_hz : tuple of float
        Speeds of the shafts [Hz], near whose multiples nothing counts where these stand out: 0 dB there.
    """
    from scipy import fft

    power = np.square(np.abs(fft.rfft((signal - signal.mean()) * np.hanning(signal.size))))[:-1]
    whole = power.size // AROUND * AROUND
    if not whole:
        return np.empty(0, np.float32)
    low, blocks = power[:AROUND].reshape(-1, LOW_AROUND), power[:whole].reshape(-1, AROUND)
    # the last bins belong to the block before them
    floor = np.append(np.repeat(np.median(blocks, axis=1), AROUND), np.full(power.size - whole, np.median(blocks[-1])))
    floor[:AROUND] = np.repeat(np.median(low, axis=1), LOW_AROUND)
    decibels = 10.0 * np.log10((power + TINY) / (floor + TINY))
    decibels[:LOW_AROUND] = 0.0
    for rate_hz in rates_hz:
        decibels[near_orders(power / (floor + TINY), rate_hz * signal.size / fs_hz)] = 0.0
    padded = np.append(decibels, np.zeros(-power.size % POOLED))
    return np.asarray(padded.reshape(-1, POOLED).max(axis=1), dtype=np.float32)


def near_orders(ratio: np.ndarray, spacing: float) -> np.ndarray:
    """Return the bins near multiples of a spacing, where such bins stand above the others of their region.

    Parameters
    ----------
    ratio : (k,) float64
        Power over its median around.
    spacing : float
        Bins between two orders.
    """
    bins = np.arange(ratio.size)
    apart = np.abs(bins - spacing * np.round(bins / spacing))
    found = apart <= NEAR_ORDER_BINS
    for start in range(0, ratio.size, REGION):
        part = slice(start, start + REGION)
        on, off = (ratio[part][side[part]] for side in (apart <= 1.0, ~found))
        if on.size and off.size and np.median(on) <= STANDING * np.median(off):
            found[part] = False
    return found


def line_columns(rows: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Return the contrast at the frequencies that stand highest on the average, or vary most, by channel.

    Parameters
    ----------
    rows : list of dict of str to (k,) float32
        By record and channel, as of `line_contrast`; records of another length are left undefined.
    """
    found = {}
    for channel, first in rows[0].items():
        every = np.full((len(rows), first.size), np.nan, dtype=np.float32)
        for place, row in enumerate(rows):
            if row[channel].size == first.size:
                every[place] = row[channel]
        known = every[np.isfinite(every).all(axis=1)]
        chosen = [np.argsort(-rank, kind="stable")[:KEPT_LINES] for rank in (known.mean(axis=0), known.std(axis=0))]
        for k in dict.fromkeys(np.concatenate(chosen).tolist()):
            share = (k + 0.5) / first.size / 2.0
            found[f"line of {channel} at {share:.4f} of the rate"] = every[:, k].astype(np.float64)
    return found
