"""Lag of every channel beside the gearbox's own healthy record: against the tacho, and against the other channels.

A path and a converter delay all mesh lines of a channel alike. Damage of a few teeth changes their size, and their
phase only a little: the lag of the averaged waveform moves by up to a quarter of a sample in severe states. So lags
count in whole samples between channels, and in steps of two against the tacho. Estimated by the largest sum of the
mesh lines' cross spectrum over trial lags. How near that sum comes to one of lines that are only delayed counts in
quarters: a record that runs backwards has no such lag. Source: generalised cross-correlation, standard literature; the
steps measured.
"""

from __future__ import annotations

import numpy as np

from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.residual_lines import line_array

LAGS = "lags"
HARMONICS, LARGEST, TRIALS_PER_SAMPLE = 20, 16, 8
TACHO_STEP = 2.0
"""Step of the lag to the tacho that counts, in samples; between channels it is one sample."""

LIKENESS_STEP = 0.25
FINE = 0.1
"""Samples around the largest sum at which a parabola is laid through it."""


def sample_lags(
    lines: np.ndarray, reference: np.ndarray, teeth: int, samples_per_turn: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return by how many samples a record lies behind its reference, and how like it is then, (channels,) each.

    Parameters
    ----------
    lines, reference : (channels, orders) complex
        Averaged revolution of the pinion, from the tacho's pulse on.
    teeth : int
        Of the pinion.
    samples_per_turn : float

    Returns
    -------
    (channels,) float64
        In samples; NaN without mesh lines.
    (channels,) float64
        0 to 1; 1 where all lines are delayed alike.
    """
    orders = np.arange(1, HARMONICS + 1) * teeth
    orders = orders[orders < lines.shape[-1]]
    across = lines[:, orders] * np.conj(reference[:, orders])
    weighed = across / np.sqrt(np.abs(across) + 1e-30)
    trial = np.arange(-LARGEST * TRIALS_PER_SAMPLE, LARGEST * TRIALS_PER_SAMPLE + 1) / TRIALS_PER_SAMPLE
    turned = np.exp(2j * np.pi * orders[:, None] * trial / samples_per_turn)
    total = (weighed @ turned).real
    best = trial[np.argmax(total, axis=1)]
    whole = np.abs(weighed).sum(axis=1)
    defined = np.isfinite(across).all(axis=1) & (whole > 0.0)
    around = best[:, None] + FINE * np.arange(-1.0, 2.0)
    peak = np.einsum(
        "co,cot->ct", weighed, np.exp(2j * np.pi * orders[:, None] * around[:, None] / samples_per_turn)
    ).real
    bend = peak[:, 0] - 2.0 * peak[:, 1] + peak[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        shift = np.where(bend < 0.0, 0.5 * FINE * (peak[:, 0] - peak[:, 2]) / bend, 0.0)
        likeness = total.max(axis=1) / whole
    fine = best + np.clip(shift, -1.0 / TRIALS_PER_SAMPLE, 1.0 / TRIALS_PER_SAMPLE)
    return np.where(defined, fine, np.nan), np.where(defined, likeness, np.nan)


def channel_lags(measured: MeasuredSet, reference: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return lag and likeness of every channel beside the record's reference, (records, channels) each."""
    lines, teeth = line_array(measured.waveforms), measured.teeth
    per_turn = measured.raw.fs_hz / measured.values["pulses_per_s"][:, 0]
    found = np.full((2, *lines.shape[:2]), np.nan)
    for row in np.flatnonzero((reference >= 0) & np.isfinite(per_turn)).tolist():
        found[:, row] = sample_lags(lines[row], lines[reference[row]], int(teeth[row]), float(per_turn[row]))
    return found[0], found[1]


def lag_columns(measured: MeasuredSet, reference: np.ndarray) -> dict[str, np.ndarray]:
    """Return lags and likeness in steps that count, by name, (records,) each."""
    lags, likeness = channel_lags(measured, reference)
    channels = measured.channels
    found = {"lag to the tacho": TACHO_STEP * np.round(np.median(lags, axis=1) / TACHO_STEP)}
    for first in range(len(channels)):
        name = f"likeness of {channels[first]} to its own healthy record"
        found[name] = LIKENESS_STEP * np.round(likeness[:, first] / LIKENESS_STEP)
        for second in range(first + 1, len(channels)):
            apart = np.round(lags[:, first] - lags[:, second])
            found[f"lag of {channels[first]} to {channels[second]}"] = apart
    return found


def fine_lags(measured: MeasuredSet, reference: np.ndarray) -> dict[str, np.ndarray]:
    """Return lags to the tacho and to the first channel without steps, by name, (records,) each [samples]."""
    lags, _ = channel_lags(measured, reference)
    found = {"lag to the tacho": np.median(lags, axis=1)}
    return found | {
        f"lag of {channel} to {measured.channels[0]}": lags[:, k] - lags[:, 0]
        for k, channel in enumerate(measured.channels)
        if k
    }
