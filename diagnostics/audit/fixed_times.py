"""What records have in common at fixed times, frequencies and lags, however weak it is beside the gears.

A record starts at any angle of the gears and at any time of the machines near. So the phase of a line against the first
sample is uniform, the lowest bit of a sample is a fair coin, and nothing comes back after a fixed time that is no
period of a shaft: whatever the damage. Each is looked at without the size of the spectrum, under which it lies.

* Phases: lines divided by their own size. Those that most records have at one angle are columns: the part along that
  angle. A waveform below every line adds little to each phase, but alike in thousands of them: products of records.
* Parity: signs of the lowest bits, sample by sample: products of records.
* Components: the leading eigenvectors of products. They are found without states, so all damaged records together give
  one; a ridge regression learns from one state alone.
* Echo: what returns after a lag ripples over the logarithm of the spectrum, which the cepstrum shows (Bogert, Healy and
  Tukey 1963). Lags below 20 ms belong to housings, those near periods of the shafts to the gears.

Source of all else: derived.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from diagnostics.audit.stored_codes import stored_codes

TINY = 1e-30
LONGEST, SCALE, SKIPPED, LOW_PARTS = 1 << 16, 127.0, 4, 64
"""Samples that count, code of a phasor's part of 1, bins at both ends that do not count, and parts of the band.

