"""The damaged area that probabilities of the classes expect."""

from __future__ import annotations

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.state_classes import CLASS
from diagnostics.statistics.evaluation import Predictions
from diagnostics.training.splits import SpecimenSplit


def expected_area(found: Predictions, area_by_state: np.ndarray) -> np.ndarray:
    """Return the area [mm^2] that probabilities of the states (n, states) expect, (n,)."""
    return np.asarray(found.probability @ area_by_state)


def mean_areas(matrix: FeatureMatrix, split: SpecimenSplit) -> np.ndarray:
    """Return the mean damaged area of the training records of every class [mm^2], (classes,)."""
    area, own = matrix.labels["damaged_area_mm2"][split.train], matrix.labels[CLASS][split.train]
    return np.array([area[own == name].mean() if (own == name).any() else 0.0 for name in split.classes])
