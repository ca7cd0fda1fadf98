"""What a bank of attackers reaches for every state, and what the strongest of them reaches by chance."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from diagnostics.attacks.chance import LEVEL, PERMUTATIONS, chance_maximum
from diagnostics.attacks.held_out import dealt_folds, held_out, judged_rows
from diagnostics.attacks.trial import Attacker
from diagnostics.audit.detectability import Detection, damage_sizes, in_order
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.records.damage_kind import damage_kind
from diagnostics.statistics.evaluation import Interval


@dataclass(frozen=True, slots=True)
class ChanceLimit:
    """AUC that the strongest of several attackers stays below in 95 % of permuted states.

    Attributes
    ----------
    auc : float
        The limit; NaN where nothing could be judged.
    attackers : int
        How many attackers count as one test.
    permutations : int
    """

    auc: float
    attackers: int
    permutations: int


def damaged_states(measured: MeasuredSet) -> tuple[str, ...]:
    """Return the states with damage, in the order of the records."""
    return tuple(dict.fromkeys(measured.labels["state"][~measured.healthy].tolist()))


def bank_detections(
    measured: MeasuredSet, attackers: Sequence[Attacker], seed: int, advance: Callable[[], None]
) -> dict[str, list[Detection]]:
    """Return the detection of every state by every attacker that could be asked, by its name.

    Parameters
    ----------
    measured : MeasuredSet
        The set.
    attackers : sequence of Attacker
    seed : int
        Of folds and resampled gearboxes.
    advance : callable
        Called after every attacker.
    """
    folds = dealt_folds(measured.labels["specimen_id"], seed)
    found = {}
    for attacker in attackers:
        entries = [_detection(measured, attacker, state, folds, seed) for state in damaged_states(measured)]
        if any(math.isfinite(entry.auc.value) for entry in entries):
            found[attacker.name] = in_order(entries)
        advance()
    return found


def _detection(measured: MeasuredSet, attacker: Attacker, state: str, folds: np.ndarray, seed: int) -> Detection:
    labels = measured.labels
    of_state = np.asarray(labels["state"] == state) & ~measured.healthy
    rows = judged_rows(attacker, measured.healthy, of_state, labels["specimen_id"])
    sizes, kind = damage_sizes(measured, of_state), damage_kind(labels, of_state)
    if rows.size == 0:
        return Detection(state, kind, sizes, Interval(math.nan, math.nan, math.nan), 0, "", attacker.tried)
    found = held_out(attacker, rows, of_state[rows], labels["specimen_id"][rows], folds[:, rows], seed)
    return Detection(state, kind, sizes, found.auc, found.specimens, found.basis, attacker.tried)


def chance_limit(
    measured: MeasuredSet, attackers: Sequence[Attacker], seed: int, advance: Callable[[], None]
) -> ChanceLimit:
    """Return the limit for the state with the fewest records: the others have as many or a lower one.

    Parameters
    ----------
    measured, attackers, seed
        As of `bank_detections`.
    advance : callable
        Called after every permutation.
    """
    asked = [attacker for attacker in attackers if attacker.permutable]
    labels, every = measured.labels, []
    for state in damaged_states(measured):
        of_state = np.asarray(labels["state"] == state) & ~measured.healthy
        kept = [judged_rows(attacker, measured.healthy, of_state, labels["specimen_id"]) for attacker in asked]
        rows = np.unique(np.concatenate(kept)) if kept else np.empty(0, np.int64)
        if rows.size:
            every.append((int(of_state[rows].sum()), rows, of_state[rows]))
    if not every:
        return ChanceLimit(math.nan, len(asked), 0)
    _, rows, positive = min(every, key=lambda entry: entry[0])
    folds = dealt_folds(labels["specimen_id"], seed)[:, rows]
    maxima = []
    for turn in range(PERMUTATIONS):
        maxima.append(chance_maximum(asked, rows, positive, labels["specimen_id"][rows], folds, seed, turn))
        advance()
    defined = np.array(maxima)[np.isfinite(maxima)]
    return ChanceLimit(exceeded_by_chance(defined), len(asked), PERMUTATIONS)


def exceeded_by_chance(maxima: np.ndarray) -> float:
    """Return the limit that another maximum of the same law exceeds in 5 % of the cases at most; NaN without any.

    Of n + 1 exchangeable numbers each is as likely to be the largest. So the limit is number ceil(0.95 (n + 1)) of n,
    the largest where that is beyond it; a quantile of the n would be exceeded more often. Derived.
    """
    if maxima.size == 0:
        return math.nan
    place = math.ceil(LEVEL * (maxima.size + 1) - 1e-9)
    return float(np.sort(maxima)[min(place, maxima.size) - 1])
