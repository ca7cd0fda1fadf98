"""Numbers by which records that do not look at the gears can be told: a table of every layer, one row per record.

Labels of the conditions, texts and digits among them, order of the files, bytes of samples, noise over and between
channels, and the layers of raw records.
"""

from __future__ import annotations

import numpy as np

from diagnostics.audit.finding import must_not_tell
from diagnostics.audit.label_digits import digit_columns, zero_signs
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.noise_excess import noise_excess
from diagnostics.audit.text_columns import text_columns
from diagnostics.indicators.background_levels import NOISE_LEVELS
from diagnostics.records.sample_bytes import BYTES
from siggen.keys.column import Role

METADATA, TEXTS, BYTE, ORDER, NOISE, CHANNELS = "metadata", "texts", "bytes", "order", "noise", "channels"
STEADY_BYTES = BYTES[:2]
STEADY_NOISE = NOISE_LEVELS[4:]
"""Bands in which a stroke has rung off within half a turn: from 637 Hz on at 25.6 kHz.

With a damping ratio of 2 to 3 % an amplitude falls to a tenth in 19 to 29 ms at 637 Hz; half a turn at 25 Hz takes 20.
Below, the quietest half turn still holds the strokes of severe damage. Measured: docs/understand/audit.md.
"""

PULSES = ("pulses_per_s", "speed_variation_percent", "start_turn")


def condition_layers(measured: MeasuredSet) -> dict[str, tuple[np.ndarray, tuple[str, ...]]]:
    """Return the values (records, columns) of every layer with the names of its columns.

    The order is that of the records in the files of the set, as a share of all. Labels are those that do not say what
    the damage is or follows from it. Bytes and noise are means over the channels; `channels` holds the noise of each,
    less the mean over all.
    """
    noise = {name: measured.values[name] for name in steady_noise(measured)}
    return {
        METADATA: _stacked(_metadata(measured)),
        ORDER: _stacked(_order(measured)),
        BYTE: _stacked(_bytes(measured)),
        NOISE: _stacked({name: _mean(values) for name, values in noise.items()}),
        CHANNELS: _stacked(_between_channels(noise, measured.channels)),
        TEXTS: _stacked(_texts(measured)),
        **{layer: _stacked(columns) for layer, columns in measured.raw.layers.items()},
    }


def condition_changes(measured: MeasuredSet, reference: np.ndarray) -> dict[str, tuple[np.ndarray, tuple[str, ...]]]:
    """Return the layers as changes from the reference (records,), undefined without one (-1).

    Of noise what exceeds the lines. The order in the files is not compared: within a gearbox the records of a set stand
    in the order of its states by design.
    """
    known, found = (reference >= 0)[:, None], {}
    for layer, (values, names) in condition_layers(measured).items():
        if layer != ORDER and values.shape[1]:
            filled = filled_columns(values)
            found[layer] = np.where(known, filled - filled[reference], np.nan), names
    excess = noise_excess(measured, reference, steady_noise(measured))
    for layer, columns in (
        (NOISE, {name: _mean(values) for name, values in excess.items()}),
        (CHANNELS, _between_channels(excess, measured.channels)),
    ):
        if layer in found:
            values, names = _stacked(columns)
            found[layer] = np.where(known, filled_columns(values), np.nan), names
    return found


def steady_noise(measured: MeasuredSet) -> tuple[str, ...]:
    """Return the bands of noise that a set has and in which strokes ring off."""
    return tuple(name for name in STEADY_NOISE if name in measured.values)


def _order(measured: MeasuredSet) -> dict[str, np.ndarray]:
    """Return the place of every record among all, and among those of its split, as shares."""
    every = np.arange(len(measured.healthy))
    found = {"place in the files": every / max(every.size, 1)}
    if "split" in measured.labels:
        of_split = np.zeros(every.size)
        for split in dict.fromkeys(measured.labels["split"].tolist()):
            rows = np.flatnonzero(measured.labels["split"] == split)
            of_split[rows] = np.arange(rows.size) / rows.size
        found["place in the files of its split"] = of_split
    return found


