"""The studies that take longer than a report should: what splits do to a score, and what more specimens would bring.

Score on the test specimens by number of training specimens, not windows: what more gearboxes would bring.

Each point trains as the classifier does, its C chosen on all validation specimens; the last point is that classifier.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnostics.base.progress import Stage
from diagnostics.base.seeding import Purpose, generator
from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.record_classes import set_classes
from diagnostics.statistics.evaluation import macro_auroc
from diagnostics.training.baselines import rms_features, state_index, train_classifier
from diagnostics.training.other_set import known_rows
from diagnostics.training.split_study import SplitScore, rows_of_study, split_study, window_matrix
from diagnostics.training.splits import SpecimenSplit
from siggen.dataset.reading import Dataset

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


@dataclass(frozen=True, slots=True)
class Studies:
    """Scores by split, and by number of training specimens."""

    splits: tuple[SplitScore, ...]
    curve: tuple[CurvePoint, ...]


@single_thread
def run_studies(
    dataset: Dataset, matrix: FeatureMatrix, split: SpecimenSplit, seed: int, other: Dataset | None, stage: Stage
) -> Studies:
    """Run both studies of a set.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    matrix : FeatureMatrix
        Indicators of its records.
    split : SpecimenSplit
        Its split.
    seed : int
        Seeds folds, draws and bootstrap.
    other : siggen Dataset or None
        Another set to test on.
    stage : Stage
        Told of every step.
    """
    with stage("indicators of windows", int(matrix.values.shape[0])) as advance:
        windows = window_matrix(dataset, set_classes(dataset, split.kind, split.healthy), advance)
    second = None
    if other is not None:
        with stage("windows of the other set", int(other.labels(columns=["record_id"]).num_rows)) as advance:
            strange = window_matrix(other, set_classes(other, split.kind, split.healthy), advance)
            second = known_rows(strange, split.classes)
    with stage("splits", rows_of_study(second is not None)) as advance:
        splits = split_study(windows, split.classes, seed, second, advance)
    with stage("learning curve", len(curve_sizes(matrix, split))) as advance:
        return Studies(splits, learning_curve(matrix, split, seed, advance))


def studies_metrics(studies: Studies) -> dict[str, Any]:
    """Return what `metrics.json` says about the studies."""
    return {
        "splits": [
            {
                "split": row.title,
                "leaky": row.leaky,
                "folds": row.folds,
                "windows": row.indicators.records,
                "indicators_macro_auroc": row.indicators.macro_auroc.numbers(),
                "indicators_accuracy": row.indicators.accuracy.numbers(),
                "rms_macro_auroc": row.rms.macro_auroc.numbers(),
            }
            for row in studies.splits
        ],
        "learning_curve": [
            {
                "training_specimens": point.specimens,
                "indicators_macro_auroc": _defined(point.indicators),
                "rms_macro_auroc": _defined(point.rms),
            }
            for point in studies.curve
        ],
    }


def _defined(areas: np.ndarray) -> list[float | None]:
    return [float(area) if np.isfinite(area) else None for area in areas]
