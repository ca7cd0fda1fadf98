"""What a bank of detectors reaches for every state and on shams, and what the strongest of them reaches by chance.

The best of a dozen detectors lies above 0.5 even where there is nothing to find. So the largest AUC over all of them is
compared with its own law under exchanged states, among alike records, all as one test. The test is exact where records
of a block are alike but for the state: then the stated states are one of the ways of stating them, each as likely as
the others. Detectors that are too slow for that are left out of both sides. Source: permutation tests with the maximum
statistic, standard literature (Westfall and Young 1993; Phipson and Smyth 2010 for counting the stated states among the
ways).

A sham is damage that was drawn and passed on with nothing removed, which none should find. It is judged as a damaged
state is, against the other healthy records: by detectors that see a record alone, and by those that see it beside a
healthy record. Where it is told from healthy, the pipeline leaks. Damage counts as found where a detector exceeds what
it reaches on a sham.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from diagnostics.audit.detectability import TARGETS, Detectability, damage_sizes, in_order
from diagnostics.audit.finding import LARGEST_AUC, Finding
from diagnostics.audit.measured_set import MeasuredSet, exchange_blocks
from diagnostics.base.seeding import Purpose, generator
from diagnostics.judging.evaluation import Design, Entry, HeldOut, held_out, held_out_values, judged_rows
from diagnostics.page.wording import decimal, limits
from diagnostics.records.state_classes import HEALTHY, SHAM, damage_kind
from diagnostics.statistics.evaluation import UNDEFINED, Interval

DESIGN = Design(folds=4, owner=1000, deals=3, fewest=2)
PERMUTATIONS = 499
LEVEL = 0.95
OWNER = 1000
"""Owner of the permutations' generator: other leaks have others."""
BLOCK, GEARBOX, GEARBOXES = "block", "gearbox", "gearboxes"
"""What states are exchanged within; the last: whole gearboxes among each other."""


def permuted(positive: np.ndarray, block: np.ndarray, specimen: np.ndarray, seed: int, turns: int) -> np.ndarray:
    """Return states exchanged within blocks, else within gearboxes, else among gearboxes, (turns, n) bool.

    Parameters
    ----------
    positive : (n,) bool
        Damaged records.
    block : (n,) int
        Records of one block are alike but for the state. Where no block has both states, gearboxes are the blocks.
    specimen : (n,) int
        Gearboxes; where none has both states, they are exchanged as a whole.
    seed, turns : int
        Which permutations, and how many.
    """
    rng, unit = generator(seed, Purpose.PERMUTATION, OWNER), exchanged_unit(positive, block, specimen)
    if unit != GEARBOXES:
        groups = block if unit == BLOCK else specimen
        return _exchanged(positive, groups, rng.random((turns, positive.size)))
    _, first, place = np.unique(specimen, return_index=True, return_inverse=True)
    lead = _exchanged(positive[first], np.zeros_like(first), rng.random((turns, first.size)))
    return np.asarray(lead[:, place.ravel()])


def exchanged_unit(positive: np.ndarray, block: np.ndarray, specimen: np.ndarray) -> str:
    """Return within what states are exchanged: `block`, else `gearbox`, or `gearboxes` where these move as a whole.

    Parameters
    ----------
    positive, block, specimen
        As of `permuted`.
    """
    if _is_mixed(positive, block):
        return BLOCK
    return GEARBOX if _is_mixed(positive, specimen) else GEARBOXES


def _is_mixed(positive: np.ndarray, groups: np.ndarray) -> bool:
    """Return whether a group holds both states."""
    _, place = np.unique(groups, return_inverse=True)
    share = np.bincount(place.ravel(), positive) / np.bincount(place.ravel())
    return bool(((share > 0.0) & (share < 1.0)).any())


def _exchanged(positive: np.ndarray, groups: np.ndarray, keys: np.ndarray) -> np.ndarray:
    """Return states sorted within groups by random keys, (turns, n)."""
    found = np.empty(keys.shape, dtype=bool)
    found[:, np.argsort(groups, kind="stable")] = [positive[np.lexsort((turn, groups))] for turn in keys]
    return found


