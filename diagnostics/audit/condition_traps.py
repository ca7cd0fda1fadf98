"""Trap: an attacker that does not look at the gears tells a state from healthy on gearboxes that it was not shown.

All attackers of all layers count as one test. A layer is accused where its AUC lies above what the strongest attacker
of all layers reaches in every one of 99 permutations per damaged state, of the records of that state. By chance that
happens in at most 1 of 100 sets, since a state exceeds all of n permutations with probability 1/(n + 1). Measured:
docs/understand/audit.md. Source: maximum statistic and Bonferroni, standard literature.

Of each layer its best column and all its columns together are tried, as they are and as differences from a healthy
record of the same gearbox.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from diagnostics.audit.audit import REFERENCED
from diagnostics.audit.bank_detections import DESIGN, bank_maxima, damaged_states, permuted
from diagnostics.audit.channel_lags import LAGS, lag_columns
from diagnostics.audit.condition_layers import (
    BYTE,
    CHANNELS,
    METADATA,
    NOISE,
    ORDER,
    TEXTS,
    condition_changes,
    condition_layers,
    filled_columns,
)
from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet, exchange_blocks, reference_records
from diagnostics.audit.raw_columns import CLOCK, EDGES, ENDS, LINES, OFFSETS, STORED
from diagnostics.audit.small_damage import LEVELS, small_damage_attackers
from diagnostics.audit.state_ties import unchanged
from diagnostics.audit.time_templates import TEMPLATES, template_attackers
from diagnostics.judging.evaluation import Entry, HeldOut, held_out, judged_rows
from diagnostics.judging.learners import all_columns, best_column

OF_TEETH = frozenset({NOISE, CHANNELS, ENDS, LINES, LAGS, LEVELS})
"""Layers that single damaged teeth cannot move, and other faults can."""

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
    STORED: "Send all states through one converter and one program, which keep every sample as it was.",
    ENDS: "Draw noise per gearbox by one law for all states, and filter all states alike.",
    CLOCK: "Record the tacho with the channels, by one clock, in all states.",
    TEMPLATES: "Add nothing to records that stands at the same time in several of them.",
    LEVELS: "Record all states of a gearbox at one gain, by one chain; damage may not change what its size does not.",
}
"""How each layer is mended."""


def condition_attackers(measured: MeasuredSet) -> dict[str, list[Entry]]:
    """Return the attackers of every layer."""
    reference = reference_records(measured)
    has_reference = bool((reference >= 0).any())
    changes = condition_changes(measured, reference) if has_reference else {}
    found: dict[str, list[Entry]] = {}
    for layer, (values, names) in condition_layers(measured).items():
        if values.shape[1]:
            filled = filled_columns(values)
            found[layer] = [best_column(layer, filled, names), all_columns(f"all of {layer}", filled)]
    for layer, (change, names) in changes.items():
        found[layer] += [
            best_column(f"change of {layer}", change, names),
            all_columns(f"change of all of {layer}", change),
        ]
    if has_reference and not measured.gears[0].planetary:
        lags = lag_columns(measured, reference)
        found[LAGS] = [best_column(f"change of {LAGS}", np.stack(list(lags.values()), axis=1), tuple(lags))]
    if has_reference:
        found[LEVELS] = small_damage_attackers(measured, reference)
    found[TEMPLATES] = template_attackers(measured.raw.templates)
    asked = measured.healthy | of_single_teeth(measured)
    for layer in OF_TEETH & found.keys():
        found[layer] = [replace(attacker, usable=attacker.usable & asked) for attacker in found[layer]]
    return {layer: attackers for layer, attackers in found.items() if attackers}


def of_single_teeth(measured: MeasuredSet) -> np.ndarray:
    """Return which records (records,) show damaged single teeth in an unchanged machine; all if a set does not say.

    A bearing hums by itself, worn flanks move every mesh line, and a changed machine or sensor differs on purpose.
    """
    known = measured.about.get("faulty_teeth", {}).values()
    teeth = [measured.labels[name] for name in known if name in measured.labels]
    if not teeth:
        return np.ones(len(measured.healthy), dtype=bool)
    listed = np.array([[len(row) > 0 for row in values] for values in teeth]).any(axis=0)
    return np.asarray(listed & unchanged(measured))


def level_attackers(measured: MeasuredSet, *, referenced: bool) -> list[Entry]:
    """Return the attackers that see raw levels, or their change from a healthy record; damage moves them too."""
    if not measured.raw.levels:
        return []
    values, names = np.stack(list(measured.raw.levels.values()), axis=1), tuple(measured.raw.levels)
    if referenced:
        reference = reference_records(measured)
        values = np.where((reference >= 0)[:, None], values - values[reference], np.nan)
    suffix = REFERENCED if referenced else ""
    return [best_column(f"raw levels{suffix}", values, names), all_columns(f"all raw levels{suffix}", values)]


@dataclass(frozen=True, slots=True)
class Strongest:
    """The strongest attacker of a layer, the state that it tells best, and what it reaches there."""

    layer: str
    attacker: Entry
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


def _judged(measured: MeasuredSet, bank: dict[str, list[Entry]], seed: int) -> Iterator[list[Strongest]]:
    """Yield, layer by layer, what every attacker reaches for every state."""
    specimen = measured.labels["specimen_id"]
    folds = DESIGN.dealt(specimen, seed)
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


def chance_largest(measured: MeasuredSet, attackers: list[Entry], state: str, seed: int) -> float:
    """Return the largest AUC over attackers and permutations of healthy records and those of one state.

    Parameters
    ----------
    measured : MeasuredSet
    attackers : list of Entry
    state : str
    seed : int
    """
    specimen, of_state = measured.labels["specimen_id"], np.asarray(measured.labels["state"] == state)
    able = [attacker for attacker in attackers if judged_rows(attacker, measured.healthy, of_state, specimen).size]
    rows = np.flatnonzero(measured.healthy | of_state)
    turns = PERMUTATIONS * len(damaged_states(measured))
    ways = permuted(~measured.healthy[rows], exchange_blocks(measured)[rows], specimen[rows], seed, turns)
    maxima = bank_maxima(able, rows, ways, specimen[rows], DESIGN.dealt(specimen, seed)[:, rows])
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
