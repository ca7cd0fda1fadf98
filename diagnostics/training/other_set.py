"""Another set as the test: other gears, supports or paths than those that were trained on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.record_classes import STATE, set_classes
from diagnostics.records.recording import gear_names
from diagnostics.records.state_classes import HEALTHY
from diagnostics.statistics.evaluation import Predictions
from diagnostics.training.baselines import FeatureClassifier, state_index
from diagnostics.training.network_training import TrainedNetworkFile
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

OTHER_SPECIMENS = 1 << 40
"""Added to specimen numbers of the other set where both sets are in one table: they share numbers, not gearboxes."""


def check_other_set(dataset: Dataset, other: Dataset, kind: str = STATE) -> None:
    """Check that classifiers of a set can be judged on another one; `kind` says what their classes are.

    Raises
    ------
    UsageError
        If channels, sampling rate or classes differ, or both are the same set.
    """
    if dataset.manifest["identity"] == other.manifest["identity"]:
        raise UsageError(f"--test {other.path}: is the set that is trained on; leave --test out, or give another set")
    names = [tuple(channel.name for channel in found.channels) for found in (dataset, other)]
    if names[0] != names[1]:
        raise UsageError(
            f"--test {other.path}: received the channels {', '.join(names[1])}; the classifiers take "
            f"{', '.join(names[0])}. Generate it with the same `sensors`, or choose common ones with --channel."
        )
    if dataset.fs_hz != other.fs_hz:
        raise UsageError(
            f"--test {other.path}: received a sampling rate of {other.fs_hz:g} Hz; the classifiers were trained at "
            f"{dataset.fs_hz:g} Hz, and indicators of another band are others. Generate it with `fs_hz: "
            f"{dataset.fs_hz:g}`."
        )
    named = [gear_names(found) for found in (dataset, other)]
    if named[0] != named[1]:
        ours, theirs = (", ".join((*one.shafts, *one.meshes)) for one in named)
        raise UsageError(
            f"--test {other.path}: received indicators of {theirs}; the classifiers take those of {ours}. Generate it "
            "with the same names in `stages`, or the same kind of gearbox."
        )
    known, found = (set(set_classes(each, kind, HEALTHY).names) for each in (dataset, other))
    if not found <= known:  # any healthy state belongs to the healthy class, whatever its name
        raise UsageError(
            f"--test {other.path}: has the {kind}s {', '.join(sorted(found - known))}, which training does not know; "
            f"allowed are {', '.join(sorted(known))}. Name its {kind}s like those, or train on a set that has them."
        )


def classifier_predictions(model: FeatureClassifier, matrix: FeatureMatrix) -> Predictions:
    """Return uncalibrated predictions of the other set by a classifier on indicators."""
    return replace(model, temperature=1.0).predict(matrix)


def network_predictions_of(network: TrainedNetworkFile, other: Dataset, matrix: FeatureMatrix) -> Predictions:
    """Return uncalibrated predictions of the other set by the network; its pinions may have other teeth."""
    from diagnostics.loader.windows import order_records
    from diagnostics.training.cnn import network_predictions

    records = order_records(other)
    trained = replace(network.trained, temperature=1.0)
    every = np.arange(len(records.signals))
    return network_predictions(
        trained, records, every, state_index(matrix, trained.classes), matrix.labels["specimen_id"]
    )