def bank_maxima(
    detectors: Sequence[Entry], rows: np.ndarray, states: np.ndarray, specimen: np.ndarray, folds: np.ndarray
) -> np.ndarray:
    """Return the largest AUC over the detectors for every way of stating the damaged records, (turns,).

    Parameters
    ----------
    detectors : sequence of Entry
        Every one is asked about the rows that it can use.
    rows : (n,) int
        Records of the set.
    states : (turns, n) bool
        As of `permuted`.
    specimen : (n,) int
    folds : (deals, n) int
        As of `Design.dealt`.

    Returns
    -------
    (turns,) float64
        NaN where none could be asked.
    """
    areas = [np.full(len(states), np.nan)]
    for detector in detectors:
        kept = detector.usable[rows]
        if kept.any():
            areas.append(held_out_values(detector, rows[kept], states[:, kept], specimen[kept], folds[:, kept]))
    return np.asarray(np.fmax.reduce(areas))


def gearboxes_needed(chance: ChanceLimit | None, specimens: int) -> int | None:
    """Return the least number of gearboxes that may tell; None where those that were judged do.

    So few tell nothing where the strongest detector reaches by chance what a leak is accused of, 0.9. As many are
    needed as bring that limit down to the lowest AUC that counts as found, 0.75: its distance from 0.5 falls as one
    over the root of the gearboxes, as does the scatter of an AUC (Birnbaum and Klose 1957). Derived. An AUC ends at 1,
    so the number is the least.

    Parameters
    ----------
    chance : ChanceLimit, optional
        What the strongest detector reaches by chance; undefined where nothing could be judged.
    specimens : int
        Gearboxes that were judged.
    """
    if chance is None or not math.isfinite(chance.auc) or chance.auc < LARGEST_AUC:
        return None
    excess = (chance.auc - 0.5) / (TARGETS[0] - 0.5)
    # the last digits are of floating point: 24.000000000000004 gearboxes are 24
    return math.ceil(round(specimens * excess * excess, 9))


@dataclass(frozen=True, slots=True)
class StateChance:
    """What the strongest of several detectors reaches on one state by chance.

    Attributes
    ----------
    auc : float
        Limit that it exceeds in 5 % of the cases at most.
    p_value : float
        (1 + permutations that reach at least what the stated states do) / (1 + permutations).
    exchanged : str
        Within what states were exchanged, as of `diagnostics.audit.bank.exchanged_unit`.
    """

    auc: float
    p_value: float
    exchanged: str


@dataclass(frozen=True, slots=True)
class ChanceLimit:
    """AUC that the strongest of several detectors stays below in 95 % of permuted states.

    Attributes
    ----------
    auc : float
        The least over the states; NaN where nothing could be judged. A state that differs much from healthy records
        has a higher limit: permuted, its records still lie apart from the others.
    detectors : int
        How many detectors count as one test.
    permutations : int
        Of every state.
    states : dict of str to StateChance
        Each is a test of its own.
    """

    auc: float
    detectors: int
    permutations: int
    states: dict[str, StateChance] = field(default_factory=dict)

    def of(self, state: str) -> float:
        """Return the limit of a state, or the least where the state has none of its own."""
        return self.states[state].auc if state in self.states else self.auc


def damaged_states(measured: MeasuredSet) -> tuple[str, ...]:
    """Return the states with damage, in the order of the records."""
    return tuple(dict.fromkeys(measured.labels["state"][~measured.healthy].tolist()))


def bank_detections(
    measured: MeasuredSet, detectors: Sequence[Entry], seed: int, advance: Callable[[], None]
) -> dict[str, list[Detectability]]:
    """Return the detection of every state by every detector that could be asked, by its name.

    Parameters
    ----------
    measured : MeasuredSet
        The set.
    detectors : sequence of Entry
    seed : int
        Of folds and resampled gearboxes.
    advance : callable
        Called after every detector.
    """
    found = {}
    for detector in detectors:
        entries = [detection_by(measured, detector, state, seed) for state in damaged_states(measured)]
        if any(math.isfinite(entry.auc.value) for entry in entries):
            found[detector.name] = in_order(entries)
        advance()
    return found


