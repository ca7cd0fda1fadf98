"""Task `abstain`: whether a classifier is sure where it is right; records are left out from the least sure on.

Risk is the share named wrong among the records that are answered. Source: risk and coverage, standard literature
(El-Yaniv and Wiener 2010); equal confidence is answered together, derived.
"""

from __future__ import annotations

import numpy as np

from diagnostics.scoring.grade import grades, probabilities
from diagnostics.scoring.task import Columns, Measure, Taken, Task, every_record
from diagnostics.scoring.truth import Truth

CONFIDENCE = "confidence"
COVERAGE = 0.8


def _answers(columns: Columns, truth: Truth) -> np.ndarray | None:
    """Return confidence and whether the class is wrong, (n, 2); the confidence is the largest probability if not given.

    None without a class, or with a name alone.
    """
    found, named = probabilities(columns, truth), grades(columns, truth)
    if named is None or (CONFIDENCE not in columns and found is None):
        return None
    sure = columns[CONFIDENCE] if CONFIDENCE in columns else named.max(axis=1)
    return np.stack([sure, (named.argmax(axis=1) != truth.label).astype(np.float64)], axis=1)


def risks(answers: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return coverage and risk when each record, from the surest on, is the last that is answered, (b, n) each.

    The third is the weight of each record in this order, (b, n).
    """
    order = np.argsort(-answers[:, 0], kind="stable")
    sure, wrong, drawn = -answers[order, 0], answers[order, 1], weights[:, order]
    last = np.searchsorted(sure, sure, side="right") - 1
    answered = np.cumsum(drawn, axis=1)[:, last]
    with np.errstate(invalid="ignore", divide="ignore"):
        return answered / answered[:, -1:], np.cumsum(drawn * wrong, axis=1)[:, last] / answered, drawn


def _mean_risk(answers: np.ndarray, _truth: Truth, weights: np.ndarray) -> np.ndarray:
    _, risk, drawn = risks(answers, weights)
    return np.asarray(np.where(drawn > 0.0, drawn * risk, 0.0).sum(axis=1) / drawn.sum(axis=1))


def _risk_at(answers: np.ndarray, _truth: Truth, weights: np.ndarray) -> np.ndarray:
    """Return the risk where so many records are answered that the wanted coverage is reached."""
    covered, risk, _ = risks(answers, weights)
    place = (covered < COVERAGE - 1e-12).sum(axis=1)
    return np.asarray(np.take_along_axis(risk, place[:, None], axis=1)[:, 0])


def _chance(truth: Truth) -> float:
    return 1.0 - 1.0 / np.unique(truth.label).size


ABSTAIN = Task(
    "abstain",
    f"those of grade, and {CONFIDENCE} (rises with certainty) if it is not the largest probability",
    lambda truth: (Taken(CONFIDENCE),) if truth.told else (),
    _answers,
    every_record,
    (
        Measure("mean risk over all coverages", _mean_risk, _chance, falls=True),
        Measure(f"risk at {COVERAGE:.0%} coverage", _risk_at, _chance, falls=True),
    ),
)
