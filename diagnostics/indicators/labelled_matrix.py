"""`diagnostics.table`: all indicators of a set with labels, for one's own classifier."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

from diagnostics.indicators.classifier_table import check_table, classifier_table, feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.own_indicator import load_indicators
from diagnostics.indicators.table import record_table
from siggen.dataset.reading import Dataset


def table(dataset: Dataset, *, indicators: Sequence[str] = (), workers: int = 1) -> FeatureMatrix:
    """Return one row per record: indicators of every channel, labels with their roles, gearbox and split.

    The indicators are those that the classifiers of `siggen-diagnostics report` take. They are kept beside the set, so
    that only the first call computes them.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    indicators : sequence of str
        Your own besides, as `MODULE:FUNCTION`.
    workers : int
        Processes for the first call.

    Returns
    -------
    FeatureMatrix

    Raises
    ------
    DatasetError
        If records cannot be used; the message names them.
    """
    found = record_table(dataset, own=load_indicators(list(indicators)), workers=workers)
    notes = check_table(found, dataset)
    for note in notes:
        warnings.warn(f"{dataset.path}: {note}", stacklevel=2)
    return feature_matrix(classifier_table(found, notes))
