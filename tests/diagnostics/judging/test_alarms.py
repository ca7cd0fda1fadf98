"""What judges a gearbox has not seen it: the best of many columns of noise is chance, one that shows damage is not."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
import pyarrow as pa
import pytest
from sklearn.cluster import KMeans
from sklearn.ensemble import RandomForestClassifier
from sklearn.svm import LinearSVC

import diagnostics
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.alarms import BOOSTED, CHOSEN, CLASSIFIER, DESIGN, INDICATOR, evaluate, judged_detectors
from diagnostics.judging.evaluation import Entry, chosen_scores, distance, inner_scores
from diagnostics.report.answer import ANSWERS
from diagnostics.statistics.evaluation import column_auc
from diagnostics.training.classifiers import LogisticBaseline
from siggen.errors import UsageError

GEARBOXES, NOISE_COLUMNS = 24, 400
STATES = ("healthy", "slight", "severe")


class Loudest:
    """Takes blocks of rows, as a network does."""

    def fit(self, X: np.ndarray, y: np.ndarray) -> None:
        assert X.ndim == 3

    def decision_function(self, X: np.ndarray) -> np.ndarray:
        return np.asarray(X.max(axis=(1, 2)))


class Silent:
    """Scores nothing."""

    def fit(self, X: np.ndarray, y: np.ndarray) -> None:
        pass

    def decision_function(self, X: np.ndarray) -> np.ndarray:
        return np.full(len(X), np.nan)


def matrix_of(values: np.ndarray, healthy_records: int = 1) -> FeatureMatrix:
    states = ("healthy",) * (healthy_records - 1) + STATES
    specimen, place = (part.ravel() for part in np.mgrid[:GEARBOXES, : len(states)])
    state = np.array(states)[place]
    labels = {
        "record_id": np.arange(state.size),
        "specimen_id": specimen,
        "state": state,
        "state_id": np.array([STATES.index(name) for name in state]),
        "fault": np.where(state == "healthy", "healthy", "pitting"),
        "damaged_area_mm2": np.array([(0.0, 1.0, 8.0)[STATES.index(name)] for name in state]),
        "operating_point_id": np.zeros(state.size, int),
        "repeat": np.where(state == "healthy", place, 0),
        "class": state,
    }
    return FeatureMatrix(values, tuple(f"noise_{k}__x" for k in range(values.shape[1])), labels)


def noise(records: int, columns: int = NOISE_COLUMNS) -> np.ndarray:
    return np.random.default_rng(4).lognormal(size=(records, columns))


def test_the_best_of_many_columns_of_noise_is_chance_on_gearboxes_that_did_not_choose_it() -> None:
    matrix = matrix_of(noise(3 * GEARBOXES))
    damaged = matrix.labels["fault"] != "healthy"
    within = np.abs(column_auc(matrix.values, damaged) - 0.5).max()
    found = judged_detectors(matrix, seed=0).alone
    assert within > 0.2  # chosen and judged on the same gearboxes, noise looks like a find
    # 24 healthy against 48 damaged: the standard error of an AUC of noise is 0.07
    for family in (INDICATOR, CLASSIFIER, BOOSTED, CHOSEN):
        assert abs(found[family].every.value - 0.5) < 3 * 0.07


def test_a_column_that_shows_damage_is_chosen_whatever_its_direction() -> None:
    values = noise(3 * GEARBOXES, 60)
    matrix = matrix_of(values)
    values[:, 7] = np.exp(-np.array([STATES.index(name) for name in matrix.labels["state"]]))
    found = judged_detectors(matrix, seed=0)
    single = found.alone[INDICATOR]
    assert single.basis == "noise_7__x"
    assert single.every.value == 1.0
    assert found.strongest is single
    assert not found.referenced  # one healthy record per gearbox: none is left to refer to


def test_a_healthy_reference_removes_what_differs_from_gearbox_to_gearbox() -> None:
    values = noise(4 * GEARBOXES, 60)
    matrix = matrix_of(values, healthy_records=2)
    gearbox = np.exp(np.random.default_rng(5).normal(scale=3.0, size=GEARBOXES))[matrix.labels["specimen_id"]]
    damage = np.array([STATES.index(name) for name in matrix.labels["state"]])
    values[:, 7] = gearbox * np.exp(damage)
    found = judged_detectors(matrix, seed=0)
    beside = found.referenced[INDICATOR]
    assert beside.basis == "noise_7__x"
    assert beside.every.value == 1.0 > found.alone[INDICATOR].every.value


def test_a_state_of_one_gearbox_has_no_score_and_the_answer_says_so() -> None:
    values = noise(3 * GEARBOXES, 6)
    matrix = matrix_of(values)
    values[:, 3] = np.exp(-np.array([STATES.index(name) for name in matrix.labels["state"]]))
    kept = matrix.rows((matrix.labels["state"] != "slight") | (matrix.labels["specimen_id"] == 5))
    found = judged_detectors(kept, seed=0)
    slight = found.alone[CHOSEN].numbers()["states"]["slight"]
    assert slight["auc"]["value"] is slight["share_of_alarms"] is None
    answer = ANSWERS.first_answer(found).replace("\xa0", " ")
    assert "No score for **slight (1 mm²)**: records of a single gearbox; two or more are needed." in answer
    assert "Not told" not in answer
    assert "undefined" not in answer


def test_a_gearbox_is_in_one_fold_and_a_column_with_a_gap_is_not_taken() -> None:
    specimen = np.repeat(np.arange(GEARBOXES), 3)
    fold = DESIGN.dealt(specimen, seed=0)[0]
    assert all(np.unique(fold[specimen == box]).size == 1 for box in range(GEARBOXES))
    values = noise(3 * GEARBOXES)[:, :2]
    matrix = matrix_of(values)
    values[:, 1] = [STATES.index(name) for name in matrix.labels["state"]]
    values[0, 1] = np.nan
    found = judged_detectors(matrix, seed=0).alone
    assert found[INDICATOR].basis == "noise_0__x"
    values[1, 0] = np.nan
    assert INDICATOR not in judged_detectors(matrix, seed=0).alone


class Watching:
    """A detector that notes the folds that it learnt from, and whether it is asked about one of these."""

    seen: ClassVar[list[set[int]]] = []

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> Watching:
        self.own = set(X.tolist())
        self.seen.append(self.own)
        return self

    def score(self, X: np.ndarray) -> np.ndarray:
        assert not self.own & set(X.tolist())
        return np.zeros(X.size)


def test_what_chooses_for_a_fold_saw_neither_it_nor_the_fold_that_it_scores() -> None:
    specimen, damaged = np.repeat(np.arange(GEARBOXES), 3), np.tile([False, True, True], GEARBOXES)
    fold = DESIGN.dealt(specimen, seed=0)[0]
    inner = inner_scores(Entry("watching", Watching, fold, np.ones(fold.size, bool)), damaged, specimen, fold)
    assert {len(own) for own in Watching.seen} == {3}  # of five, without the one left out and the one that is scored
    for row in range(5):
        assert np.array_equal(np.isnan(inner[row]), fold == row)


def test_a_way_that_is_strong_only_where_it_is_judged_is_not_chosen_there() -> None:
    damaged = np.tile([False, True], 30)
    fold = np.repeat(np.arange(5), 12)
    rng = np.random.default_rng(3)
    plain, lucky = damaged + 2.0 * rng.normal(size=60), rng.normal(size=60)
    lucky[fold == 2] = damaged[fold == 2]  # perfect on one fold alone
    outer = {"plain": plain, "lucky": lucky}
    inner = {name: np.where(fold == np.arange(5)[:, None], np.nan, score) for name, score in outer.items()}
    score, names = chosen_scores(outer, inner, damaged, fold)
    # what is seen from the other folds decides: fold 1 takes lucky, since it sees fold 2; fold 2 does not see itself
    assert names == ["plain", "lucky", "plain", "plain", "plain"]
    for row, name in enumerate(names):
        healthy = outer[name][(fold != row) & ~damaged]
        assert np.array_equal(score[fold == row], distance(outer[name][fold == row], healthy))


def test_what_tells_a_sham_is_shown_to_have_found_a_leak(
    dataset: Any, measured: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("diagnostics.indicators.classifier_table.record_table", lambda *_, **__: measured)
    state, specimen = (np.array(dataset.table[name].to_pylist()) for name in ("state", "specimen_id"))
    sham = (state == "healthy") & (specimen % 2 == 1)
    table = diagnostics.table(replace(dataset, table=dataset.table.append_column("sham", pa.array(sham))))
    assert table.roles["sham"] == "target"
    assert "sham" not in diagnostics.table(dataset).labels
    changed = table.labels["sham"] | (table.labels["fault"] != "healthy")
    leaking = evaluate(LinearSVC(), replace(table, values=changed[:, None].astype(float), names=("changed",)))
    assert "sham: AUC 1.000" in str(leaking)
    assert leaking.told == ()  # what is found no better than a sham is not told


def test_any_classifier_is_judged_as_those_of_a_report_are() -> None:
    values = noise(4 * GEARBOXES, 30)
    matrix = matrix_of(values, healthy_records=2)
    values[:, 7] *= np.exp(np.array([STATES.index(name) for name in matrix.labels["state"]]))
    known, own = judged_detectors(matrix, seed=0), LogisticBaseline((0.01,))
    found = evaluate(own, matrix)
    assert found.numbers()["states"] == known.alone[CLASSIFIER].numbers()["states"]
    assert not hasattr(own, "classes_")  # copies were fitted
    differences = LogisticBaseline((0.01,), take_logarithms=False)
    assert evaluate(differences, matrix, beside=True).every == known.referenced[CLASSIFIER].every
    forest = evaluate(RandomForestClassifier(50, random_state=0), matrix)  # takes no groups
    assert forest.states["severe"].auc.low > 0.5
    assert f"severe: AUC {forest.states['severe'].auc.value:.3f}" in str(forest)
    assert evaluate(LinearSVC(), matrix).specimens == GEARBOXES  # has no probabilities
    loudest = evaluate(Loudest(), matrix, values=values.reshape(-1, 3, 10))  # what a network would see
    assert loudest.every == evaluate(Loudest(), replace(matrix, values=values.reshape(-1, 3, 10))).every
    with pytest.raises(UsageError, match=r"received 5 rows; allowed: .*one row for each of \d+ records of the table"):
        evaluate(Loudest(), matrix, values=values[:5])
    with pytest.raises(UsageError, match=r"received the class LinearSVC; allowed: one of it, LinearSVC\(\)$"):
        evaluate(LinearSVC, matrix)
    with pytest.raises(UsageError, match=r"received a ndarray; allowed: what diagnostics\.table returned"):
        evaluate(own, values)  # type: ignore[arg-type]
    gaps = replace(matrix, values=np.where(np.arange(30) == 3, np.nan, values))
    with pytest.raises(
        UsageError, match=r"(?s)LinearSVC could not learn or score: .*NaN.* make_pipeline\(SimpleImputer"
    ):
        evaluate(LinearSVC(), gaps)
    with pytest.raises(UsageError, match=r"received KMeans without `fit` and `decision_function` or `predict_proba`"):
        evaluate(KMeans(2), matrix)
    with pytest.raises(UsageError, match=r"received Silent, whose scores of \d+ of \d+ records are no finite numbers"):
        evaluate(Silent(), matrix)
    with pytest.raises(
        UsageError, match=r"received 3 gearboxes with healthy records, 3 with damaged.*specimens=12 --out DIR`$"
    ):
        evaluate(own, matrix.rows(matrix.groups < 3))
