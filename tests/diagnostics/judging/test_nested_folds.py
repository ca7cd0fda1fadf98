"""Nested folds judge every gearbox by a classifier that has not seen it, and say what becomes of unknown classes."""

from __future__ import annotations

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.nested_folds import KNOWN_ACCEPTED, Nested, Stranger, nested_folds
from diagnostics.records.state_classes import CLASS
from diagnostics.training.splits import specimen_split

GEARBOXES = 20
STATES = ("healthy", "pitting", "crack", "wear")


def matrix_of(values_of, states: tuple[str, ...] = STATES) -> FeatureMatrix:
    """Return one record of each state of each gearbox; `values_of(gearbox, state, rng)` gives its columns."""
    rng = np.random.default_rng(5)
    rows = [(gearbox, place) for gearbox in range(GEARBOXES) for place in range(len(states))]
    values = np.array([values_of(gearbox, place, rng) for gearbox, place in rows])
    names = np.array([states[place] for _, place in rows])
    gearbox = np.array([one for one, _ in rows])
    labels = {
        "specimen_id": gearbox,
        "record_id": np.arange(len(rows)),
        "state": names,
        "state_id": np.array([place for _, place in rows]),
        "fault": names,
        "split": np.array(["train", "train", "train", "validation", "test"])[gearbox % 5],
        CLASS: names,
    }
    return FeatureMatrix(values, tuple(f"column_{i}" for i in range(values.shape[1])), labels)


def judged(matrix: FeatureMatrix) -> Nested:
    found = nested_folds(matrix, specimen_split(matrix.labels), seed=3)
    assert found is not None
    return found


def test_every_gearbox_is_judged_once_and_classes_far_apart_are_told() -> None:
    found = judged(matrix_of(lambda _, place, rng: 6.0 * np.eye(4)[place] + rng.normal(0.0, 0.3, 4)))
    assert found.scores.specimens == GEARBOXES
    assert np.array_equal(found.scores.confusion, GEARBOXES * np.eye(4, dtype=int))
    assert found.scores.macro_auroc.value == 1.0


def test_what_marks_a_gearbox_and_not_its_state_is_worth_nothing() -> None:
    marks = np.random.default_rng(7).normal(0.0, 1.0, (GEARBOXES, 40))
    found = judged(matrix_of(lambda gearbox, _, rng: marks[gearbox] + rng.normal(0.0, 0.01, 40)))
    assert found.scores.macro_auroc.low < 0.5 < found.scores.macro_auroc.high


def test_an_unknown_class_is_called_what_it_looks_like_and_one_between_two_classes_something_else() -> None:
    places = {"healthy": (0.0, 0.0), "pitting": (8.0, 0.0), "crack": (0.0, 0.0), "wear": (4.0, 0.0)}

    def left_out(name: str) -> Stranger:
        states = ("healthy", "pitting", name)
        found = judged(matrix_of(lambda _, at, rng: places[states[at]] + rng.normal(0.0, 0.25, 2), states))
        return next(one for one in found.strangers if one.name == name)

    assert left_out("crack").called["healthy"] > 1.0 - 2.0 * (1.0 - KNOWN_ACCEPTED)
    assert left_out("wear").rejected > 0.5


def test_two_gearboxes_are_too_few() -> None:
    matrix = matrix_of(lambda _, place, rng: 6.0 * np.eye(4)[place] + rng.normal(0.0, 0.3, 4))
    few = matrix.rows(matrix.labels["specimen_id"] < 2)
    assert nested_folds(few, specimen_split(matrix.labels), seed=3) is None
