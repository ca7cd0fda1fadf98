"""What is alike in records at the same time after their first sample: fixed tones, one stretch of noise, swings.

Records start at a random angle, so on the average over records a machine adds nothing to a sample, however damaged. A
spectrum is divided by its own floor, since strong lines would hide what is alike, and cut where lines stand out. Four
parts of it, of two octaves each but the lowest, are products of their own: one tone is lost among all lines. The course
of the level is the power of 64 parts of the record in decibels, less their mean. Source: derived.
"""

from __future__ import annotations

from functools import partial
from itertools import pairwise

import numpy as np

from diagnostics.judging.evaluation import Entry
from diagnostics.judging.learners import GroupRidge

TEMPLATES = "templates"
SAMPLES, AROUND = 16384, 32
LARGEST, CODES = 4.0, 31.0
"""Times its floor up to which a line counts, and codes per floor: a byte holds them."""

PARTS = 64
BANDS = (0, 1 / 64, 1 / 16, 1 / 4, 1)
"""Edges of the parts of a spectrum, in shares of half the rate."""

TINY = 1e-30


def whitened_codes(signal: np.ndarray) -> np.ndarray:
    """Return the spectrum of the first samples (n,) over its floor, real and imaginary part, (2, k) int8."""
    from scipy import fft

    piece = signal[:SAMPLES]
    lines = fft.rfft((piece - piece.mean()) * np.hanning(piece.size))[1:]
    lines = lines[: lines.size // AROUND * AROUND].reshape(-1, AROUND)
    floor = np.sqrt(np.median(np.square(np.abs(lines)), axis=1, keepdims=True) / np.log(2.0)) + TINY
    over = lines / floor
    over /= np.maximum(np.abs(over) / LARGEST, 1.0)
    return np.round(CODES * np.stack([over.real, over.imag])).astype(np.int8).reshape(2, -1)


def level_course(signal: np.ndarray) -> np.ndarray:
    """Return the level of equal parts of a record (n,) less its mean, (64,) float32 [dB]."""
    size = signal.size // PARTS
    if not size:
        return np.zeros(PARTS, np.float32)
    power = np.square(signal[: size * PARTS] - signal.mean()).reshape(PARTS, size).mean(axis=1)
    decibels = 10.0 * np.log10(power + TINY)
    return np.asarray(decibels - decibels.mean(), dtype=np.float32)


def template_products(codes: list[np.ndarray], courses: list[np.ndarray]) -> dict[str, np.ndarray]:
    """Return the products of all pairs of records, (records, records), by what they are of.

    Parameters
    ----------
    codes : (records) of (2 channels, k) int8
        Zero is put for records that are shorter than the longest.
    courses : (records) of (channels * 64,) float32
    """
    size, found = max(row.shape[1] for row in codes), {}
    rows = np.flatnonzero([row.shape[1] == size for row in codes])
    for low, high in pairwise(round(edge * size) for edge in BANDS):
        part = np.stack([codes[row][:, low:high].ravel() for row in rows.tolist()]).astype(np.float32) / CODES
        product = np.zeros((len(codes), len(codes)))
        product[np.ix_(rows, rows)] = part @ part.T / max(part.shape[1], 1)
        found[f"spectra, lines {low} to {high}"] = product
    every = np.stack(courses).astype(np.float64)
    return {**found, "courses of the level": every @ every.T}


def template_attackers(products: dict[str, np.ndarray]) -> list[Entry]:
    """Return the attackers on products of all pairs of records, (records, records) each, by what they are of."""
    return [
        Entry(f"{TEMPLATES} of {what}", partial(GroupRidge, own), np.arange(len(own)), np.diagonal(own) > 0.0, len(own))
        for what, own in products.items()
        if own.any()
    ]
