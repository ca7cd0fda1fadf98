"""The studies that take longer than a report should: what splits do to a score, and what more specimens would bring."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.base.progress import Stage
from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.windows import window_matrix
from diagnostics.training.learning_curve import CurvePoint, curve_sizes, learning_curve
from diagnostics.training.split_study import SplitScore, rows_of_study, split_study
from diagnostics.training.splits import SpecimenSplit
from siggen.dataset.reading import Dataset


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
        windows = window_matrix(dataset, advance)
    second = None
    if other is not None:
        with stage("windows of the other set", int(other.labels(columns=["record_id"]).num_rows)) as advance:
            second = window_matrix(other, advance, split.healthy)
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
