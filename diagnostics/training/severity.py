"""Severity as a number: the damaged area from indicators, from RMS alone, and from the states' probabilities.

Regressions see the square root of the area, a length, so that the largest pits do not rule the fit; what is judged is
the area in mm^2, beside the constant that knows nothing. Source: standard literature (ridge regression, gradient
boosting).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.state_classes import CLASS
from diagnostics.statistics.evaluation import RESAMPLES, Interval, Predictions, bootstrap_weights, interval
from diagnostics.statistics.separability import weighted_spearman
from diagnostics.training.boosting import DEFAULT_TREES, MOST_TREES
from diagnostics.training.splits import SpecimenSplit

STRENGTHS = (1.0, 10.0, 100.0, 1000.0)
"""Candidates for the weight of the penalty, weakest first."""

DEFAULT_STRENGTH = 100.0


@dataclass(frozen=True, slots=True)
class AreaScores:
    """Mean absolute error [mm^2] and rank correlation of predicted areas on test specimens."""

    title: str
    error_mm2: Interval
    spearman: Interval


def area_predictions(matrix: FeatureMatrix, split: SpecimenSplit) -> np.ndarray:
    """Return the damaged area of the test records [mm^2], (n,), by ridge regression on all columns."""
    from sklearn.impute import SimpleImputer
    from sklearn.linear_model import Ridge
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    area = matrix.labels["damaged_area_mm2"].astype(np.float64)
    train = matrix.rows(split.train).values

    def fitted(strength: float) -> Any:
        steps = (SimpleImputer(strategy="median", keep_empty_features=True), StandardScaler(), Ridge(alpha=strength))
        return make_pipeline(*steps).fit(train, np.sqrt(area[split.train]))

    def predicted(model: Any, mask: np.ndarray) -> np.ndarray:
        return np.asarray(np.maximum(model.predict(matrix.rows(mask).values), 0.0) ** 2)

    if not split.validation.any():
        return predicted(fitted(DEFAULT_STRENGTH), split.test)
    models = [fitted(strength) for strength in STRENGTHS]
    errors = [np.abs(predicted(model, split.validation) - area[split.validation]).mean() for model in models]
    return predicted(models[int(np.argmin(errors))], split.test)


def boosted_areas(matrix: FeatureMatrix, split: SpecimenSplit, seed: int) -> np.ndarray:
    """Return the damaged area of the test records [mm^2], (n,), by gradient boosting on all columns.

    The number of trees is that of the least error on validation specimens; `DEFAULT_TREES` where there are none.
    """
    defined = np.isfinite(matrix.values[split.train]).any(axis=0)  # a column that is never defined has no histogram
    values, area = matrix.values[:, defined], matrix.labels["damaged_area_mm2"].astype(np.float64)
    model = _boosting(MOST_TREES, seed).fit(values[split.train], np.sqrt(area[split.train]))

    def staged(mask: np.ndarray) -> list[np.ndarray]:
        return [np.maximum(found, 0.0) ** 2 for found in model.staged_predict(values[mask])]

    trees = DEFAULT_TREES
    if split.validation.any():
        errors = [np.abs(found - area[split.validation]).mean() for found in staged(split.validation)]
        trees = 1 + int(np.argmin(errors))
    return staged(split.test)[trees - 1]


def _boosting(trees: int, seed: int) -> Any:
    from sklearn.ensemble import HistGradientBoostingRegressor

    # absolute error, since that is what is judged; trees as small as those that tell the states apart
    return HistGradientBoostingRegressor(
        loss="absolute_error",
        learning_rate=0.1,
        max_iter=trees,
        max_leaf_nodes=6,
        min_samples_leaf=5,
        l2_regularization=1.0,
        max_features=0.2,
        early_stopping=False,
        random_state=seed,
    )


def expected_area(found: Predictions, area_by_state: np.ndarray) -> np.ndarray:
    """Return the area [mm^2] that probabilities of the states (n, states) expect, (n,)."""
    return np.asarray(found.probability @ area_by_state)


def mean_areas(matrix: FeatureMatrix, split: SpecimenSplit) -> np.ndarray:
    """Return the mean damaged area of the training records of every class [mm^2], (classes,)."""
    area, own = matrix.labels["damaged_area_mm2"][split.train], matrix.labels[CLASS][split.train]
    return np.array([area[own == name].mean() if (own == name).any() else 0.0 for name in split.classes])


def area_scores(
    title: str, predicted: np.ndarray, matrix: FeatureMatrix, seed: int, resamples: int = RESAMPLES
) -> AreaScores:
    """Judge areas predicted for the records of a matrix, with intervals from resampled specimens."""
    area = matrix.labels["damaged_area_mm2"].astype(np.float64)
    weights = bootstrap_weights(matrix.labels["specimen_id"], seed, resamples)
    specimens = int(np.unique(matrix.labels["specimen_id"]).size)
    error = weights @ np.abs(predicted - area) / weights.sum(axis=1)
    return AreaScores(
        title, interval(error, specimens), interval(weighted_spearman(predicted, area, weights), specimens)
    )
