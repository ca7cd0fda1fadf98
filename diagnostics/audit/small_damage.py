"""Trap: the smallest damage is told by what larger damage of its kind does not change any further.

Levels, lags and noise may tell damage, since damage moves them. But what damage does vanishes with its size, so that
what a small one moves a larger one moves more, up or down. A gain, a delay or a noise that all damaged states have
alike moves the smallest as far as the largest. So only columns are looked at in which no larger state differs from the
smallest one; they are found anew in every trial and permutation, on the gearboxes to learn from. A leak that grows with
the damage is not seen here. Source: derived.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from diagnostics.audit.channel_lags import fine_lags
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.residual_lines import line_array
from diagnostics.indicators.background_levels import NOISE_LEVELS
from diagnostics.judging.evaluation import Entry
from diagnostics.statistics.evaluation import column_auc

LEVELS = "levels"
LARGER = 2.0
"""Times the mean damaged area of the smallest state from which a state of its kind must show more."""

DEVIATIONS = 2.0
"""Standard deviations of the AUC of records that are alike within which a larger state counts as like the smallest."""

HARMONICS = 12
TINY = 1e-30


@dataclass(frozen=True, slots=True)
class SizedStates:
    """The state of the least damage of a kind, and those of the kind that are much larger."""

    smallest: str
    larger: tuple[str, ...]


def sized_states(measured: MeasuredSet) -> list[SizedStates]:
    """Return the smallest state of every kind of fault that has larger ones, by mean damaged area."""
    labels = measured.labels
    found: list[SizedStates] = []
    if "damaged_area_mm2" not in labels:
        return found
    for fault in dict.fromkeys(labels["fault"][~measured.healthy].tolist()):
        rows = np.flatnonzero(labels["fault"] == fault)
        states = labels["state"][rows]
        area = {
            state: float(np.mean(labels["damaged_area_mm2"][rows[states == state]]))
            for state in dict.fromkeys(states.tolist())
        }
        smallest = min(area, key=lambda state: area[state])
        larger = tuple(state for state, mean in area.items() if mean >= LARGER * area[smallest] > 0.0)
        if larger:
            found.append(SizedStates(smallest, larger))
    return found


def small_damage_attackers(measured: MeasuredSet, reference: np.ndarray) -> list[Entry]:
    """Return an attacker for every smallest state, on changes from the reference (records,); -1 without one."""
    values, names = movable_changes(measured, reference)
    if not names:
        return []
    return [_attacker(measured, sizes, values, names) for sizes in sized_states(measured)]


def movable_changes(measured: MeasuredSet, reference: np.ndarray) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return what damage can move, as changes from the reference, (records, columns), and names."""
    known = reference >= 0
    found = {f"change of the {name}": values - values[reference] for name, values in measured.raw.levels.items()}
    for name in (name for name in NOISE_LEVELS if name in measured.values):
        change = measured.values[name] - measured.values[name][reference]
        found |= {f"change of the {name} of {channel}": change[:, k] for k, channel in enumerate(measured.channels)}
    found |= _mesh_changes(measured, reference)
    found |= fine_lags(measured, reference)
    columns = {name: np.where(known, values, np.nan) for name, values in found.items()}
    columns = {name: values for name, values in columns.items() if known.any() and np.isfinite(values[known]).all()}
    return (np.stack(list(columns.values()), axis=1) if columns else np.empty((0, 0))), tuple(columns)


def _mesh_changes(measured: MeasuredSet, reference: np.ndarray) -> dict[str, np.ndarray]:
    """Return changes of mesh lines in dB: each of a channel, their median, and that beside the other channels."""
    lines, teeth = line_array(measured.waveforms), measured.teeth
    most = int(min(HARMONICS, (lines.shape[-1] - 1) // teeth.max()))
    if most < 1:
        return {}
    place = teeth[:, None, None] * np.arange(1, most + 1)
    level = 20.0 * np.log10(
        np.abs(np.take_along_axis(lines, np.broadcast_to(place, (*lines.shape[:2], most)), 2)) + TINY
    )
    change = level - level[reference]
    middle = np.median(change, axis=2)
    found: dict[str, np.ndarray] = {}
    for k, channel in enumerate(measured.channels):
        found |= {f"change of mesh line {h + 1} of {channel}": change[:, k, h] for h in range(most)}
        found[f"median change of the mesh lines of {channel}"] = middle[:, k]
        if k:
            found[f"the same of {channel} less {measured.channels[0]}"] = np.median(change[:, k] - change[:, 0], axis=1)
    return found


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


def _attacker(measured: MeasuredSet, sizes: SizedStates, values: np.ndarray, names: tuple[str, ...]) -> Entry:
    state = measured.labels["state"]
    defined = np.isfinite(values).all(axis=1)
    larger = [np.flatnonzero(defined & (state == one)) for one in sizes.larger]
    usable = defined & (measured.healthy | (state == sizes.smallest))
    make = partial(_LikeLarger, values, names, larger, measured.labels["specimen_id"])
    return Entry(f"change of {LEVELS}", make, np.arange(len(values)), usable, len(names))


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
