"""Whether probabilities mean what they say: one temperature fitted on validation specimens, and the error that is left.

Probabilities are raised to the power 1/T and normalised, T minimising the log loss of validation specimens; a single
number, since few specimens carry no more. Source: Guo et al. 2017 (temperature scaling, expected calibration error).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from diagnostics.evaluation import RESAMPLES, Interval, Predictions, bootstrap_weights, interval

BINS = 10
SMALLEST_PROBABILITY = 1e-12
TEMPERATURES = (0.05, 20.0)
"""Limits of the search; separable validation specimens would otherwise drive T to zero."""


@dataclass(frozen=True, slots=True)
class Calibration:
    """Temperature, and expected calibration error on test specimens without and with it."""

    temperature: float
    before: Interval
    after: Interval


def tempered(probability: np.ndarray, temperature: float) -> np.ndarray:
    """Return probabilities (n, classes) raised to 1/temperature and normalised; zero stays zero."""
    log = np.log(np.maximum(probability, SMALLEST_PROBABILITY)) / temperature
    powered = np.where(probability > 0.0, np.exp(log - log.max(axis=1, keepdims=True)), 0.0)
    return np.asarray(powered / powered.sum(axis=1, keepdims=True))


def fitted_temperature(predictions: Predictions) -> float:
    """Return the temperature that minimises the log loss of validation records; 1 where there are none."""
    if not predictions.truth.size:
        return 1.0
    from scipy.optimize import minimize_scalar

    rows = np.arange(predictions.truth.size)

    def loss(log_temperature: float) -> float:
        right = tempered(predictions.probability, float(np.exp(log_temperature)))[rows, predictions.truth]
        return float(-np.log(np.maximum(right, SMALLEST_PROBABILITY)).mean())

    found = minimize_scalar(loss, bounds=tuple(np.log(TEMPERATURES)), method="bounded")
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


def calibration(test: Predictions, temperature: float, seed: int, resamples: int = RESAMPLES) -> Calibration:
    """Judge the calibration of uncalibrated test predictions with intervals from resampled specimens."""
    weights = bootstrap_weights(test.specimen, seed, resamples)
    specimens = int(np.unique(test.specimen).size)
    before, after = (
        interval(expected_calibration_error(found, weights), specimens)
        for found in (test, calibrated(test, temperature))
    )
    return Calibration(temperature, before, after)
