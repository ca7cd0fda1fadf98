"""Score on the test specimens by number of training specimens, not windows: what more gearboxes would bring.

Each point trains as the classifier does, its C chosen on all validation specimens; the last point is that classifier.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.statistics.evaluation import macro_auroc
from diagnostics.training.baselines import rms_features, state_index, train_classifier
from diagnostics.training.splits import SpecimenSplit

DRAWS = 5
SIZES = (1, 2, 3, 5, 8, 12, 20, 32, 50, 80, 120, 200)


@dataclass(frozen=True, slots=True)
class CurvePoint:
    """Macro-AUROC (draws,) of classifiers trained on `specimens` training specimens, by indicators and by RMS."""

    specimens: int
    indicators: np.ndarray
    rms: np.ndarray


def learning_curve(
    matrix: FeatureMatrix, split: SpecimenSplit, seed: int, advance: Callable[[], None] | None = None
) -> tuple[CurvePoint, ...]:
    """Return the curve; every point but the last, which has all specimens, is drawn anew `DRAWS` times."""
    alone = matrix.columns(rms_features(matrix.names))
    return tuple(_point(size, matrix, alone, split, seed, advance) for size in curve_sizes(matrix, split))


def curve_sizes(matrix: FeatureMatrix, split: SpecimenSplit) -> list[int]:
    """Return the numbers of training specimens that the curve has."""
    count = np.unique(matrix.labels["specimen_id"][split.train]).size
    return [*(size for size in SIZES if size < count), int(count)]


def _point(
    size: int,
    matrix: FeatureMatrix,
    alone: FeatureMatrix,
    split: SpecimenSplit,
    seed: int,
    advance: Callable[[], None] | None,
) -> CurvePoint:
    specimens = np.unique(matrix.labels["specimen_id"][split.train])
    draws = 1 if size == specimens.size else DRAWS
    found = np.full((2, draws), np.nan)
    for draw in range(draws):
        chosen = generator(seed, Purpose.LEARNING_CURVE, size, draw).choice(specimens, size, replace=False)
        mask = split.train & np.isin(matrix.labels["specimen_id"], chosen)
        found[:, draw] = [_area(part, split, mask) for part in (matrix, alone)]
    if advance:
        advance()
    return CurvePoint(size, found[0], found[1])


def _area(matrix: FeatureMatrix, split: SpecimenSplit, mask: np.ndarray) -> float:
    truth = state_index(matrix, split.classes)
    if np.unique(truth[mask]).size < 2:
        return float("nan")
    test = train_classifier(matrix, replace(split, train=mask)).predict(matrix.rows(split.test))
    return float(macro_auroc(test, np.ones((1, test.truth.size)))[0])
