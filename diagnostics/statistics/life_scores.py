"""Scores of predicted remaining lives, with intervals from a bootstrap over gearboxes.

A prediction is three quantiles of the remaining life; its median is what errors are taken of. Source: standard
literature (pinball loss: Koenker & Bassett 1978; score: Saxena & Goebel 2008, constants for lives near 200).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.statistics.evaluation import Interval, bootstrap_weights, interval

QUANTILES = (0.1, 0.5, 0.9)
BINS = 3
NASA_LIFE, NASA_CAP = 200.0, 60.0
"""The score's constants belong to lives of so many units; an error counts as at most so many of them."""


@dataclass(frozen=True, slots=True)
class LifeScores:
    """How well remaining lives were predicted.

    Attributes
    ----------
    rmse_h, mae_h : tuple of Interval
        Of all inspections, then of each bin of true remaining life, the shortest first; NaN for an empty bin.
    pinball_h : tuple of float
        At each of `QUANTILES`.
    coverage : Interval
        Share of true lives from the lowest to the highest quantile; 0.8 would be right.
    nasa : float
        Mean over inspections.
    """

    rmse_h: tuple[Interval, ...]
    mae_h: tuple[Interval, ...]
    pinball_h: tuple[float, ...]
    coverage: Interval
    nasa: float

    def numbers(self) -> dict[str, Any]:
        """Return the scores for JSON."""
        return {
            "rmse_h": [one.numbers() for one in self.rmse_h],
            "mae_h": [one.numbers() for one in self.mae_h],
            "pinball_h": dict(zip(map(str, QUANTILES), self.pinball_h, strict=True)),
            "coverage_80": self.coverage.numbers(),
            "nasa_mean": self.nasa,
        }


def pinball(truth: np.ndarray, predicted: np.ndarray, quantile: float) -> np.ndarray:
    """Return the pinball loss of a predicted quantile, (n,), in the unit of both."""
    return np.asarray(np.maximum(quantile * (truth - predicted), (quantile - 1.0) * (truth - predicted)))


def nasa(error_h: np.ndarray, median_life_h: float) -> np.ndarray:
    """Return the score of each error (predicted - true), (n,): 0 is best, late is worse than early.

    Errors count in units of median life / 200, and as at most 60 of them.
    """
    units = np.clip(error_h * NASA_LIFE / median_life_h, -NASA_CAP, NASA_CAP)
    return np.asarray(np.expm1(np.where(units < 0.0, -units / 13.0, units / 10.0)))


def life_bins(truth_h: np.ndarray, median_life_h: float) -> list[np.ndarray]:
    """Return masks of remaining lives below one, below two, and from two thirds of the median life on."""
    place = np.minimum(np.floor(truth_h * BINS / median_life_h), BINS - 1)
    return [place == k for k in range(BINS)]


def life_scores(
    truth_h: np.ndarray, predicted_h: np.ndarray, specimen: np.ndarray, median_life_h: float, seed: int
) -> LifeScores:
    """Return the scores of predictions; inspections whose true life is not known (NaN) count nowhere.

    Parameters
    ----------
    truth_h : (n,) float64
        NaN for gearboxes that were taken out.
    predicted_h : (n, 3) float64
        At `QUANTILES`.
    specimen : (n,) int
        Gearbox of each inspection.
    median_life_h : float
        Bins and the unit of the NASA score follow from it.
    seed : int
        Of the bootstrap.
    """
    known = np.isfinite(truth_h)
    truth, predicted, owner = truth_h[known], predicted_h[known], specimen[known]
    weights = bootstrap_weights(owner, seed)
    error = predicted[:, 1] - truth
    rows = [np.ones(truth.size, dtype=bool), *life_bins(truth, median_life_h)]
    inside = (predicted[:, 0] <= truth) & (truth <= predicted[:, 2])
    return LifeScores(
        tuple(_mean(error**2, one, weights, owner, root=True) for one in rows),
        tuple(_mean(np.abs(error), one, weights, owner) for one in rows),
        tuple(float(pinball(truth, predicted[:, k], q).mean()) for k, q in enumerate(QUANTILES)),
        _mean(inside.astype(np.float64), rows[0], weights, owner),
        float(nasa(error, median_life_h).mean()),
    )


def _mean(
    values: np.ndarray, rows: np.ndarray, weights: np.ndarray, owner: np.ndarray, *, root: bool = False
) -> Interval:
    """Return the mean of some rows, or its root, with its interval over gearboxes."""
    with np.errstate(invalid="ignore", divide="ignore"):  # a bin that is empty, or without weight in a resample
        means = weights[:, rows] @ values[rows] / weights[:, rows].sum(axis=1)
    return interval(np.sqrt(means) if root else means, np.unique(owner[rows]).size)


def unit_folds(specimen: np.ndarray, draws: np.random.Generator, most: int) -> Sequence[np.ndarray]:
    """Return masks of the rows to be predicted, fold by fold; a gearbox is in one fold alone."""
    units = draws.permutation(np.unique(specimen))
    return [np.isin(specimen, units[k::most]) for k in range(min(most, units.size))]
