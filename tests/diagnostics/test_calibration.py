"""Calibration finds the temperature that was put in, and its error is the gap between confidence and accuracy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diagnostics.calibration import calibrated, expected_calibration_error, fitted_temperature, tempered
from diagnostics.evaluation import Predictions

CLASSES = ("healthy", "slight", "severe")


def drawn(count: int, sharpening: float) -> Predictions:
    """Truth drawn from honest probabilities, which are then stated `sharpening` times too sure."""
    rng = np.random.default_rng(3)
    honest = rng.dirichlet(np.ones(3), size=count)
    truth = np.array([rng.choice(3, p=row) for row in honest])
    return Predictions(CLASSES, truth, tempered(honest, 1.0 / sharpening), np.arange(count))


@pytest.mark.parametrize("sharpening", [0.5, 1.0, 3.0])
def test_the_temperature_undoes_what_made_probabilities_too_sure(sharpening: float) -> None:
    found = drawn(4000, sharpening)
    temperature = fitted_temperature(found)
    assert temperature == pytest.approx(sharpening, rel=0.1)  # 4000 draws fix it to about 3 %
    ones = np.ones((1, 4000))
    # binomial noise of the ten bins leaves about 0.015 of an honest classifier
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


def test_without_validation_records_nothing_is_changed() -> None:
    empty = Predictions(CLASSES, np.empty(0, dtype=int), np.empty((0, 3)), np.empty(0, dtype=int))
    assert fitted_temperature(empty) == 1.0
