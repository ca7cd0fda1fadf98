"""One number per record as an alarm for damage: best single indicator, classifiers and a network.

Indicator and classifiers are judged on every gearbox: what scores a fold was chosen or trained on the others. Penalty
and number of trees are fixed, so nothing is chosen on what is judged; neither is which of them is the strongest.
Networks are judged on the test gearboxes only, since training them again for every fold costs minutes.

Told are its AUC by state, and the size that it finds in nine of ten records. Sizes mean something among damages of one
kind only, so every kind has its own. An alarm is a score above the quantile of healthy records that leaves the false
alarms above it; with few healthy records such a quantile does not exist, and no size is given. Intervals come from
resampled gearboxes, and the threshold is drawn anew in each. Source: probability of detection (a90), standard
literature of non-destructive testing; see `detectable_size` for the curve.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.evaluation import Design, Entry, chosen_scores, inner_scores, pooled_scores
from diagnostics.judging.judgement import NETWORK, NETWORK_REFERENCED, TITLES, Judged, damage_score
from diagnostics.judging.learners import BestColumn, Odds
from diagnostics.judging.of_split import Training
from diagnostics.records.gear_train import PAIR, GearNames
from diagnostics.records.state_classes import CLASS, HEALTHY, SHAM, damage_kinds, ordered_states
from diagnostics.statistics.detectable_size import detection_curve, size_at, weighted_quantile
from diagnostics.statistics.evaluation import Interval, area, area_interval, bootstrap_weights, fewest_gearboxes
from diagnostics.statistics.indicator_statistics import size_interval
from diagnostics.training.feature_classifier import DEFAULT_STRENGTH
from diagnostics.training.referenced import healthy_referenced, healthy_references
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError, counted

FALSE_ALARMS, FOUND, CHANCE = 0.05, 0.9, 0.5
HEADS_STRENGTH = 0.01
"""C of the regression on what the network of many gearboxes says: few numbers, which it has made for this."""
FEWEST_HEALTHY = 20
"""Healthy records from which one in twenty can lie above a threshold."""

RESAMPLES = 400
DESIGN = Design(folds=5, owner=2000)
FEWEST_SPECIMENS = 4
INDICATOR, CLASSIFIER = "best single indicator", "logistic regression on all indicators"
BOOSTED, NETWORKS, CHOSEN = "gradient boosting on all indicators", "network", "chosen"
PRETRAINED = "network of many gearboxes"
CHOICE = "chosen by the other gearboxes"
AREA = "damaged_area_mm2"


@dataclass(frozen=True, slots=True)
class FoundSize:
    """Damaged area [mm^2] from which nine of ten records give an alarm, of one kind of damage.

    Attributes
    ----------
    area_mm2 : Interval
        Infinite where the largest damage is not found so often.
    smallest_mm2, largest_mm2 : float
        Median area of the groups of smallest and largest damage: what is found at the smallest is an upper bound.
    """

    area_mm2: Interval
    smallest_mm2: float
    largest_mm2: float

    @property
    def reached(self) -> bool:
        """Whether any size of the set is found."""
        return bool(np.isfinite(self.area_mm2.value))

    @property
    def is_bound(self) -> bool:
        """Whether the smallest damage of the set is found already."""
        return self.reached and self.area_mm2.value <= self.smallest_mm2 * (1.0 + 1e-9)


@dataclass(frozen=True, slots=True)
class StateFound:
    """One state: kind of damage, median area [mm^2], AUC against healthy, and share of its records with an alarm.

    Records of one gearbox alone give no score: the AUC is NaN.
    """

    kind: str
    area_mm2: float
    auc: Interval
    share: Interval | None


@dataclass(frozen=True, slots=True)
class JudgedDetector:
    """A detector as it was judged.

    Attributes
    ----------
    title : str
        What it is, in words.
    referenced : bool
        Whether it sees a healthy record of the same gearbox.
    every : Interval
        AUC of healthy against all damaged records.
    states : dict of str to StateFound
        Every damaged state, in the order of the configuration.
    sizes : dict of str to FoundSize
        By kind of damage; empty with too few healthy records.
    records, specimens, healthy : int
        On how many records of how many gearboxes it was judged, and how many of them are healthy.
    basis : str
        The column that it took most often, or nothing.
    gears : GearNames
        What columns are called after.
    picks : tuple of (str, int)
        Which detectors it stands for, and in how many folds; empty for one that is always the same.
    sham : Interval, optional
        AUC of the records of shams against other healthy ones, if any: a lower limit above 0.5 tells a leak.
    share : Interval, optional
        Share of all damaged records with an alarm.
    """

    title: str
    referenced: bool
    every: Interval
    states: dict[str, StateFound]
    sizes: dict[str, FoundSize]
    records: int
    specimens: int
    healthy: int
    basis: str = ""
    picks: tuple[tuple[str, int], ...] = ()
    sham: Interval | None = None
    share: Interval | None = None
    gears: GearNames = PAIR

    def tells(self, state: str) -> bool:
        """Whether a state is told from healthy: its lower AUC limit beats chance, its AUC what a sham may reach."""
        auc = self.states[state].auc
        return auc.low > CHANCE and (self.sham is None or auc.value > self.sham.high)

    def loses(self, state: str) -> bool:
        """Whether a state that has a score is not told from healthy."""
        return bool(np.isfinite(self.states[state].auc.value)) and not self.tells(state)

    @property
    def told(self) -> tuple[str, ...]:
        """States that are told from healthy, by their size."""
        return tuple(sorted(filter(self.tells, self.states), key=lambda state: self.states[state].area_mm2))

    @property
    def kinds(self) -> dict[str, list[str]]:
        """States of every kind of damage."""
        kinds: dict[str, list[str]] = {}
        for name, found in self.states.items():
            kinds.setdefault(found.kind, []).append(name)
        return kinds

    @property
    def unjudged(self) -> list[str]:
        """States without a score: they have records of a single gearbox."""
        return [name for name, found in self.states.items() if not np.isfinite(found.auc.value)]

    @property
    def below_chance(self) -> dict[str, Interval]:
        """AUC with limits wholly below chance, of all damage together and of states."""
        asked = {"all damage together": self.every, **{name: found.auc for name, found in self.states.items()}}
        return {name: auc for name, auc in asked.items() if auc.high < CHANCE}

    @property
    def within_sham(self) -> list[str]:
        """States that are found no better than a sham may be."""
        return [name for name, found in self.states.items() if self.sham and found.auc.value <= self.sham.high]

    def __str__(self) -> str:
        """Return AUC and alarms by state, as text."""
        head = f"{self.title}: {self.records} records of {self.specimens} gearboxes; limits of 95 % over gearboxes"
        told = {"every damage": (self.every, self.share)} | {k: (s.auc, s.share) for k, s in self.states.items()}
        told |= {"sham": (self.sham, None)} if self.sham else {}
        rows = [
            f"  {name}: AUC {auc:.3f}" + (f", alarms {share:.0%}" if share else "")
            for name, (auc, share) in told.items()
        ]
        return "\n".join([head, *rows])

    def numbers(self) -> dict[str, Any]:
        """Return everything for JSON; undefined and unreached numbers are null."""
        return {
            "title": self.title,
            "basis": self.basis or None,
            "folds_by_detector": dict(self.picks) or None,
            "healthy_reference": self.referenced,
            "records": self.records,
            "specimens": self.specimens,
            "healthy_records": self.healthy,
            "auc_sham": self.sham.numbers() if self.sham else None,
            "auc": self.every.numbers(),
            "share_of_alarms": self.share.numbers() if self.share else None,
            "states": {
                name: {
                    "kind": found.kind,
                    "damaged_area_mm2": found.area_mm2,
                    "auc": found.auc.numbers(),
                    "told": self.tells(name),
                    "share_of_alarms": found.share.numbers() if found.share else None,
                }
                for name, found in self.states.items()
            },
            "area_found_in_nine_of_ten_mm2": {kind: found.area_mm2.numbers() for kind, found in self.sizes.items()},
        }


def judged_alarm(
    title: str,
    score: np.ndarray,
    labels: Mapping[str, np.ndarray],
    seed: int,
    *,
    referenced: bool = False,
    basis: str = "",
) -> JudgedDetector | None:
    """Judge scores of records that the detector has not learnt from.

    Parameters
    ----------
    title : str
    score : (n,) float64
        Larger means more damage; without NaN.
    labels : mapping of str to (n,)
        Columns `specimen_id`, `state`, `state_id`, `fault`, `damaged_area_mm2`; `through_face` and `sham` where the
        set has them.
    seed : int
        Of the resamples.
    referenced, basis
        As of `JudgedDetector`.

    Returns
    -------
    JudgedDetector or None
        None where records are all healthy or all damaged.
    """
    healthy = labels["fault"] == HEALTHY
    if healthy.all() or not healthy.any():
        return None
    specimen = labels["specimen_id"]
    weights = bootstrap_weights(specimen, seed, RESAMPLES)
    threshold = None
    if healthy.sum() >= FEWEST_HEALTHY:
        threshold = weighted_quantile(score[healthy], weights[:, healthy], 1.0 - FALSE_ALARMS)
    damaged = set(labels["state"][~healthy].tolist())
    kinds = damage_kinds(labels, [state for state in ordered_states(dict(labels)) if state in damaged])
    states = {
        state: _state(kind, score, labels, weights, threshold, labels["state"] == state)
        for kind, members in kinds.items()
        for state in members
    }
    return JudgedDetector(
        title,
        referenced,
        area(score, ~healthy, weights, specimen),
        states,
        _sizes(score, labels, weights, kinds) if threshold is not None else {},
        int(score.size),
        int(np.unique(specimen).size),
        int(healthy.sum()),
        basis,
        sham=_sham_auc(score, labels, weights),
        share=_share(score, labels, weights, threshold, ~healthy),
    )


def _sham_auc(score: np.ndarray, labels: Mapping[str, np.ndarray], weights: np.ndarray) -> Interval | None:
    healthy = labels["fault"] == HEALTHY
    sham = labels[SHAM].astype(bool) if SHAM in labels else np.zeros_like(healthy)
    if not sham.any() or not (healthy & ~sham).any():
        return None
    return area(score[healthy], sham[healthy], weights[:, healthy], labels["specimen_id"][healthy])


def _state(
    kind: str,
    score: np.ndarray,
    labels: Mapping[str, np.ndarray],
    weights: np.ndarray,
    threshold: np.ndarray | None,
    of_state: np.ndarray,
) -> StateFound:
    rows = of_state | (labels["fault"] == HEALTHY)
    auc = area(score[rows], of_state[rows], weights[:, rows], labels["specimen_id"][rows])
    share = _share(score, labels, weights, threshold, of_state) if np.isfinite(auc.value) else None
    return StateFound(kind, float(np.median(labels[AREA][of_state])), auc, share)


def _share(
    score: np.ndarray,
    labels: Mapping[str, np.ndarray],
    weights: np.ndarray,
    threshold: np.ndarray | None,
    asked: np.ndarray,
) -> Interval | None:
    """Return the share of the records asked for with an alarm."""
    if threshold is None:
        return None
    own = weights[:, asked]
    with np.errstate(invalid="ignore"):  # a resample without any of them
        alarms = (own * (score[asked] > threshold[:, None])).sum(axis=1) / own.sum(axis=1)
    return area_interval(alarms, int(np.unique(labels["specimen_id"][asked]).size))


def _sizes(
    score: np.ndarray, labels: Mapping[str, np.ndarray], weights: np.ndarray, kinds: Mapping[str, list[str]]
) -> dict[str, FoundSize]:
    healthy, found = labels["fault"] == HEALTHY, {}
    for kind, members in kinds.items():
        rows = healthy | np.isin(labels["state"], members)
        curve = detection_curve(score[rows], healthy[rows], labels[AREA][rows], weights[:, rows], FALSE_ALARMS)
        if curve is None:
            continue
        reached = size_interval(size_at(curve, FOUND))
        found[kind] = FoundSize(reached, float(curve.size[0]), float(curve.size[-1]))
    return found


@dataclass(frozen=True, slots=True)
class Detectors:
    """Judged detectors, by family, alone and beside healthy records of the same gearbox; a family may be missing."""

    alone: dict[str, JudgedDetector]
    referenced: dict[str, JudgedDetector]
    gearboxes: tuple[int, int] = (0, 0)
    """With healthy, and with damaged records."""

    @property
    def strongest(self) -> JudgedDetector | None:
        """The one that the other gearboxes choose, of those that are judged on all gearboxes without a reference."""
        return self.alone.get(CHOSEN)

    @property
    def strongest_referenced(self) -> JudgedDetector | None:
        """The same beside a healthy record."""
        return self.referenced.get(CHOSEN)


@single_thread()
def judged_detectors(matrix: FeatureMatrix, seed: int, dataset: Dataset | None = None) -> Detectors:
    """Judge all detectors of a set that learn on its indicators, and on what the network of many gearboxes says.

    Parameters
    ----------
    matrix : FeatureMatrix
        All records of the one table of the set.
    seed : int
        Of folds and resampled gearboxes.
    dataset : siggen Dataset, optional
        The set, whose signals that network takes; without it, or where the network does not know such a set, it is
        left out.
    """
    differences, kept = healthy_referenced(matrix)
    said = _network_says(matrix, dataset) if dataset is not None else None
    alone = _cross_fitted(matrix, seed, said and said[0], referenced=False)
    referenced = _cross_fitted(differences, seed, said and said[1][kept], referenced=True) if kept.any() else {}
    healthy = matrix.labels["fault"] == HEALTHY
    gearboxes = tuple(int(np.unique(matrix.groups[side]).size) for side in (healthy, ~healthy))
    return Detectors(alone, referenced, (gearboxes[0], gearboxes[1]))


def _network_says(matrix: FeatureMatrix, dataset: Dataset) -> tuple[np.ndarray, np.ndarray] | None:
    """Return what the network of many gearboxes says of all records, alone and beside healthy ones."""
    from diagnostics.training.shipped_network import gear_averages, heads, knows

    if not knows(dataset):
        return None
    lines = gear_averages(dataset)
    return heads(lines), heads(lines, lines, healthy_references(matrix.labels))


def with_networks(detectors: Detectors, matrix: FeatureMatrix, training: Training, seed: int) -> Detectors:
    """Return the detectors with the networks of a training beside them, which are judged on its test records."""
    test, beside = training.split.test, training.referenced
    alone = detectors.alone | _network(training.judged, NETWORK, matrix.rows(test), training, seed)
    referenced = detectors.referenced
    if beside:
        referenced = referenced | _network(
            beside.judged, NETWORK_REFERENCED, matrix.rows(test & beside.kept), training, seed
        )
    return replace(detectors, alone=alone, referenced=referenced)


def evaluate(
    model: Any, data: FeatureMatrix, *, values: np.ndarray | None = None, beside: bool = False, seed: int = 0
) -> JudgedDetector:
    """Judge a classifier of your own on every gearbox, by what has learnt on others.

    Parameters
    ----------
    model
        Classifier of scikit-learn, or anything with `fit(X, y)` or `fit(X, y, groups)`, and `decision_function(X)` or
        `predict_proba(X)`. Each of five folds fits a copy to whether records are damaged.
    data : FeatureMatrix
        What `diagnostics.table` returned.
    values : (records, ...), optional
        What it sees in place of the indicators, as of a network: `diagnostics.averages(dataset).values`.
    beside : bool
        Whether it sees logarithms minus those of other healthy records of the same gearbox.
    seed : int
        Of folds and resampled gearboxes; 0 gives those of a report.

    Returns
    -------
    JudgedDetector
        AUC of every state with 95 % limits over gearboxes, share of alarms, size found; `print` shows them.

    Raises
    ------
    UsageError
        If the model lacks these methods or fails, the data are no table of states, a score is not finite,
        or fewer than four gearboxes have healthy or damaged records.
    """
    if isinstance(model, type):
        raise UsageError(f"evaluate: received the class {model.__name__}; allowed: one of it, {model.__name__}()")
    if not isinstance(data, FeatureMatrix):
        what = f"{type(data).__name__}; allowed: what diagnostics.table returned, diagnostics.table(siggen.open(...))"
        raise UsageError(f"evaluate: received a {what}")
    if CLASS not in data.labels:
        raise UsageError(
            "evaluate: received records of lives; allowed: a set of states, since damage is judged by state"
        )
    if not hasattr(model, "fit") or not any(hasattr(model, name) for name in ("decision_function", "predict_proba")):
        what = f"{type(model).__name__} without `fit` and `decision_function` or `predict_proba`"
        raise UsageError(f"evaluate: received {what}; allowed: classifiers of scikit-learn, and what has these methods")
    if values is not None and (beside or len(values) != len(data.values)):
        what = "values beside a healthy record" if beside else counted(len(values), "row")
        raise UsageError(
            f"evaluate: received {what}; allowed: without `beside`, one row for each of "
            f"{counted(len(data.values), 'record')} of the table, in its order"
        )
    taken = healthy_referenced(data)[0] if beside else replace(data, values=data.values if values is None else values)
    if too_few(taken):
        damaged = taken.labels["fault"] != HEALTHY
        healthy_of, damaged_of = (np.unique(taken.groups[rows]).size for rows in (~damaged, damaged))
        raise UsageError(
            f"evaluate: received {counted(healthy_of, 'gearbox', 'gearboxes')} with healthy records, {damaged_of} with "
            f"damaged ones; allowed: {FEWEST_SPECIMENS} or more{', each beside another healthy one' * beside}. "
            "Make more: `siggen generate DIR/config.yaml --set specimens=12 --out DIR`"
        )
    entry = Entry(type(model).__name__, lambda: Odds(deepcopy(model)), taken.values, np.ones(len(taken.values), bool))
    damaged, fold = taken.labels["fault"] != HEALTHY, DESIGN.dealt(taken.groups, seed)[0]
    try:
        score = pooled_scores(entry, damaged, taken.groups, fold)[0]
    except (TypeError, ValueError) as error:
        raise UsageError(
            f"evaluate: {entry.name} could not learn or score: {error}. Values are NaN where an indicator is "
            "undefined: a classifier that cannot take them needs make_pipeline(SimpleImputer(), ...)"
        ) from error
    if wrong := int((~np.isfinite(score)).sum()):
        what = f"{type(model).__name__}, whose scores of {wrong} of {len(score)} records are no finite numbers"
        raise UsageError(f"evaluate: received {what}; allowed: a finite score for every record")
    found = judged_alarm(entry.name, score, taken.labels, seed, referenced=beside)
    assert found is not None
    return found


def too_few(matrix: FeatureMatrix) -> bool:
    """Return whether fewer than four gearboxes have healthy, or damaged, records."""
    return fewest_gearboxes(matrix.labels["fault"] != HEALTHY, matrix.groups) < FEWEST_SPECIMENS


def _network(
    judged: tuple[Judged, ...], name: str, rows: FeatureMatrix, training: Training, seed: int
) -> dict[str, JudgedDetector]:
    """Return the network of this name on its test records; empty without it."""
    network = next((entry for entry in judged if entry.name == name), None)
    if network is None or training.split.healthy is None:
        return {}
    score = damage_score(network.predictions, training.split.healthy)
    detector = judged_alarm(TITLES[name], score, rows.labels, seed, referenced=name == NETWORK_REFERENCED)
    return {NETWORKS: detector} if detector else {}


def _entries(matrix: FeatureMatrix, seed: int, said: np.ndarray | None, *, referenced: bool) -> list[Entry]:
    """Return who is judged on all gearboxes; differences of logarithms have been taken beside a reference."""
    from diagnostics.training.classifiers import DEFAULT_TREES, BoostingBaseline, LogisticBaseline

    every, whole = np.ones(len(matrix.values), dtype=bool), np.isfinite(matrix.values).all(axis=0)
    names = [name for name, kept in zip(matrix.names, whole, strict=True) if kept]

    def logistic() -> Odds:
        return Odds(LogisticBaseline((DEFAULT_STRENGTH,), take_logarithms=not referenced))

    found = [
        Entry(INDICATOR, lambda: BestColumn(names, pooled=True), matrix.values[:, whole], every),
        Entry(CLASSIFIER, logistic, matrix.values, every),
        Entry(BOOSTED, lambda: Odds(BoostingBaseline(seed, DEFAULT_TREES)), matrix.values, every),
    ]
    if said is not None:
        found.append(
            Entry(PRETRAINED, lambda: Odds(LogisticBaseline((HEADS_STRENGTH,), take_logarithms=False)), said, every)
        )
    return found if names else found[1:]


def _cross_fitted(
    matrix: FeatureMatrix, seed: int, said: np.ndarray | None, *, referenced: bool
) -> dict[str, JudgedDetector]:
    """Return indicator, classifiers and the choice among them; empty with too few gearboxes of either side."""
    labels, specimen = matrix.labels, matrix.groups
    damaged = labels["fault"] != HEALTHY
    if too_few(matrix):
        return {}
    fold = DESIGN.dealt(specimen, seed)[0]
    entries = _entries(matrix, seed, said, referenced=referenced)
    pooled = {entry.name: pooled_scores(entry, damaged, specimen, fold) for entry in entries}
    inner = {entry.name: inner_scores(entry, damaged, specimen, fold) for entry in entries}
    score, names = chosen_scores({name: scores for name, (scores, _) in pooled.items()}, inner, damaged, fold)
    judged = {}
    for name, (scores, basis) in pooled.items():
        found = judged_alarm(name, scores, labels, seed, referenced=referenced, basis=basis)
        judged[name] = found and replace(found, gears=matrix.gears)
    chosen = judged[names[0]]
    if len(set(names)) > 1:
        mixed = judged_alarm(CHOICE, score, labels, seed, referenced=referenced)
        chosen = replace(mixed, picks=tuple(Counter(names).most_common())) if mixed else None
    return {family: detector for family, detector in {**judged, CHOSEN: chosen}.items() if detector}
