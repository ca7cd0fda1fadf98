"""Another set as the test: other gears, supports or paths than those that were trained on."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pyarrow as pa

from diagnostics.indicators.classifier_table import feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.record_classes import STATE, set_classes
from diagnostics.records.recording import names_of
from diagnostics.records.state_classes import CLASS, HEALTHY
from diagnostics.statistics.evaluation import UNKNOWN, Predictions
from diagnostics.statistics.judgement import NETWORK, Judged, judged
from diagnostics.training.average_rows import table_averages
from diagnostics.training.baselines import FeatureClassifier, state_index
from diagnostics.training.network_training import TrainedNetworkFile, network_predictions_of
from diagnostics.training.splits import SpecimenSplit
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError, counted


@dataclass(frozen=True, slots=True)
class OtherSet:
    """Another set to judge on: what `siggen.open` returned, and its feature table."""

    dataset: Dataset
    table: pa.Table


def check_other_set(dataset: Dataset, other: Dataset, kind: str = STATE) -> None:
    """Check that classifiers of a set can be judged on another one; `kind` says what their classes are.

    Raises
    ------
    UsageError
        If channels, sampling rate or indicators differ, no damage is known, or both are the same set.
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
    named = [names_of(found) for found in (dataset, other)]
    if named[0] != named[1]:
        ours, theirs = (", ".join(dict.fromkeys(gear for mesh in one for gear in mesh.gears)) for one in named)
        raise UsageError(
            f"--test {other.path}: received indicators of {theirs}; the classifiers take those of {ours}. Generate it "
            "with the same names in `stages`, or the same kind of gearbox."
        )
    known, found = (set(set_classes(each, kind, HEALTHY).names) for each in (dataset, other))
    if not found & known - {HEALTHY}:  # any healthy state belongs to the healthy class, whatever its name
        raise UsageError(
            f"--test {other.path}: has the {kind}s {', '.join(sorted(found - known))}, which training does not know; "
            f"allowed are {', '.join(sorted(known))} and others beside them. Name its {kind}s like those, or train on "
            "a set that has them."
        )


def strange_states_note(other: OtherSet, split: SpecimenSplit) -> str:
    """Return how records were judged whose class training does not know; an empty text without any."""
    matrix = _matrix(other, split)
    strange = state_index(matrix, split.classes) == UNKNOWN
    if not strange.any():
        return ""
    names = ", ".join(sorted(set(matrix.labels[CLASS][strange].tolist())))
    return (
        f"--test: {counted(int(strange.sum()), 'record')} of {names}, which training does not know, are judged by "
        "whether damage is found, and left out of what names it."
    )


def classifier_predictions(model: FeatureClassifier, matrix: FeatureMatrix) -> Predictions:
    """Return uncalibrated predictions of the other set by a classifier on indicators."""
    return replace(model, temperature=1.0).predict(matrix)


def _matrix(other: OtherSet, split: SpecimenSplit) -> FeatureMatrix:
    return feature_matrix(other.table, set_classes(other.dataset, split.kind, split.healthy))


def judge_other(
    models: dict[str, FeatureClassifier],
    network: TrainedNetworkFile | None,
    results: list[Judged],
    other: OtherSet,
    split: SpecimenSplit,
    seed: int,
) -> tuple[Judged, ...]:
    """Judge every classifier on all records of the other set, none of whose gearboxes was trained on."""
    matrix = _matrix(other, split)
    found: dict[str, tuple[Predictions, float]] = {
        name: (classifier_predictions(model, matrix), model.temperature) for name, model in models.items()
    }
    if network:
        votes = network_predictions_of(network, table_averages(other.dataset, other.table), matrix)
        found[NETWORK] = (votes, network.trained.temperature)
    details = {result.name: result.details for result in results}
    return tuple(judged(name, *votes, np.empty(0), details[name], seed, split.healthy) for name, votes in found.items())
