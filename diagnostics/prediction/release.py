"""What a model needs besides its classifier to be used on recordings: facts, distance, healthy-referenced variant."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.indicators.classifier_table import feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.judgement import REFERENCED as REFERENCED_NAME
from diagnostics.judging.of_split import Training
from diagnostics.prediction.model_facts import ModelFacts, model_facts, write_facts
from diagnostics.prediction.noise_floor import floor_features
from diagnostics.prediction.training_distance import TrainingDistance, calibrated_distance, distance_features
from diagnostics.records.gear_train import GearNames
from diagnostics.records.record_classes import set_classes
from diagnostics.records.recording import names_of, recordings
from diagnostics.statistics.evaluation import IntervalScores
from diagnostics.training.feature_classifier import FeatureClassifier
from diagnostics.training.referenced import healthy_referenced, log_values, reference_speed_ratio
from diagnostics.training.splits import SpecimenSplit
from siggen.dataset.reading import Dataset

REFERENCED = "referenced_"
"""Prefix of the files of the healthy-referenced variant."""


@dataclass(frozen=True, slots=True)
class ReferencedVariant:
    """Classifier and distance on features minus those of the same machine in healthy state, and its test scores."""

    classifier: FeatureClassifier
    distance: TrainingDistance
    scores: IntervalScores
    distances: np.ndarray
    test: np.ndarray


@dataclass(frozen=True, slots=True)
class Release:
    """Everything that goes along with a classifier.

    Attributes
    ----------
    facts : ModelFacts
    distance : TrainingDistance
        On log features.
    test_outside : float
        Share of the test records that it calls unlike training; false alarms, since they are of the same family.
    referenced : ReferencedVariant or None
        None where healthy records do not suffice; `note` says why.
    referenced_outside : float
        As `test_outside`, of the variant; NaN without it.
    note : str
    """

    facts: ModelFacts
    distance: TrainingDistance
    test_outside: float
    referenced: ReferencedVariant | None
    referenced_outside: float
    note: str


def release(training: Training, table: pa.Table, dataset: Dataset) -> Release:
    """Return what goes along with the classifiers of a set; fitted on training, thresholds on held-out specimens.

    Parameters
    ----------
    training : Training
        The judged classifiers.
    table : pyarrow.Table
        Feature table of the set.
    dataset : siggen Dataset
        The set.
    """
    split = training.split
    matrix = feature_matrix(table, set_classes(dataset, split.kind))
    whole = with_floor_features(matrix, dataset)
    distance, distances = _distance(log_values(whole.values), whole, split, names_of(dataset))
    referenced, note = _referenced(training, whole, names_of(dataset))
    seen = {name: column[~split.test] for name, column in matrix.labels.items()}
    ratio = reference_speed_ratio(seen) if referenced else None
    return Release(
        facts=replace(model_facts(dataset, table, split), reference_speed_ratio=ratio),
        distance=distance,
        test_outside=_share_outside(distances[split.test], distance),
        referenced=referenced,
        referenced_outside=(
            _share_outside(referenced.distances[referenced.test], referenced.distance) if referenced else np.nan
        ),
        note=note,
    )


def with_floor_features(matrix: FeatureMatrix, dataset: Dataset) -> FeatureMatrix:
    """Return the features of a set with what lies between the lines as further columns, which only distances take.

    Parameters
    ----------
    matrix : FeatureMatrix
        Features of the set.
    dataset : siggen Dataset
        The set, with the same channels.
    """
    found = {
        int(record.labels["record_id"]): floor_features(record.channels, record.fs_hz) for record in recordings(dataset)
    }
    names = tuple(next(iter(found.values())))
    floors = np.array([[found[number][name] for name in names] for number in matrix.labels["record_id"].tolist()])
    return replace(matrix, values=np.hstack([matrix.values, floors]), names=(*matrix.names, *names))


def _distance(
    logs: np.ndarray, matrix: FeatureMatrix, split: SpecimenSplit, gears: GearNames
) -> tuple[TrainingDistance, np.ndarray]:
    parts = distance_features(matrix.names, gears)
    chosen = logs[:, [matrix.names.index(name) for part in parts for name in part]]
    speed_hz = matrix.labels["speed_hz"].astype(np.float64)
    found = calibrated_distance(chosen, speed_hz, parts, split, matrix.labels["specimen_id"])
    return found, found.distance(chosen, speed_hz)


def _share_outside(distances: np.ndarray, found: TrainingDistance) -> float:
    return float(np.mean(distances > found.threshold))


def _referenced(training: Training, whole: FeatureMatrix, gears: GearNames) -> tuple[ReferencedVariant | None, str]:
    """Return the variant with a distance on the features of `whole`, or why there is none."""
    found = training.referenced
    if found is None:
        return None, (
            "no healthy-referenced variant: it needs a second healthy record of every specimen, in another state, "
            "repeat or operating point"
        )
    (judged,) = [own for own in found.judged if own.name == REFERENCED_NAME]
    apart = healthy_referenced(whole)[0]
    distance, distances = _distance(apart.values, apart, found.split, gears)
    return ReferencedVariant(found.classifier, distance, judged.scores, distances, found.split.test), ""


def release_scores(training: Training, found: Release) -> dict[str, Any]:
    """Return the scores that `model.json` carries."""
    scored = {judged.name: judged.scores for judged in training.judged}
    if found.referenced:
        scored["healthy_referenced"] = found.referenced.scores
    return {
        "test": {
            name: {"accuracy": score.accuracy.numbers(), "macro_auroc": score.macro_auroc.numbers()}
            for name, score in scored.items()
        },
        "test_records_outside": found.test_outside,
        "referenced_test_records_outside": found.referenced_outside if found.referenced else None,
    }


def save_release(training: Training, found: Release, table: pa.Table, folder: Path) -> None:
    """Write the variant's classifier under names that begin with `referenced_`, then `model.json` over all files."""
    from diagnostics.indicators.classifier_table import table_settings
    from diagnostics.training.feature_classifier import save_classifier

    variant = found.referenced
    if variant:
        save_classifier(variant.classifier, table_settings(table), found.facts.identity, folder, REFERENCED)
    write_facts(
        found.facts, found.distance, variant.distance if variant else None, release_scores(training, found), folder
    )
