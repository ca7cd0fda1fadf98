"""What is known about one classifier after its test: scores, calibration, control, detection, differences from others.

Detection: how well 1 - p(healthy) tells damaged records from healthy ones, for each damage too. One number per record
serves for every damage, as an alarm would; it is not tuned to one of them.

Differences are paired: two intervals that overlap say little, since both classifiers meet the same easy and hard
specimens. Intervals from resampled specimens, for both the same. Source: standard literature (Mann-Whitney, paired
bootstrap).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.statistics.calibration import TemperatureScaling, calibrated, calibration, predictions_of
from diagnostics.statistics.evaluation import (
    UNKNOWN,
    Interval,
    IntervalScores,
    Predictions,
    area,
    bootstrap_weights,
    interval,
    macro_auroc,
    scores,
    weighted_auc,
)

INDICATORS, BOOSTING, RMS_ALONE, NETWORK = "indicators", "boosting", "rms", "network"
NETWORK_REFERENCED, REFERENCED = "network_referenced", "healthy_referenced"
TITLES = {
    INDICATORS: "logistic regression on indicators",
    BOOSTING: "gradient boosting on indicators",
    RMS_ALONE: "RMS alone",
    NETWORK: "1-D network",
    REFERENCED: "logistic regression beside a healthy record",
    NETWORK_REFERENCED: "1-D network beside a healthy record",
}

VALIDATION_AUROC = "validation_macro_auroc"

SATURATED = 0.95
"""AUC of the level alone from which a state is called found by the level."""


@dataclass(frozen=True, slots=True)
class Detection:
    """AUC of healthy records against all damaged ones, and against those of each damaged class, by class."""

    every: Interval
    by_class: dict[str, Interval]


def damage_score(found: Predictions, healthy: str) -> np.ndarray:
    """Return 1 - p(healthy) of every record, (n,)."""
    return np.asarray(1.0 - found.probability[:, found.classes.index(healthy)])


def detection(found: Predictions, healthy: str, seed: int) -> Detection | None:
    """Judge predictions as an alarm for damage.

    Parameters
    ----------
    found : Predictions
        Of the records to judge on.
    healthy : str
        The healthy class.
    seed : int
        Seed of the resamples, the same as of all other scores.

    Returns
    -------
    Detection or None
        None where the records are all healthy or all damaged; a damaged class without records is left out.
    """
    own = found.classes.index(healthy)
    score, positive = damage_score(found, healthy), found.truth != own
    if positive.all() or not positive.any():
        return None
    weights = bootstrap_weights(found.specimen, seed)

    def judged(chosen: np.ndarray) -> Interval:
        return area(score[chosen], positive[chosen], weights[:, chosen], found.specimen[chosen])

    present = [k for k in range(len(found.classes)) if k != own and (found.truth == k).any()]
    return Detection(
        every=judged(np.ones(positive.size, dtype=bool)),
        by_class={found.classes[k]: judged(~positive | (found.truth == k)) for k in present},
    )


def detection_metrics(found: Detection | None) -> dict[str, Any] | None:
    """Return what `metrics.json` says about it."""
    if found is None:
        return None
    return {
        "auroc": found.every.numbers(),
        "auroc_by_state": {name: area.numbers() for name, area in found.by_class.items()},
    }


@dataclass(frozen=True, slots=True)
class Judged:
    """One classifier on the test specimens.

    Attributes
    ----------
    name : str
        A key of `TITLES`.
    scores : Scores
        Accuracy, macro-AUROC, confusion matrix, of calibrated probabilities.
    permuted_auroc : (repeats,) float64
        Macro-AUROC of the same classifier trained on permuted labels; empty where not run.
    details : dict
        How it was chosen: C, epochs, notes, macro-AUROC on validation specimens where that is defined.
    calibration : Calibration
        Calibration error and Brier score on test specimens, and the temperature from validation specimens.
    predictions : Predictions
        Calibrated, of the test records in their order.
    detection : Detection or None
        Damaged or not, by 1 - p(healthy); None where the classes have no healthy one or the test has one side only.
    validation : Predictions or None
        Calibrated, of the validation records in their order; None where they were not asked for.
    """

    name: str
    scores: IntervalScores
    permuted_auroc: np.ndarray
    details: dict[str, Any]
    calibration: TemperatureScaling
    predictions: Predictions
    detection: Detection | None = None
    validation: Predictions | None = None


def judged(
    name: str,
    uncalibrated: Predictions,
    temperature: float,
    permuted_auroc: np.ndarray,
    details: dict[str, Any],
    seed: int,
    healthy: str | None = None,
) -> Judged:
    """Judge the test predictions of one classifier; its temperature comes from validation specimens.

    Records of a class that it does not know are judged by whether they are found damaged, and by nothing else.
    """
    found = calibrated(uncalibrated, temperature)
    known = np.flatnonzero(found.truth != UNKNOWN)
    named = predictions_of(found, known)
    return Judged(
        name,
        scores(named, seed),
        permuted_auroc,
        details,
        calibration(predictions_of(uncalibrated, known), temperature, seed),
        found,
        detection(found, healthy, seed) if healthy else None,
    )


def validation_score(validation: Predictions) -> dict[str, float]:
    """Return the macro-AUROC on validation records as an entry of the details; none where it is undefined."""
    if not validation.truth.size:
        return {}
    found = float(macro_auroc(validation, np.ones((1, validation.truth.size)))[0])
    return {VALIDATION_AUROC: found} if math.isfinite(found) else {}


def judged_metrics(found: Judged) -> dict[str, Any]:
    """Return what `metrics.json` says about one classifier."""
    return {
        "title": TITLES[found.name],
        "test_specimens": found.scores.specimens,
        "test_records": found.scores.records,
        "accuracy": found.scores.accuracy.numbers(),
        "balanced_accuracy": found.scores.balanced_accuracy.numbers(),
        "macro_auroc": found.scores.macro_auroc.numbers(),
        "chance_accuracy": found.scores.guess,
        "chance_balanced_accuracy": 1.0 / len(found.scores.classes),
        "detection": detection_metrics(found.detection),
        "confusion": found.scores.confusion.tolist(),
        "permuted_macro_auroc": [float(area) if math.isfinite(area) else None for area in found.permuted_auroc],
        "temperature": found.calibration.temperature,
        "expected_calibration_error": found.calibration.after.numbers(),
        "expected_calibration_error_uncalibrated": found.calibration.before.numbers(),
        "expected_calibration_error_if_true": found.calibration.honest,
        "brier_score": found.calibration.brier.numbers(),
        "brier_score_uncalibrated": found.calibration.brier_before.numbers(),
        **{key: value for key, value in found.details.items() if value != ""},
    }


@dataclass(frozen=True, slots=True)
class Comparison:
    """First minus second: differences of accuracy, macro-AUROC and AUROC of detection on the same test specimens."""

    first: str
    second: str
    accuracy: Interval
    macro_auroc: Interval
    detection: Interval | None = None

    def numbers(self) -> dict[str, Any]:
        """Return everything for JSON."""
        return {
            "first": self.first,
            "second": self.second,
            "accuracy": self.accuracy.numbers(),
            "macro_auroc": self.macro_auroc.numbers(),
            "detection_auroc": self.detection.numbers() if self.detection else None,
        }


def comparison(
    names: tuple[str, str],
    first: Predictions,
    second: Predictions,
    seed: int,
    healthy: str | None = None,
) -> Comparison:
    """Compare the predictions of two classifiers for the same records.

    Parameters
    ----------
    names : (str, str)
        Of the two classifiers.
    first, second : Predictions
        Of the same records in the same order.
    seed : int
        Seed of the resamples, the same ones for both.
    healthy : str, optional
        The healthy class; without it detection is not compared.

    Raises
    ------
    ValueError
        If the records differ.
    """
    if not (np.array_equal(first.truth, second.truth) and np.array_equal(first.specimen, second.specimen)):
        raise ValueError("the two predictions are not of the same records in the same order")
    weights = bootstrap_weights(first.specimen, seed)
    specimens = int(np.unique(first.specimen).size)
    right = (first.predicted == first.truth).astype(np.float64) - (second.predicted == second.truth)
    areas = macro_auroc(first, weights) - macro_auroc(second, weights)
    accuracy = interval(weights @ right / weights.sum(axis=1), specimens)
    detected = interval(_detection_difference(first, second, healthy, weights), specimens) if healthy else None
    return Comparison(*names, accuracy, interval(areas, specimens), detected)


def _detection_difference(first: Predictions, second: Predictions, healthy: str, weights: np.ndarray) -> np.ndarray:
    damaged = first.truth != first.classes.index(healthy)
    areas = [weighted_auc(damage_score(found, healthy), damaged, weights, found.specimen) for found in (first, second)]
    return np.asarray(areas[0] - areas[1])


def state_auc(found: Predictions, healthy: int, state: int, seed: int) -> Interval:
    """Return the AUC of one state against healthy by a classifier's probabilities of the two."""
    chosen = np.isin(found.truth, (healthy, state))
    pair = found.probability[chosen][:, [healthy, state]]
    score = pair[:, 1] / np.maximum(pair.sum(axis=1), 1e-300)
    weights = bootstrap_weights(found.specimen, seed)[:, chosen]
    areas = weighted_auc(score, found.truth[chosen] == state, weights, found.specimen[chosen])
    return interval(areas, int(np.unique(found.specimen[chosen]).size))
