"""Attackers that do not look at the gears: labels of the conditions, order of the files, bytes of samples, noise.

Each layer is a table with one row per record. Its best column and all its columns together are tried, as they are and
as differences from a healthy record of the same gearbox.
"""

from __future__ import annotations

import numpy as np

from diagnostics.audit.column_attackers import all_columns, best_column
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.record_groups import column_group
from diagnostics.audit.reference_pairs import reference_records
from diagnostics.audit.trial import Attacker
from diagnostics.indicators.noise_levels import NOISE_LEVELS
from diagnostics.records.sample_bytes import BYTES

METADATA, BYTE, ORDER, NOISE = "metadata", "bytes", "order", "noise"
STEADY_NOISE = NOISE_LEVELS[4:]
"""Bands in which a stroke has rung off within half a turn: from 637 Hz on at 25.6 kHz.

With a damping ratio of 2 to 3 % an amplitude falls to a tenth in 19 to 29 ms at 637 Hz; half a turn at 25 Hz takes 20.
Below, the quietest half turn still holds the strokes of severe damage. Measured: docs/understand/audit.md.
"""

PULSES = ("pulses_per_s", "speed_variation_percent", "start_turn")


def condition_layers(measured: MeasuredSet) -> dict[str, tuple[np.ndarray, tuple[str, ...]]]:
    """Return the values (records, columns) of every layer with the names of its columns.

    The order is that of the records in the files of the set, as a share of all. Labels are those that do not say what
    the damage is or follows from it. Bytes and noise are means over the channels.
    """
    return {
        METADATA: _stacked(_metadata(measured)),
        ORDER: _stacked({"place in the files": np.arange(len(measured.healthy)) / max(len(measured.healthy), 1)}),
        BYTE: _stacked({name: _mean(measured.values[name]) for name in BYTES if name in measured.values}),
        NOISE: _stacked({name: _mean(measured.values[name]) for name in STEADY_NOISE if name in measured.values}),
    }


def _metadata(measured: MeasuredSet) -> dict[str, np.ndarray]:
    found = {
        name: values.astype(np.float64)
        for name, values in measured.labels.items()
        if values.ndim == 1 and values.dtype.kind in "biuf" and column_group(name) is not None
    }
    return found | {name: measured.values[name][:, 0] for name in (*PULSES, "samples") if name in measured.values}


def condition_attackers(measured: MeasuredSet) -> dict[str, list[Attacker]]:
    """Return the attackers of every layer; order in the files is not compared with a reference.

    Within a gearbox the records of a set stand in the order of its states by design.
    """
    reference, found = reference_records(measured), {}
    for layer, (values, names) in condition_layers(measured).items():
        if values.shape[1] == 0:
            continue
        filled = _filled(values)
        attackers = [best_column(layer, filled, names), all_columns(f"all of {layer}", filled)]
        if layer != ORDER and (reference >= 0).any():
            change = np.where((reference >= 0)[:, None], filled - filled[reference], np.nan)
            attackers += [
                best_column(f"change of {layer}", change, names),
                all_columns(f"change of all of {layer}", change),
            ]
        found[layer] = attackers
    return found


def _filled(values: np.ndarray) -> np.ndarray:
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