def detection_by(measured: MeasuredSet, detector: Entry, state: str, seed: int) -> Detectability:
    """Return the detection of one state by one detector; the AUC is NaN with too few gearboxes."""
    labels, specimen = measured.labels, measured.labels["specimen_id"]
    of_state = _of_state(measured, state)
    rows = judged_rows(detector, measured.healthy, of_state, specimen)
    found = HeldOut(UNDEFINED, "", 0)
    if rows.size:
        folds = DESIGN.dealt(specimen, seed)[:, rows]
        found = held_out(detector, rows, of_state[rows], specimen[rows], folds, seed)
    sizes, kind = damage_sizes(measured, of_state), damage_kind(labels, of_state)
    return Detectability(state, kind, sizes, found.auc, found.specimens, found.basis, detector.tried)


def _of_state(measured: MeasuredSet, state: str) -> np.ndarray:
    return np.asarray((measured.labels["state"] == state) & ~measured.healthy)


def chance_limit(
    measured: MeasuredSet, detectors: Sequence[Entry], seed: int, advance: Callable[[], None]
) -> ChanceLimit:
    """Return what the strongest detector reaches by chance, state by state, each on its own records.

    Parameters
    ----------
    measured, detectors, seed
        As of `bank_detections`.
    advance : callable
        Called after every state.
    """
    asked = [detector for detector in detectors if detector.many]
    found = {}
    for state in damaged_states(measured):
        law = state_chance(measured, asked, state, seed)
        if law is not None:
            found[state] = law
        advance()
    least = min((law.auc for law in found.values() if math.isfinite(law.auc)), default=math.nan)
    return ChanceLimit(least, len(asked), PERMUTATIONS if found else 0, found)


def state_chance(measured: MeasuredSet, asked: Sequence[Entry], state: str, seed: int) -> StateChance | None:
    """Return what the strongest of some detectors reaches on a state by chance; None where none could be asked."""
    maxima, unit = permuted_maxima(measured, asked, state, seed, PERMUTATIONS)
    if not unit:
        return None
    stated, drawn = maxima[0], maxima[1:][np.isfinite(maxima[1:])]
    p_value = float((1 + np.sum(drawn >= stated)) / (1 + drawn.size)) if np.isfinite(stated) else math.nan
    return StateChance(exceeded_by_chance(drawn), p_value, unit)


def permuted_maxima(
    measured: MeasuredSet, asked: Sequence[Entry], state: str, seed: int, turns: int
) -> tuple[np.ndarray, str]:
    """Return the largest AUC over detectors of a state as it is, then permuted, (turns + 1,), and within what.

    That is empty where none could be asked.
    """
    specimen, of_state = measured.labels["specimen_id"], _of_state(measured, state)
    able = [detector for detector in asked if judged_rows(detector, measured.healthy, of_state, specimen).size]
    if not able:
        return np.empty(0), ""
    rows = np.flatnonzero(measured.healthy | of_state)
    given = of_state[rows], exchange_blocks(measured)[rows], specimen[rows]
    ways = np.concatenate([of_state[None, rows], permuted(*given, seed, turns)])
    folds = DESIGN.dealt(specimen, seed)[:, rows]
    return bank_maxima(able, rows, ways, specimen[rows], folds), exchanged_unit(*given)


def exceeded_by_chance(maxima: np.ndarray) -> float:
    """Return the limit that another maximum of the same law exceeds in 5 % of the cases at most; NaN without any.

    Of n + 1 exchangeable numbers each is as likely to be the largest. So the limit is number ceil(0.95 (n + 1)) of n,
    the largest where that is beyond it; a quantile of the n would be exceeded more often. Where the largest itself
    comes in more than 5 %, no AUC can be told from chance, and the limit is 1: four gearboxes with a healthy and a
    damaged record each can be stated in 16 ways only. Derived.
    """
    if maxima.size == 0:
        return math.nan
    if np.sum(maxima == maxima.max()) > (1.0 - LEVEL) * (maxima.size + 1) + 1e-9:
        return 1.0
    place = math.ceil(LEVEL * (maxima.size + 1) - 1e-9)
    return float(np.sort(maxima)[min(place, maxima.size) - 1])


