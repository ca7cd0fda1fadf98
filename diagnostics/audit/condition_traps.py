"""Trap: an attacker that does not look at the gears tells a state from healthy on gearboxes that it was not shown.

All attackers of all layers count as one test. A layer is accused where its AUC lies above what the strongest attacker
of all layers reaches in every one of 99 permutations per damaged state, of the records of that state. By chance that
happens in at most 1 of 100 sets, since a state exceeds all of n permutations with probability 1/(n + 1). Measured:
docs/understand/audit.md. Source: maximum statistic and Bonferroni, standard literature.

Attackers that do not look at the gears: labels of the conditions, texts among them, order of the files, bytes of
samples, noise over and between channels, edges, offsets and lines of raw records.

Each layer is a table with one row per record. Its best column and all its columns together are tried, as they are and
as differences from a healthy record of the same gearbox.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from diagnostics.audit.audit import REFERENCED
from diagnostics.audit.bank_detections import bank_maxima, damaged_states, permuted
from diagnostics.audit.channel_lags import LAGS, lag_columns, sample_lags
from diagnostics.audit.column_attackers import all_columns, best_column
from diagnostics.audit.finding import Finding, must_not_tell
from diagnostics.audit.held_out import Attacker, HeldOut, dealt_folds, held_out, judged_rows
from diagnostics.audit.measured_set import MeasuredSet, exchange_blocks, reference_records
from diagnostics.audit.raw_columns import EDGES, LINES, OFFSETS
from diagnostics.audit.residual_lines import line_array
from diagnostics.audit.text_columns import text_columns
from diagnostics.indicators.background_levels import NOISE_LEVELS
from diagnostics.records.planetary_members import is_planetary
from diagnostics.records.sample_bytes import BYTES

METADATA, TEXTS, BYTE, ORDER, NOISE, CHANNELS = "metadata", "texts", "bytes", "order", "noise", "channels"
STEADY_BYTES = BYTES[:2]
STEADY_NOISE = NOISE_LEVELS[4:]
"""Bands in which a stroke has rung off within half a turn: from 637 Hz on at 25.6 kHz.

With a damping ratio of 2 to 3 % an amplitude falls to a tenth in 19 to 29 ms at 637 Hz; half a turn at 25 Hz takes 20.
Below, the quietest half turn still holds the strokes of severe damage. Measured: docs/understand/audit.md.
"""

PULSES = ("pulses_per_s", "speed_variation_percent", "start_turn")

PERMUTATIONS = 99
"""For every damaged state."""

SMALLEST_AUC = 0.7
"""Less is of no use to anybody who wants a score."""

MENDS = {
    METADATA: "Draw this quantity by one law for all states, and do not give it to a classifier.",
    ORDER: "Write the records of a gearbox together, whatever their state.",
    BYTE: "Send all states through the same converter, format and program.",
    NOISE: "Draw noise and path per gearbox by one law for all states.",
    TEXTS: "Name and date all records by one law, or do not publish the column.",
    CHANNELS: "Record every channel at one gain in all states of a gearbox.",
    LAGS: "Record all channels and the tacho by one clock in all states.",
    EDGES: "Cut all records out of longer ones, without fades.",
    OFFSETS: "Send all states through one amplifier, and take means off all or none.",
    LINES: "Record all states in one place, with the same machines and supplies near.",
}
"""How each layer is mended."""


def condition_layers(measured: MeasuredSet) -> dict[str, tuple[np.ndarray, tuple[str, ...]]]:
    """Return the values (records, columns) of every layer with the names of its columns.

    The order is that of the records in the files of the set, as a share of all. Labels are those that do not say what
    the damage is or follows from it. Bytes and noise are means over the channels; `channels` holds the noise of each,
    less the mean over all.
    """
    noise = {name: measured.values[name] for name in STEADY_NOISE if name in measured.values}
    return {
        METADATA: _stacked(_metadata(measured)),
        ORDER: _stacked({"place in the files": np.arange(len(measured.healthy)) / max(len(measured.healthy), 1)}),
        BYTE: _stacked(_bytes(measured)),
        NOISE: _stacked({name: _mean(values) for name, values in noise.items()}),
        CHANNELS: _stacked(_between_channels(noise, measured.channels)),
        TEXTS: _stacked(_texts(measured)),
        **{layer: _stacked(columns) for layer, columns in measured.raw.layers.items()},
    }


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
    return found


def _metadata(measured: MeasuredSet) -> dict[str, np.ndarray]:
    found = {
        name: values.astype(np.float64)
        for name, values in measured.labels.items()
        if values.ndim == 1 and values.dtype.kind in "biuf" and must_not_tell(measured.roles, name)
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
    if (reference >= 0).any() and not is_planetary(measured.labels):
        lags, names = _stacked(lag_columns(_lags(measured, reference), measured.channels))
        found[LAGS] = [best_column(f"change of {LAGS}", lags, names)]
    return found


def level_attackers(measured: MeasuredSet, *, referenced: bool) -> list[Attacker]:
    """Return the attackers that see raw levels, or their change from a healthy record; damage moves them too."""
    values, names = _stacked(measured.raw.levels)
    if not names:
        return []
    if referenced:
        reference = reference_records(measured)
        values = np.where((reference >= 0)[:, None], values - values[reference], np.nan)
    suffix = REFERENCED if referenced else ""
    return [best_column(f"raw levels{suffix}", values, names), all_columns(f"all raw levels{suffix}", values)]


def _lags(measured: MeasuredSet, reference: np.ndarray) -> np.ndarray:
    """Return the lag of every channel behind the record's reference, (records, channels) [samples]."""
    lines, teeth = line_array(measured.waveforms), measured.labels["teeth_pinion"]
    per_turn = measured.raw.fs_hz / measured.values["pulses_per_s"][:, 0]
    found = np.full(lines.shape[:2], np.nan)
    for row in np.flatnonzero((reference >= 0) & np.isfinite(per_turn)).tolist():
        found[row] = sample_lags(lines[row], lines[reference[row]], int(teeth[row]), float(per_turn[row]))
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