def _bytes(measured: MeasuredSet) -> dict[str, np.ndarray]:
    """Return means over the channels; step and odd mantissas of each channel besides, which no clipping moves."""
    held = {name: measured.values[name] for name in BYTES if name in measured.values}
    found = {name: _mean(values) for name, values in held.items()}
    for name in [name for name in STEADY_BYTES if name in held] if len(measured.channels) > 1 else []:
        found |= {f"{name} of {channel}": held[name][:, k] for k, channel in enumerate(measured.channels)}
    return found


def _between_channels(noise: dict[str, np.ndarray], channels: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Return the noise of every channel less the mean over those that are defined."""
    found: dict[str, np.ndarray] = {}
    for name, values in noise.items():
        defined = np.isfinite(values)
        mean = np.where(defined, values, 0.0).sum(axis=1) / np.maximum(defined.sum(axis=1), 1)
        found |= {f"{name} of {channel}": values[:, k] - mean for k, channel in enumerate(channels)}
    return found if len(channels) > 1 else {}


def _texts(measured: MeasuredSet) -> dict[str, np.ndarray]:
    found: dict[str, np.ndarray] = {}
    for name, values in measured.labels.items():
        if values.ndim == 1 and values.dtype.kind not in "biuf" and must_not_tell(measured.roles, name):
            found |= text_columns(name, values)
        if values.ndim == 1 and values.dtype.kind == "f" and must_not_tell(measured.roles, name):
            found |= digit_columns(name, values)
        if values.ndim == 1 and values.dtype.kind == "f" and measured.roles.get(name) == Role.MEASURED:
            found |= zero_signs(name, values)  # damage moves a measured number, but not how zero is written
    return found


def _metadata(measured: MeasuredSet) -> dict[str, np.ndarray]:
    found = {
        name: values.astype(np.float64)
        for name, values in measured.labels.items()
        if values.ndim == 1 and values.dtype.kind in "biuf" and must_not_tell(measured.roles, name)
    }
    pulses = {name: measured.values[name][:, 0] for name in (*PULSES, "samples") if name in measured.values}
    return found | pulses | _beside_labels(measured.labels, pulses)


def _beside_labels(labels: dict[str, np.ndarray], pulses: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return what the pulses give less what labels say, where a set has both."""
    found = {}
    if "speed_hz" in labels and "pulses_per_s" in pulses:
        found["speed of the pulses over its label"] = pulses["pulses_per_s"] / labels["speed_hz"] - 1.0
    if "start_angle_rad" in labels and "start_turn" in pulses:
        apart = pulses["start_turn"] - labels["start_angle_rad"] / (2.0 * np.pi)
        found["distance of the start by the pulses from its label"] = np.abs((apart + 0.5) % 1.0 - 0.5)
    return found


def filled_columns(values: np.ndarray) -> np.ndarray:
    """Return columns with undefined values far below all others, so that being undefined tells something too."""
    finite = np.isfinite(values)
    kept = np.where(finite, values, np.nan)
    with np.errstate(invalid="ignore"):
        low = np.nanmin(np.where(finite.any(axis=0), kept, 0.0), axis=0)
        span = np.nanmax(np.where(finite.any(axis=0), kept, 0.0), axis=0) - low
    return np.asarray(np.where(finite, values, low - span - 1.0))


def _mean(values: np.ndarray) -> np.ndarray:
    """Return the mean over channels; NaN where one of them is undefined."""
    return np.asarray(values.mean(axis=1))


def _stacked(columns: dict[str, np.ndarray]) -> tuple[np.ndarray, tuple[str, ...]]:
    return np.stack(list(columns.values()), axis=1) if columns else np.empty((0, 0)), tuple(columns)