LEAK = "sham_told_from_healthy"


@dataclass(frozen=True, slots=True)
class ShamFound:
    """The strongest detector on one sham, and what chance reaches.

    Attributes
    ----------
    state, side, detector : str
        `side` says what the detectors see.
    auc : Interval
        Against the other healthy records, on gearboxes that were not learnt from.
    chance : StateChance, optional
        Of all detectors that can be permuted.
    reached : dict of str to float
        AUC of every detector.
    """

    state: str
    side: str
    detector: str
    auc: Interval
    chance: StateChance | None
    reached: dict[str, float]

    @property
    def told(self) -> bool:
        """Whether detectors reach more than chance does in 5 % of the cases."""
        return self.chance is not None and self.chance.p_value <= 0.05

    def numbers(self) -> dict[str, Any]:
        """Return everything for JSON."""
        return {
            "state": self.state,
            "side": self.side,
            "detector": self.detector,
            "auc": self.auc,
            "chance": self.chance,
            "told": self.told,
            "auc_by_detector": self.reached,
        }


def shams_found(measured: MeasuredSet, sides: Mapping[str, Sequence[Entry]], seed: int) -> tuple[ShamFound, ...]:
    """Return what detectors reach on every sham of a set, by what they see.

    None for a set without a sham, with too few gearboxes, or without a healthy record that a sham can stand beside.
    """
    labels = measured.labels
    if SHAM not in labels:
        return ()
    sham = labels[SHAM].astype(bool)
    # As the bank judges damage: a sham's records are no healthy ones while it is asked for.
    asked = replace(measured, labels={**labels, "fault": np.where(sham, SHAM, labels["fault"])})
    states = dict.fromkeys(labels["state"][sham].tolist())
    found = (_sham_found(asked, side, bank, state, seed) for state in states for side, bank in sides.items())
    return tuple(one for one in found if one is not None)


def _sham_found(asked: MeasuredSet, side: str, detectors: Sequence[Entry], state: str, seed: int) -> ShamFound | None:
    every = [(detection_by(asked, one, state, seed).auc, one.name) for one in detectors]
    defined = [(auc, name) for auc, name in every if math.isfinite(auc.value)]
    if not defined:
        return None
    auc, name = max(defined, key=lambda entry: entry[0].value)
    chance = state_chance(asked, [one for one in detectors if one.many], state, seed)
    return ShamFound(state, side, name, auc, chance, {name: auc.value for auc, name in defined})


def sham_leaks(found: Sequence[ShamFound]) -> list[Finding]:
    """Return a finding for every sham that detectors tell better than in any of the permutations.

    That happens to one of 500 sets without a leak, by each side.
    """
    return [
        Finding(
            LEAK,
            f"{one.detector} tells {one.state}, damage without any effect, from healthy records with an AUC of "
            f"{one.auc.value:.2f} ({one.auc.low:.2f} to {one.auc.high:.2f})",
            f"in none of {PERMUTATIONS} permutations the strongest detector reaches as much",
            "Find what differs between records of damaged states and healthy ones besides the teeth: what was drawn, "
            "in which order, by which program.",
        )
        for one in found
        if one.chance is not None and one.chance.p_value * (1 + PERMUTATIONS) < 1.5
    ]


def sham_sentences(found: Sequence[ShamFound]) -> list[str]:
    """Say in one sentence how well the shams of a set are told from healthy records; nothing without any."""
    if not found:
        return []
    worst = max(found, key=lambda one: (one.told, one.auc.value))
    reached = f"an AUC of {decimal(worst.auc.value)} ({limits(worst.auc)}) by {worst.detector} on {worst.state}"
    chance = worst.chance.auc if worst.chance else math.nan
    by_chance = f"; chance reaches {decimal(chance)} in 5 % of the cases" if math.isfinite(chance) else ""
    if worst.told:
        return [
            f"A sham, damage without effect, is told from {HEALTHY}: {reached}{by_chance}. Only more than that counts."
        ]
    return [f"Shams, damage without effect, are not told from {HEALTHY}: at most {reached}{by_chance}."]
