"""Gradient boosting on the indicators; the number of trees is chosen on validation specimens.

Undefined indicators need no replacement, since a tree sends them to the side that suits. Source: standard literature
(Friedman 2001), as in scikit-learn's histogram version.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.statistics.calibration import SMALLEST_PROBABILITY
from diagnostics.training.baselines import FeatureClassifier, state_index
from diagnostics.training.splits import SpecimenSplit

MOST_TREES, DEFAULT_TREES = 100, 60


def train_boosting(
    matrix: FeatureMatrix, split: SpecimenSplit, seed: int, target: np.ndarray | None = None
) -> FeatureClassifier:
    """Fit on training specimens with as many trees as give the lowest log loss on validation specimens.

    Parameters
    ----------
    matrix : FeatureMatrix
        All records; every column that is defined for a training record is used.
    split : SpecimenSplit
        Whose specimens are which.
    seed : int
        Seed of the histograms' sample.
    target : (n,) int, optional
        Labels to learn, default the true states.
    """
    truth = state_index(matrix, split.classes) if target is None else target
    known = defined_columns(matrix, split.train)
    train, validation = known.rows(split.train).values, known.rows(split.validation).values
    note, trees = "", DEFAULT_TREES
    if split.validation.any():
        trees = _chosen_trees(train, truth[split.train], validation, truth[split.validation], seed)
    else:
        note = f"no validation specimens: {DEFAULT_TREES} boosting rounds were not chosen but taken as they are"
    return fitted_boosting(matrix.rows(split.train), truth[split.train], split.classes, seed, trees, note=note)


def defined_columns(matrix: FeatureMatrix, rows: np.ndarray) -> FeatureMatrix:
    """Return the columns that some of these records define: one that is never defined has no histogram."""
    defined = np.isfinite(matrix.values[rows]).any(axis=0)
    return matrix.columns([name for name, kept in zip(matrix.names, defined, strict=True) if kept])


def fitted_boosting(
    matrix: FeatureMatrix,
    truth: np.ndarray,
    classes: tuple[str, ...],
    seed: int,
    trees: int = DEFAULT_TREES,
    *,
    note: str = "",
) -> FeatureClassifier:
    """Fit so many trees on all records of a matrix.

    Parameters
    ----------
    matrix : FeatureMatrix
        Training records.
    truth : (n,) int
        Positions of their classes in `classes`.
    classes : tuple of str
    seed : int
        Seed of the histograms' sample.
    trees : int
    note : str
        What was not as it should be.
    """
    known = defined_columns(matrix, np.ones(truth.size, dtype=bool))
    model = _model(trees, seed).fit(known.values, truth)
    return FeatureClassifier(model, known.names, classes, float(trees), note)


def _model(trees: int, seed: int) -> Any:
    from sklearn.ensemble import HistGradientBoostingClassifier

    # small trees and leaves: a few hundred records of a few dozen specimens carry no deeper ones
    return HistGradientBoostingClassifier(
        learning_rate=0.1,
        max_iter=trees,
        max_leaf_nodes=6,
        min_samples_leaf=5,
        l2_regularization=1.0,
        max_features=0.2,
        early_stopping=False,
        random_state=seed,
    )


def _chosen_trees(
    train: np.ndarray, truth: np.ndarray, validation: np.ndarray, validation_truth: np.ndarray, seed: int
) -> int:
    model = _model(MOST_TREES, seed).fit(train, truth)
    column = {int(state): position for position, state in enumerate(model.classes_)}
    known = np.array([int(state) in column for state in validation_truth])
    if not known.any():
        return DEFAULT_TREES
    right = np.array([column[int(state)] for state in validation_truth[known]])
    losses = [
        -np.log(np.maximum(staged[known][np.arange(right.size), right], SMALLEST_PROBABILITY)).mean()
        for staged in model.staged_predict_proba(validation)
    ]
    return 1 + int(np.argmin(losses))
