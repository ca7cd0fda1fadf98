"""Whether probabilities mean what they say: one temperature fitted on validation specimens, and the error that is left.

Probabilities are raised to the power 1/T and normalised, T minimising the log loss of validation specimens; a single
number, since few specimens carry no more. Source: Guo et al. 2017 (temperature scaling, expected calibration error).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.statistics.evaluation import Interval, Predictions, bootstrap_weights, interval

BINS = 10
SMALLEST_PROBABILITY = 1e-12
TEMPERATURES = (0.5, 4.0)
"""Limits of the search; separable validation specimens would otherwise drive T to zero."""

FEWEST_SPECIMENS = 3
"""Validation specimens below which probabilities stay as they are."""

SHRINKING_SPECIMENS = 10
"""Specimens at which log T is halved; with 5 of quickstart the log loss of test specimens then rose by 0.02 at most."""

HONEST_DRAWS = 200
"""Draws of labels for the error that perfectly calibrated probabilities would show."""


@dataclass(frozen=True, slots=True)
class TemperatureScaling:
    """Temperature, and what the probabilities of test specimens are worth without and with it.

    Attributes
    ----------
    temperature : float
        From validation specimens.
    before, after : Interval
        Expected calibration error without and with the temperature.
    honest : float
        Mean expected calibration error of the probabilities with the temperature, were they true: labels drawn from
        them. Few records show an error even then.
    brier_before, brier : Interval
        Brier score without and with the temperature: summed squares over the classes, mean over the records, 0 .. 2.
    """

    temperature: float
    before: Interval
    after: Interval
    honest: float
    brier_before: Interval
    brier: Interval


def tempered(probability: np.ndarray, temperature: float) -> np.ndarray:
    """Return probabilities (n, classes) raised to 1/temperature and normalised; zero stays zero."""
    log = np.log(np.maximum(probability, SMALLEST_PROBABILITY)) / temperature
    powered = np.where(probability > 0.0, np.exp(log - log.max(axis=1, keepdims=True)), 0.0)
    return np.asarray(powered / powered.sum(axis=1, keepdims=True))


def fitted_temperature(predictions: Predictions) -> float:
    """Return the temperature for validation records, 1 where it does not help specimens that it was not fitted on.

    Two things make a fitted T untrue, and each has its own remedy. Few validation specimens carry a chance T: it is
    fitted anew without each specimen and judged on that one, and only where the mean log loss of those left out falls
    is the T of all of them taken. And those specimens chose the epoch as well, which flatters the model on all of them
    alike, so that leaving one out does not show it: log T is shrunk by n / (n + 10) for n specimens, to a third of
    itself with five of them and to three quarters with 32.

    Parameters
    ----------
    predictions : Predictions
        Of validation records; fewer than three specimens leave 1.

    Source: standard literature (cross-validation); derived for the rule.
    """
    groups = np.unique(predictions.specimen)
    if groups.size < FEWEST_SPECIMENS:
        return 1.0
    change = 0.0
    for group in groups:
        left = predictions.specimen == group
        temperature = _lowest(predictions_of(predictions, ~left))
        found = predictions_of(predictions, left)
        change += _log_loss(found, temperature) - _log_loss(found, 1.0)
    if change >= 0.0:
        return 1.0
    return float(_lowest(predictions) ** (groups.size / (groups.size + SHRINKING_SPECIMENS)))


def predictions_of(predictions: Predictions, chosen: np.ndarray) -> Predictions:
    """Return the predictions of some records; `chosen` are their numbers, or (n,) bool."""
    truth, probability, specimen = predictions.truth, predictions.probability, predictions.specimen
    return replace(predictions, truth=truth[chosen], probability=probability[chosen], specimen=specimen[chosen])


def _log_loss(predictions: Predictions, temperature: float) -> float:
    right = tempered(predictions.probability, temperature)[np.arange(predictions.truth.size), predictions.truth]
    return float(-np.log(np.maximum(right, SMALLEST_PROBABILITY)).mean())


def _lowest(predictions: Predictions) -> float:
    """Return the temperature with the lowest log loss."""
    from scipy.optimize import minimize_scalar

    found = minimize_scalar(
        lambda log_temperature: _log_loss(predictions, float(np.exp(log_temperature))),
        bounds=tuple(np.log(TEMPERATURES)),
        method="bounded",
    )
    return float(np.exp(found.x))


def calibrated(predictions: Predictions, temperature: float) -> Predictions:
    """Return the predictions at a temperature."""
    return replace(predictions, probability=tempered(predictions.probability, temperature))


def expected_calibration_error(predictions: Predictions, weights: np.ndarray) -> np.ndarray:
    """Return the mean gap between confidence and accuracy over ten bins of confidence, for every row of weights.

    Parameters
    ----------
    predictions : Predictions
        Of n records.
    weights : (b, n) float64
        One row per resample.

    Returns
    -------
    (b,) float64
        0: of records called with 80 % confidence, 80 % are right; 1 at most.
    """
    confidence = predictions.probability.max(axis=1)
    gap = (predictions.predicted == predictions.truth) - confidence
    bins = np.minimum((confidence * BINS).astype(np.int64), BINS - 1)
    sums = np.stack([weights[:, bins == k] @ gap[bins == k] for k in range(BINS)])
    return np.asarray(np.abs(sums).sum(axis=0) / weights.sum(axis=1))


def honest_calibration_error(predictions: Predictions, seed: int) -> float:
    """Return the mean expected calibration error with labels drawn from the probabilities themselves.

    The calibration error is a mean of absolute gaps, so that chance alone makes it positive; only what exceeds this
    speaks against the probabilities.
    """
    rng = generator(seed, Purpose.CALIBRATION)
    edges = np.cumsum(predictions.probability, axis=1)[:, :-1]
    ones = np.ones((1, predictions.truth.size))
    found = [
        expected_calibration_error(replace(predictions, truth=(u[:, None] >= edges).sum(axis=1)), ones)[0]
        for u in rng.random((HONEST_DRAWS, predictions.truth.size))
    ]
    return float(np.mean(found))


def brier_score(predictions: Predictions, weights: np.ndarray) -> np.ndarray:
    """Return the Brier score over all classes, (b,), for every row of weights (b, n).

    0: certain and right; 2: certain and wrong; (K - 1)/K: all K classes equally probable. Source: Brier 1950.
    """
    truth = np.eye(len(predictions.classes))[predictions.truth]
    square = ((predictions.probability - truth) ** 2).sum(axis=1)
    return np.asarray(weights @ square / weights.sum(axis=1))


def calibration(test: Predictions, temperature: float, seed: int) -> TemperatureScaling:
    """Judge the calibration of uncalibrated test predictions with intervals from resampled specimens."""
    weights = bootstrap_weights(test.specimen, seed)
    specimens = int(np.unique(test.specimen).size)
    changed = calibrated(test, temperature)

    def judged(score: Callable[[Predictions, np.ndarray], np.ndarray], found: Predictions) -> Interval:
        return interval(score(found, weights), specimens)

    return TemperatureScaling(
        temperature,
        before=judged(expected_calibration_error, test),
        after=judged(expected_calibration_error, changed),
        honest=honest_calibration_error(changed, seed),
        brier_before=judged(brier_score, test),
        brier=judged(brier_score, changed),
    )