In the lowest part, below 200 Hz at 25.6 kHz, mains and machines near have their lines: lines there are chosen twice.
"""

KEPT, COMPONENTS, PIECE, PER_DEVIATION = 6, 3, 4096, 8.0
"""Lines or lags that are columns, eigenvectors of a product, codes multiplied at once, and codes per deviation."""

FIRST_LAG_S, NEAR_PERIOD, AROUND_SAMPLES, AROUND_BINS = 0.02, 0.003, 3, 128
"""Least lag, share of it and samples around periods of shafts that do not count, and bins of a median."""

LOW, HIGH = -2.0, 1.0
"""Cuts of the logarithm of a spectrum over its median: no line of the gears rules it."""


def phase_codes(signal: np.ndarray) -> np.ndarray:
    """Return the phasors of the bins of samples (n,) float64, real and imaginary part, (2, k) int8."""
    from scipy import fft

    piece = signal[:LONGEST]
    lines = fft.rfft((piece - piece.mean()) * np.hanning(piece.size))[SKIPPED:-SKIPPED]
    lines = lines / (np.abs(lines) + TINY)
    return np.round(SCALE * np.stack([lines.real, lines.imag])).astype(np.int8)


def parity_bits(signal: np.ndarray) -> np.ndarray:
    """Return the lowest bits of the codes of samples (n,) as they are stored, (n / 8,) uint8; none without codes."""
    codes = stored_codes(signal[:LONGEST])
    return np.packbits((codes[: codes.size // 8 * 8] & 1).astype(np.uint8))


def echo_codes(signal: np.ndarray, fs_hz: float, rates_hz: tuple[float, ...]) -> np.ndarray:
    """Return the cepstrum at long lags in codes, eight per standard deviation, (lags,) int8; 0 near periods of shafts.

    Parameters
    ----------
    signal : (n,) float64
    fs_hz : float
        Sampling frequency [Hz].
    rates_hz : tuple of float
        Speeds of the shafts [Hz].
    """
    from scipy import fft

    piece = signal[:LONGEST]
    size = np.log(np.abs(fft.rfft((piece - piece.mean()) * np.hanning(piece.size))) + TINY)
    blocks = size[: size.size // AROUND_BINS * AROUND_BINS].reshape(-1, AROUND_BINS)
    if not len(blocks):
        return np.empty(0, np.int8)
    even = np.clip(blocks - np.median(blocks, axis=1, keepdims=True), LOW, HIGH).ravel()
    # the bins at the end, fewer than a block, count as even ones
    found = fft.irfft(np.append(even - even.mean(), np.zeros(size.size - even.size)), piece.size)
    lags = np.arange(_first_lag(fs_hz), piece.size // 2)
    found = found[lags]
    for rate_hz in rates_hz:
        period = fs_hz / rate_hz
        apart = np.abs(lags - period * np.round(lags / period))
        found[apart <= AROUND_SAMPLES + NEAR_PERIOD * lags] = 0.0
    spread = np.sqrt(np.square(found).sum() / max(np.count_nonzero(found), 1)) + TINY
    return np.asarray(np.round(np.clip(PER_DEVIATION * found / spread, -127.0, 127.0)), dtype=np.int8)


def locked_columns(rows: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Return the part along the common angle of the lines that have most of one, (records,) each, by name.

    Parameters
    ----------
    rows : list of dict of str to (2, k) int8
        By record and channel, as of `phase_codes`; records of another length are left undefined.
    """
    found = {}
    for channel, first in rows[0].items():
        known, held = _of_one_length(rows, channel)
        common = np.zeros(first.shape, np.int64)
        for row in held:
            common += row
        size = np.hypot(*common.astype(np.float64))
        chosen = [np.argsort(-own, kind="stable")[:KEPT] for own in (size, size[: size.size // LOW_PARTS])]
        for line in dict.fromkeys(np.concatenate(chosen).tolist()):
            values = np.full(len(rows), np.nan)
            values[known] = [row[:, line] @ common[:, line] / (SCALE * size[line] + TINY) for row in held]
            share = (line + SKIPPED) / (2.0 * (first.shape[1] + 2 * SKIPPED - 1))
            found[f"phase of {channel} at {share:.5f} of the rate"] = values
    return found


def echo_columns(rows: list[dict[str, np.ndarray]], fs_hz: float) -> dict[str, np.ndarray]:
    """Return the cepstrum at the lags where it is largest on the average, or varies most, (records,) each, by name.

    Parameters
    ----------
    rows : list of dict of str to (lags,) int8
        By record and channel, as of `echo_codes`; records of another length are left undefined.
    fs_hz : float
        Sampling frequency [Hz].
    """
    found = {}
    for channel, first in rows[0].items():
        known, held = _of_one_length(rows, channel)
        total, squares = np.zeros((2, first.size))
        for row in held:
            total += row
            squares += np.square(row, dtype=np.float64)
        ranks = np.abs(total), squares - np.square(total) / len(held)
        chosen = [np.argsort(-rank, kind="stable")[:KEPT] for rank in ranks]
        for lag in dict.fromkeys(np.concatenate(chosen).tolist()):
            values = np.full(len(rows), np.nan)
            values[known] = [row[lag] / PER_DEVIATION for row in held]
            found[f"echo of {channel} after {1e3 * (_first_lag(fs_hz) + lag) / fs_hz:.2f} ms"] = values
    return found


def _of_one_length(rows: list[dict[str, np.ndarray]], channel: str) -> tuple[list[bool], list[np.ndarray]]:
    """Return which records have the length of the first one, and what these have of a channel."""
    known = [row[channel].shape == rows[0][channel].shape for row in rows]
    return known, [row[channel] for row, is_known in zip(rows, known, strict=True) if is_known]


def _first_lag(fs_hz: float) -> int:
    return int(FIRST_LAG_S * fs_hz)


def phase_product(rows: list[np.ndarray]) -> np.ndarray:
    """Return the mean product of the phasors of all pairs of records, (records, records); 0 for shorter ones."""
    return _product([row.ravel() for row in rows], lambda part: part.astype(np.float32) / SCALE)


def parity_product(rows: list[np.ndarray]) -> np.ndarray:
    """Return the mean product of the signs of all pairs of records, (records, records); 0 for shorter ones."""
    return _product(rows, lambda part: 1.0 - 2.0 * np.unpackbits(part, axis=1).astype(np.float32))


def _product(rows: list[np.ndarray], read: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    size = max(row.size for row in rows)
    full = np.flatnonzero([row.size == size for row in rows])
    total = np.zeros((full.size, full.size))
    for start in range(0, size, PIECE):
        part = read(np.stack([rows[row][start : start + PIECE] for row in full.tolist()]))
        total += part @ part.T
    found = np.zeros((len(rows), len(rows)))
    found[np.ix_(full, full)] = total / max(size, 1)
    return found


def component_columns(products: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the leading eigenvectors of products (records, records), by what they are of, (records,) each."""
    from scipy.linalg import eigh

    found: dict[str, np.ndarray] = {}
    for what, product in products.items():
        if product.any():
            last = len(product) - 1
            _, vectors = eigh(product, subset_by_index=[max(last - COMPONENTS + 1, 0), last])
            found |= {f"component {k + 1} of {what}": own for k, own in enumerate(vectors.T[::-1])}
    return found
