"""Damaged or not: how well 1 - p(healthy) of a classifier tells damaged records from healthy ones, for each damage too.

One number per record serves for every damage, as an alarm would; it is not tuned to one of them. Intervals from
resampled specimens. Source: standard literature (Mann-Whitney).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.statistics.evaluation import (
    RESAMPLES,
    Interval,
    Predictions,
    bootstrap_weights,
    weighted_auc,
)
from diagnostics.statistics.scores import area_interval


@dataclass(frozen=True, slots=True)
class Detection:
    """AUC of healthy records against all damaged ones, and against those of each damaged class, by class."""

    every: Interval
    by_class: dict[str, Interval]


def damage_score(found: Predictions, healthy: str) -> np.ndarray:
    """Return 1 - p(healthy) of every record, (n,)."""
    return np.asarray(1.0 - found.probability[:, found.classes.index(healthy)])


def fewest_gearboxes(positive: np.ndarray, specimen: np.ndarray) -> int:
    """Return the gearboxes on the side, (n,) bool, that has fewer: as many the limits of an AUC count."""
    return min(int(np.unique(specimen[positive == side]).size) for side in (True, False))


def detection(found: Predictions, healthy: str, seed: int, resamples: int = RESAMPLES) -> Detection | None:
    """Judge predictions as an alarm for damage.

    Parameters
    ----------
    found : Predictions
        Of the records to judge on.
    healthy : str
        The healthy class.
    seed : int
        Seed of the resamples, the same as of all other scores.
    resamples : int
        Number of resamples.

    Returns
    -------
    Detection or None
        None where the records are all healthy or all damaged; a damaged class without records is left out.
    """
    own = found.classes.index(healthy)
    score, positive = damage_score(found, healthy), found.truth != own
    if positive.all() or not positive.any():
        return None
    weights = bootstrap_weights(found.specimen, seed, resamples)

    def judged(chosen: np.ndarray) -> Interval:
        areas = weighted_auc(score[chosen], positive[chosen], weights[:, chosen], found.specimen[chosen])
        return area_interval(areas, fewest_gearboxes(positive[chosen], found.specimen[chosen]))

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