@dataclass(frozen=True, slots=True)
class Strongest:
    """The strongest attacker of a layer, the state that it tells best, and what it reaches there."""

    layer: str
    attacker: Attacker
    state: str
    found: HeldOut


def condition_traps(measured: MeasuredSet, seed: int = 0) -> list[Finding]:
    """Return a finding for every layer whose strongest attacker tells a state by more than chance explains."""
    bank = condition_attackers(measured)
    suspects = [entry for entry in map(_largest, _judged(measured, bank, seed)) if entry]
    suspects = [entry for entry in suspects if entry.found.auc.value >= SMALLEST_AUC]
    if not suspects:
        return []
    asked = [attacker for attackers in bank.values() for attacker in attackers]
    limits = {state: chance_largest(measured, asked, state, seed) for state in {entry.state for entry in suspects}}
    accused = [entry for entry in suspects if entry.found.auc.value > limits[entry.state]]
    return [_finding(entry, len(asked), limits[entry.state]) for entry in accused]


def _judged(measured: MeasuredSet, bank: dict[str, list[Attacker]], seed: int) -> Iterator[list[Strongest]]:
    """Yield, layer by layer, what every attacker reaches for every state."""
    specimen = measured.labels["specimen_id"]
    folds = dealt_folds(specimen, seed)
    for layer, attackers in bank.items():
        entries = []
        for state in damaged_states(measured):
            of_state = np.asarray(measured.labels["state"] == state)
            for attacker in attackers:
                rows = judged_rows(attacker, measured.healthy, of_state, specimen)
                if rows.size:
                    found = held_out(attacker, rows, of_state[rows], specimen[rows], folds[:, rows], seed)
                    entries.append(Strongest(layer, attacker, state, found))
        yield entries


def _largest(entries: list[Strongest]) -> Strongest | None:
    defined = [entry for entry in entries if np.isfinite(entry.found.auc.value)]
    return max(defined, key=lambda entry: entry.found.auc.value, default=None)


def chance_largest(measured: MeasuredSet, attackers: list[Attacker], state: str, seed: int) -> float:
    """Return the largest AUC over attackers and permutations of healthy records and those of one state.

    Parameters
    ----------
    measured : MeasuredSet
    attackers : list of Attacker
    state : str
    seed : int
    """
    specimen = measured.labels["specimen_id"]
    rows = np.flatnonzero(measured.healthy | (measured.labels["state"] == state))
    turns = PERMUTATIONS * len(damaged_states(measured))
    ways = permuted(~measured.healthy[rows], exchange_blocks(measured)[rows], specimen[rows], seed, turns)
    maxima = bank_maxima(attackers, rows, ways, specimen[rows], dealt_folds(specimen, seed)[:, rows])
    return float(np.max(maxima, where=np.isfinite(maxima), initial=0.0))


def _finding(entry: Strongest, tried: int, limit: float) -> Finding:
    auc, basis = entry.found.auc, f", by {entry.found.basis}" if entry.found.basis else ""
    return Finding(
        f"state_told_by_{entry.layer}",
        f"{entry.attacker.name} alone tells {entry.state} from healthy on gearboxes that were not seen with an AUC of "
        f"{auc.value:.2f} ({auc.low:.2f} to {auc.high:.2f}){basis}",
        f"with permuted states the strongest of {tried} attackers reaches at most {limit:.2f}",
        MENDS[entry.layer],
    )
