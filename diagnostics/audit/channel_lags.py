"""Lag of every channel beside the gearbox's own healthy record: against the tacho, and against the other channels.

A path and a converter delay all mesh lines of a channel alike. Damage of a few teeth changes their size, and their
phase only a little: the lag of the averaged waveform moves by up to a quarter of a sample in severe states. So lags
count in whole samples between channels, and in steps of two against the tacho. Estimated by the largest sum of the mesh
lines' cross spectrum over trial lags. Source: generalised cross-correlation, standard literature; the steps measured.
"""

from __future__ import annotations

import numpy as np

LAGS = "lags"
HARMONICS, LARGEST, TRIALS_PER_SAMPLE = 20, 16, 8
TACHO_STEP = 2.0
"""Step of the lag to the tacho that counts, in samples; between channels it is one sample."""


def sample_lags(lines: np.ndarray, reference: np.ndarray, teeth: int, samples_per_turn: float) -> np.ndarray:
    """Return by how many samples a record lies behind its reference, (channels,); NaN without mesh lines.

    Parameters
    ----------
    lines, reference : (channels, orders) complex
        Averaged revolution of the pinion, from the tacho's pulse on.
    teeth : int
        Of the pinion.
    samples_per_turn : float
    """
    orders = np.arange(1, HARMONICS + 1) * teeth
    orders = orders[orders < lines.shape[-1]]
    across = lines[:, orders] * np.conj(reference[:, orders])
    weighed = across / np.sqrt(np.abs(across) + 1e-30)
    trial = np.arange(-LARGEST * TRIALS_PER_SAMPLE, LARGEST * TRIALS_PER_SAMPLE + 1) / TRIALS_PER_SAMPLE
    turned = np.exp(2j * np.pi * orders[:, None] * trial / samples_per_turn)
    found = trial[np.argmax((weighed @ turned).real, axis=1)]
    return np.where(np.isfinite(across).all(axis=1) & (np.abs(across).sum(axis=1) > 0.0), found, np.nan)


def lag_columns(lags: np.ndarray, channels: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Return lags in steps that count, by name, (records,) each.

    Parameters
    ----------
    lags : (records, channels) float64
        In samples; NaN without a reference.
    channels : tuple of str
    """
    common = np.median(lags, axis=1)
    found = {"lag to the tacho": TACHO_STEP * np.round(common / TACHO_STEP)}
    for first in range(len(channels)):
        for second in range(first + 1, len(channels)):
            apart = np.round(lags[:, first] - lags[:, second])
            found[f"lag of {channels[first]} to {channels[second]}"] = apart
    return found
