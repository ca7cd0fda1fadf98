"""Calibration finds the temperature that was put in, and its error is the gap between confidence and accuracy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diagnostics.statistics.calibration import (
    brier_score,
    calibrated,
    calibration,
    expected_calibration_error,
    fitted_temperature,
    honest_calibration_error,
    tempered,
)
from diagnostics.statistics.evaluation import Predictions

CLASSES = ("healthy", "slight", "severe")


def drawn(count: int, sharpening: float) -> Predictions:
    """Truth drawn from honest probabilities, which are then stated `sharpening` times too sure."""
    rng = np.random.default_rng(3)
    honest = rng.dirichlet(np.ones(3), size=count)
    truth = np.array([rng.choice(3, p=row) for row in honest])
    return Predictions(CLASSES, truth, tempered(honest, 1.0 / sharpening), np.arange(count) // 10)


@pytest.mark.parametrize("sharpening", [0.5, 3.0])
def test_the_temperature_undoes_what_made_probabilities_too_sure(sharpening: float) -> None:
    found = drawn(2500, sharpening)
    temperature = fitted_temperature(found)
    assert temperature == pytest.approx(sharpening, rel=0.1)  # 2500 draws fix it to about 4 %
    ones = np.ones((1, 2500))
    # binomial noise of the ten bins leaves about 0.02 of an honest classifier
    assert expected_calibration_error(calibrated(found, temperature), ones)[0] < 0.03


def test_the_error_is_the_gap_between_confidence_and_accuracy() -> None:
    probability = np.tile([0.85, 0.1, 0.05], (10, 1))
    truth = np.array([0] * 6 + [1] * 4)
    found = Predictions(CLASSES, truth, probability, np.arange(10))
    assert expected_calibration_error(found, np.ones((1, 10)))[0] == pytest.approx(0.25)
    only_right = np.array([[1.0] * 6 + [0.0] * 4])
    assert expected_calibration_error(found, only_right)[0] == pytest.approx(0.15)


@given(
    values=st.lists(st.floats(0.0, 1.0), min_size=3, max_size=3).filter(lambda row: sum(row) > 0.01),
    temperature=st.floats(0.05, 20.0),
)
def test_a_temperature_keeps_order_zeros_and_sum(values: list[float], temperature: float) -> None:
    probability = np.array([values]) / sum(values)
    found = tempered(probability, temperature)
    assert found.sum() == pytest.approx(1.0)
    assert (found[probability == 0.0] == 0.0).all()
    ordered = found[0][np.argsort(probability[0], kind="stable")]
    assert (np.diff(ordered) >= -1e-12).all()


def gearboxes(right: np.ndarray, confidence: float) -> Predictions:
    """Four records of each gearbox, three classes, called with one confidence; `right` says which gearboxes are."""
    truth = np.tile([0, 1, 2, 0], right.size)
    named = np.where(np.repeat(right, 4), truth, (truth + 1) % 3)
    probability = np.full((truth.size, 3), (1.0 - confidence) / 2.0)
    probability[np.arange(truth.size), named] = confidence
    return Predictions(CLASSES, truth, probability, np.repeat(np.arange(right.size), 4))


def test_a_temperature_that_does_not_help_gearboxes_left_out_of_its_fit_is_not_taken() -> None:
    one_of_five_wrong = np.arange(5) > 0
    # all five ask for 0.8 instead of 0.7; but without the wrong one four would ask for much more, which it contradicts
    assert fitted_temperature(gearboxes(one_of_five_wrong, 0.7)) == 1.0
    # far too sure: every choice of four asks for less, and the fifth gains by it
    assert fitted_temperature(gearboxes(np.arange(5) > 1, 0.99)) > 1.3


def test_records_of_one_gearbox_are_left_out_together() -> None:
    found = gearboxes(np.arange(5) > 0, 0.7)
    copies = Predictions(CLASSES, *(np.repeat(x, 3, axis=0) for x in (found.truth, found.probability, found.specimen)))
    assert fitted_temperature(copies) == fitted_temperature(found) == 1.0
    # the same as 60 gearboxes, 48 of which are right: one left out hardly changes what the others ask for
    assert fitted_temperature(replace(copies, specimen=np.arange(60))) < 0.9


@pytest.mark.parametrize(("count", "share"), [(3, 3 / 13), (5, 1 / 3), (40, 0.8)])
def test_perfect_validation_gearboxes_sharpen_by_how_many_they_are(count: int, share: float) -> None:
    found = fitted_temperature(gearboxes(np.ones(count, dtype=bool), 0.6))
    assert found == pytest.approx(0.5**share, abs=0.005)  # the limit of the search, met within its tolerance


@pytest.mark.parametrize("count", [0, 1, 2])
def test_with_too_few_validation_gearboxes_nothing_is_changed(count: int) -> None:
    assert fitted_temperature(gearboxes(np.ones(count, dtype=bool), 0.6)) == 1.0


def test_the_error_of_true_probabilities_is_that_of_repeated_honest_draws() -> None:
    few, many = drawn(20, 1.0), drawn(4000, 1.0)
    ones = np.ones((1, 20))
    rng = np.random.default_rng(8)
    errors = []
    for _ in range(400):
        truth = np.array([rng.choice(3, p=row) for row in few.probability])
        errors.append(expected_calibration_error(replace(few, truth=truth), ones)[0])
    found = honest_calibration_error(few, seed=0)
    # the mean of 200 and that of 400 draws with a scatter of 0.05 each: 0.0045, three of which are allowed
    assert found == pytest.approx(np.mean(errors), abs=0.015)
    assert found > 0.1  # so much of the error of 20 records says nothing
    assert honest_calibration_error(many, seed=0) < 0.03
    assert found == honest_calibration_error(few, seed=0)


def test_brier_score_is_that_of_scikit_learn_and_known_at_its_ends() -> None:
    from sklearn.metrics import brier_score_loss

    found = drawn(50, 1.5)
    weights = np.random.default_rng(1).integers(1, 4, (3, 50)).astype(float)
    summed = [
        sum(brier_score_loss(found.truth == k, found.probability[:, k], sample_weight=row) for k in range(3))
        for row in weights
    ]
    assert brier_score(found, weights) == pytest.approx(summed)
    ends = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1 / 3, 1 / 3, 1 / 3]])
    scored = Predictions(CLASSES, np.zeros(3, dtype=int), ends, np.arange(3))
    assert brier_score(scored, np.eye(3)) == pytest.approx([0.0, 2.0, 2 / 3])


def test_calibration_tells_scores_without_and_with_the_temperature() -> None:
    found = drawn(400, 3.0)
    told = calibration(found, 3.0, seed=0)
    assert told.after.value < told.before.value
    assert told.brier.value < told.brier_before.value
    assert told.brier.low < told.brier.value < told.brier.high
    # 3.0 makes the probabilities honest: the error is that of chance, with a scatter of about 0.015
    assert told.after.value == pytest.approx(told.honest, abs=0.04)
    assert told.before.value > told.honest + 0.1


def test_without_validation_records_nothing_is_changed() -> None:
    empty = Predictions(CLASSES, np.empty(0, dtype=int), np.empty((0, 3)), np.empty(0, dtype=int))
    assert fitted_temperature(empty) == 1.0
