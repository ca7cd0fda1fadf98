"""Leak: a detector that does not look at the gears tells a state from healthy on gearboxes that it was not shown.

All detectors of all layers count as one test. A layer is accused where its AUC lies above what the strongest detector
of all layers reaches in every one of 99 permutations per damaged state, of the records of that state. By chance that
happens in at most 1 of 100 sets, since a state exceeds all of n permutations with probability 1/(n + 1). Measured:
docs/understand/audit.md. Source: maximum statistic and Bonferroni, standard literature.

Of each layer its best column and all its columns together are tried, as they are and as differences from a healthy
record of the same gearbox.

Levels, lags and noise may tell damage, since damage moves them. But what damage does vanishes with its size, so that
what a small one moves a larger one moves more, up or down. A gain, a delay or a noise that all damaged states have
alike moves the smallest as far as the largest. So of them only columns are looked at in which no larger state differs
from the smallest one; they are found anew in every trial and permutation, on the gearboxes to learn from. A leak that
grows with the damage is not seen here. The floor of a spectrum rises steeply with damage: of its shape the next larger
state is asked alone. Lines of the mesh do not, and may fall before they rise. Source: derived.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from diagnostics.audit.audit import REFERENCED
from diagnostics.audit.averaged_lines import line_array
from diagnostics.audit.bank import damaged_states, detection_by, permuted_maxima
from diagnostics.audit.condition_layers import (
    BYTE,
    CHANNELS,
    LAGS,
    METADATA,
    NOISE,
    ORDER,
    TEXTS,
    condition_changes,
    condition_layers,
    filled_columns,
    fine_lags,
    lag_columns,
)
from diagnostics.audit.detectability import Detectability
from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet, reference_records
from diagnostics.audit.raw_records import (
    BLOCKS,
    CLOCK,
    CODE_LAW,
    COURSE,
    ECHOES,
    EDGES,
    ENDS,
    LINES,
    LOCKED,
    LOW_BITS,
    OFFSETS,
    PHASES,
    STORED,
    TEMPLATES,
    template_detectors,
)
from diagnostics.audit.spectral_shape import shape_changes
from diagnostics.indicators.background_levels import NOISE_LEVELS
from diagnostics.judging.evaluation import Entry
from diagnostics.judging.learners import all_columns, best_column
from diagnostics.statistics.evaluation import column_auc

LEVELS = "levels"
LARGER = 2.0
"""Times the mean damaged area of the smallest state from which a state of its kind must show more."""

DEVIATIONS = 2.0
"""Standard deviations of the AUC of records that are alike within which a larger state counts as like the smallest."""

MESH_LINES = 12
TINY = 1e-30


def sized_states(measured: MeasuredSet) -> list[tuple[str, tuple[str, ...]]]:
    """Return the state of least mean damaged area of every kind of fault, and those of the kind that are much larger.

    These ascend. Kinds without a larger state are left out.
    """
    labels, pairs = measured.labels, list[tuple[str, tuple[str, ...]]]()
    if "damaged_area_mm2" not in labels:
        return pairs
    for fault in dict.fromkeys(labels["fault"][~measured.healthy].tolist()):
        rows = np.flatnonzero(labels["fault"] == fault)
        states = labels["state"][rows]
        area = {
            state: float(np.mean(labels["damaged_area_mm2"][rows[states == state]]))
            for state in dict.fromkeys(states.tolist())
        }
        smallest = min(area, key=lambda state: area[state])
        larger = [state for state, mean in area.items() if mean >= LARGER * area[smallest] > 0.0]
        if larger:
            pairs.append((smallest, tuple(sorted(larger, key=lambda state: area[state]))))
    return pairs


def small_damage_detectors(measured: MeasuredSet, reference: np.ndarray) -> list[Entry]:
    """Return detectors for every smallest state, on changes from the reference (records,); -1 without one."""
    movable = _known(movable_changes(measured, reference), reference)
    floors = _known(shape_changes(measured.raw.floors, reference), reference)
    detectors = []
    for smallest, larger in sized_states(measured):
        if movable:
            detectors.append(_detector(measured, f"change of {LEVELS}", smallest, larger, movable))
        if floors:
            detectors.append(_detector(measured, "change of the floor", smallest, larger[:1], floors))
    return detectors


def _known(columns: dict[str, np.ndarray], reference: np.ndarray) -> dict[str, np.ndarray]:
    """Return the columns that all records with a reference have, undefined in the others (-1)."""
    known = reference >= 0
    return {
        name: np.where(known, values, np.nan) for name, values in columns.items() if np.isfinite(values[known]).all()
    }


def movable_changes(measured: MeasuredSet, reference: np.ndarray) -> dict[str, np.ndarray]:
    """Return what damage can move, as changes from the reference, (records,) each, by name."""
    changes = {f"change of the {name}": values - values[reference] for name, values in measured.raw.levels.items()}
    for name in (name for name in NOISE_LEVELS if name in measured.values):
        change = measured.values[name] - measured.values[name][reference]
        changes |= {f"change of the {name} of {channel}": change[:, k] for k, channel in enumerate(measured.channels)}
    return changes | _mesh_changes(measured, reference) | fine_lags(measured, reference)


def _mesh_changes(measured: MeasuredSet, reference: np.ndarray) -> dict[str, np.ndarray]:
    """Return changes of mesh lines in dB: each of a channel, their median, and that beside the other channels."""
    lines, teeth = line_array(measured.waveforms), measured.teeth
    most = int(min(MESH_LINES, (lines.shape[-1] - 1) // teeth.max()))
    if most < 1:
        return {}
    place = teeth[:, None, None] * np.arange(1, most + 1)
    level = 20.0 * np.log10(
        np.abs(np.take_along_axis(lines, np.broadcast_to(place, (*lines.shape[:2], most)), 2)) + TINY
    )
    change = level - level[reference]
    middle = np.median(change, axis=2)
    changes: dict[str, np.ndarray] = {}
    for k, channel in enumerate(measured.channels):
        changes |= {f"change of mesh line {h + 1} of {channel}": change[:, k, h] for h in range(most)}
        changes[f"median change of the mesh lines of {channel}"] = middle[:, k]
        if k:
            changes[f"the same of {channel} less {measured.channels[0]}"] = np.median(
                change[:, k] - change[:, 0], axis=1
            )
    return changes


class _LikeLarger:
    """The column that tells the smallest state best, of those in which no larger state differs from it."""

    def __init__(self, values: np.ndarray, names: Sequence[str], larger: Sequence[np.ndarray], specimen: np.ndarray):
        self.values, self.names, self.larger, self.specimen = values, names, larger, specimen

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> _LikeLarger:
        """Choose by places (n,) and y (ways, n); of larger damage the gearboxes to learn from."""
        area = column_auc(self.values[X], y)
        shown = [rows[np.isin(self.specimen[rows], groups)] for rows in self.larger]
        alike = np.all([_alike(self.values[rows], self.values[X], y) for rows in shown if rows.size], axis=0)
        self.best = np.argmax(np.where(alike, np.abs(area - 0.5), -1.0), axis=1)
        turned = np.where(alike, np.sign(area - 0.5), 0.0)
        self.turned = np.take_along_axis(turned, self.best[:, None], axis=1)
        self.basis = self.names[self.best[0]] if self.turned[0, 0] else "nothing"
        return self

    def score(self, X: np.ndarray) -> np.ndarray:
        """Return the column, turned so that damage is large, (ways, m)."""
        return np.asarray(self.turned * self.values[X][:, self.best].T)


def _detector(
    measured: MeasuredSet, name: str, smallest: str, larger_states: tuple[str, ...], columns: dict[str, np.ndarray]
) -> Entry:
    values, names = np.stack(list(columns.values()), axis=1), tuple(columns)
    state = measured.labels["state"]
    defined = np.isfinite(values).all(axis=1)
    usable = defined & (measured.healthy | (state == smallest))
    larger = [np.flatnonzero(defined & (state == one)) for one in larger_states]
    make = partial(_LikeLarger, values, names, larger, measured.labels["specimen_id"])
    return Entry(name, make, np.arange(len(values)), usable, len(names))


def _alike(larger: np.ndarray, learnt: np.ndarray, positive: np.ndarray) -> np.ndarray:
    """Return in which columns larger damage is like the smallest, and moves no further, (turns, columns) bool."""
    count = positive.sum(axis=1, keepdims=True)
    # the variance of an AUC of 0.5: (n + m + 1) / (12 n m)
    allowed = DEVIATIONS * np.sqrt((len(larger) + count + 1) / (12.0 * len(larger) * count))
    apart = positive @ _wins(larger, learnt) / count - 0.5
    further = positive @ _wins(np.abs(larger), np.abs(learnt)) / count - 0.5
    return np.asarray((np.abs(apart) <= allowed) & (further <= allowed))


def _wins(larger: np.ndarray, learnt: np.ndarray) -> np.ndarray:
    """Return the share of larger damage that lies above each record to learn from, (records, columns)."""
    return np.stack([0.5 + 0.5 * np.sign(larger - row).mean(axis=0) for row in learnt])


OF_TEETH = frozenset({NOISE, CHANNELS, ENDS, LINES, LAGS, LEVELS, ECHOES})
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
    LAGS: "Record all channels and the tacho by one clock, and with one sign, in all states.",
    EDGES: "Cut all records out of longer ones, without fades.",
    OFFSETS: "Send all states through one amplifier, and take means off all or none.",
    LINES: "Record all states in one place, with the same machines and supplies near.",
    STORED: "Send all states through one converter and one program, which keep every sample as it was.",
    CODE_LAW: "Send all states through one converter and one program, which round every sample alike.",
    COURSE: "Record all states with gains that stay as they are.",
    PHASES: "Start records at any time of the machines near, in all states.",
    LOCKED: "Start records at any time, locked to no mains and no trigger, and add nothing to them.",
    LOW_BITS: "Write all samples as the converter gave them; hide no mark in their lowest bits.",
    ECHOES: "Record and process all states by one chain, without echo and delay.",
    BLOCKS: "Record all states without losing samples between blocks.",
    ENDS: "Draw noise per gearbox by one law for all states, and filter all states alike.",
    CLOCK: "Record the tacho with the channels, by one clock, in all states.",
    TEMPLATES: "Add nothing to records that stands at the same time in several of them.",
    LEVELS: "Record all states at one gain and sign, by one chain; damage may not change what its size does not.",
}
"""How each layer is mended."""


def condition_detectors(measured: MeasuredSet) -> dict[str, list[Entry]]:
    """Return the detectors of every layer."""
    reference = reference_records(measured)
    has_reference = bool((reference >= 0).any())
    changes = condition_changes(measured, reference) if has_reference else {}
    layers: dict[str, list[Entry]] = {}
    for layer, (values, names) in condition_layers(measured).items():
        if values.shape[1]:
            filled = filled_columns(values)
            layers[layer] = [best_column(layer, filled, names), all_columns(f"all of {layer}", filled)]
    for layer, (change, names) in changes.items():
        layers[layer] += [
            best_column(f"change of {layer}", change, names),
            all_columns(f"change of all of {layer}", change),
        ]
    if has_reference and not measured.gears[0].planetary:
        lags = lag_columns(measured, reference)
        layers[LAGS] = [best_column(f"change of {LAGS}", np.stack(list(lags.values()), axis=1), tuple(lags))]
    if has_reference:
        layers[LEVELS] = small_damage_detectors(measured, reference)
    layers[TEMPLATES] = template_detectors(measured.raw.templates)
    asked = measured.healthy | of_single_teeth(measured)
    for layer in OF_TEETH & layers.keys():
        layers[layer] = [replace(detector, usable=detector.usable & asked) for detector in layers[layer]]
    return {layer: detectors for layer, detectors in layers.items() if detectors}


def of_single_teeth(measured: MeasuredSet) -> np.ndarray:
    """Return which records (records,) show damaged single teeth in an unchanged machine; all if a set does not say.

    A bearing hums by itself, worn flanks move every mesh line, and a changed machine or sensor differs on purpose.
    """
    known = measured.about.get("faulty_teeth", {}).values()
    teeth = [measured.labels[name] for name in known if name in measured.labels]
    if not teeth:
        return np.ones(len(measured.healthy), dtype=bool)
    listed = np.array([[len(row) > 0 for row in values] for values in teeth]).any(axis=0)
    return np.asarray(listed & measured.unchanged)


def level_detectors(measured: MeasuredSet, *, referenced: bool) -> list[Entry]:
    """Return the detectors that see raw levels, or their change from a healthy record; damage moves them too."""
    if not measured.raw.levels:
        return []
    values, names = np.stack(list(measured.raw.levels.values()), axis=1), tuple(measured.raw.levels)
    if referenced:
        reference = reference_records(measured)
        values = np.where((reference >= 0)[:, None], values - values[reference], np.nan)
    suffix = REFERENCED if referenced else ""
    return [best_column(f"raw levels{suffix}", values, names), all_columns(f"all raw levels{suffix}", values)]


def condition_leaks(measured: MeasuredSet, seed: int = 0) -> list[Finding]:
    """Return a finding for every layer whose strongest detector tells a state by more than chance explains."""
    bank = condition_detectors(measured)
    asked = [detector for detectors in bank.values() for detector in detectors]
    turns, limits, findings = PERMUTATIONS * len(damaged_states(measured)), dict[str, float](), []
    for layer, detectors in bank.items():
        every = (
            (one, detection_by(measured, one, state, seed)) for state in damaged_states(measured) for one in detectors
        )
        defined = [(one, entry) for one, entry in every if entry.auc.value >= SMALLEST_AUC]
        if not defined:
            continue
        strongest, entry = max(defined, key=lambda pair: pair[1].auc.value)
        if entry.state not in limits:
            maxima = permuted_maxima(measured, asked, entry.state, seed, turns)[0][1:]
            limits[entry.state] = float(np.max(maxima, where=np.isfinite(maxima), initial=0.0))
        if entry.auc.value > limits[entry.state]:
            findings.append(_finding(layer, strongest.name, entry, len(asked), limits[entry.state]))
    return findings


def _finding(layer: str, name: str, entry: Detectability, tried: int, limit: float) -> Finding:
    auc, basis = entry.auc, f", by {entry.basis}" if entry.basis else ""
    return Finding(
        f"state_told_by_{layer}",
        f"{name} alone tells {entry.state} from healthy on gearboxes that were not seen with an AUC of "
        f"{auc.value:.2f} ({auc.low:.2f} to {auc.high:.2f}){basis}",
        f"with permuted states the strongest of {tried} detectors reaches at most {limit:.2f}",
        MENDS[layer],
    )
