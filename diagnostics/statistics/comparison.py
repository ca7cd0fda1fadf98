"""Differences between classifiers on the same specimens, with intervals from resampling those specimens for both.

Two intervals that overlap say little; the paired difference does, since both classifiers meet the same easy and hard
specimens. Source: standard literature (paired bootstrap).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.statistics.detection import damage_score
from diagnostics.statistics.evaluation import (
    RESAMPLES,
    Interval,
    Predictions,
    bootstrap_weights,
    interval,
    macro_auroc,
    weighted_auc,
)

SATURATED = 0.95
"""AUC of the level alone from which a state is called found by the level."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """First minus second: differences of accuracy, macro-AUROC and AUROC of detection on the same test specimens."""

    first: str
    second: str
    accuracy: Interval
    macro_auroc: Interval
    detection: Interval | None = None


def comparison(
    names: tuple[str, str],
    first: Predictions,
    second: Predictions,
    seed: int,
    healthy: str | None = None,
    resamples: int = RESAMPLES,
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
    resamples : int
        Number of resamples.

    Raises
    ------
    ValueError
        If the records differ.
    """
    if not (np.array_equal(first.truth, second.truth) and np.array_equal(first.specimen, second.specimen)):
        raise ValueError("the two predictions are not of the same records in the same order")
    weights = bootstrap_weights(first.specimen, seed, resamples)
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


def state_auc(found: Predictions, healthy: int, state: int, seed: int, resamples: int = RESAMPLES) -> Interval:
    """Return the AUC of one state against healthy by a classifier's probabilities of the two."""
    chosen = np.isin(found.truth, (healthy, state))
    pair = found.probability[chosen][:, [healthy, state]]
    score = pair[:, 1] / np.maximum(pair.sum(axis=1), 1e-300)
    weights = bootstrap_weights(found.specimen, seed, resamples)[:, chosen]
    areas = weighted_auc(score, found.truth[chosen] == state, weights, found.specimen[chosen])
    return interval(areas, int(np.unique(found.specimen[chosen]).size))
