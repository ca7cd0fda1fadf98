"""What is known about one classifier after its test: scores, calibration, control, predictions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.statistics.calibration import TemperatureScaling, calibrated, calibration, predictions_of
from diagnostics.statistics.detection import Detection, detection, detection_metrics
from diagnostics.statistics.evaluation import UNKNOWN, Predictions, macro_auroc
from diagnostics.statistics.scores import IntervalScores, scores

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
    area = float(macro_auroc(validation, np.ones((1, validation.truth.size)))[0])
    return {VALIDATION_AUROC: area} if math.isfinite(area) else {}


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
        "permuted_macro_auroc": [float(area) for area in found.permuted_auroc],
        "temperature": found.calibration.temperature,
        "expected_calibration_error": found.calibration.after.numbers(),
        "expected_calibration_error_uncalibrated": found.calibration.before.numbers(),
        "expected_calibration_error_if_true": found.calibration.honest,
        "brier_score": found.calibration.brier.numbers(),
        "brier_score_uncalibrated": found.calibration.brier_before.numbers(),
        **{key: value for key, value in found.details.items() if value != ""},
    }
