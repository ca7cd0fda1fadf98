"""All classifiers of one set, trained and judged the same way, compared on the same specimens, and saved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.base.progress import Stage, silent_stage
from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.classifier_table import feature_matrix, table_notes
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.record_classes import set_classes
from diagnostics.statistics.comparison import Comparison, comparison, state_auc
from diagnostics.statistics.evaluation import Interval
from diagnostics.statistics.judgement import (
    BOOSTING,
    INDICATORS,
    NETWORK,
    RMS_ALONE,
    Judged,
    judged,
    judged_metrics,
    validation_score,
)
from diagnostics.training.average_rows import table_averages
from diagnostics.training.baselines import (
    PERMUTATIONS,
    FeatureClassifier,
    calibrated_classifier,
    permutation_control,
    rms_features,
    train_classifier,
)
from diagnostics.training.boosting import train_boosting
from diagnostics.training.nested_folds import Nested, nested_folds, nested_metrics, strange_classes
from diagnostics.training.network_training import NetworkOptions, TrainedNetworkFile, judge_network
from diagnostics.training.other_set import OtherSet, classifier_predictions, judge_other, strange_states_note
from diagnostics.training.referenced import Referenced, referenced_classifiers
from diagnostics.training.severity import (
    mean_areas,
)
from diagnostics.training.splits import SpecimenSplit, specimen_split
from siggen.dataset.reading import Dataset


@dataclass(frozen=True, slots=True)
class Training:
    """Everything that training a set gave: judged classifiers and the models to save.

    Attributes
    ----------
    judged, other : tuple of Judged
        On the test specimens; on another set, empty without one.
    other_name : str
        Folder of the other set, or empty.
    comparisons : tuple of Comparison
        Paired differences on the test specimens.
    rms_severe : Interval or None
        AUC of RMS alone for the state with the largest damage against healthy.
    network : TrainedNetworkFile or None
        Network on the synchronous average; None without networks.
    referenced : Referenced or None
        Classifiers beside a healthy record of the same gearbox; None where the set has no second one.
    nested : Nested or None
        Logistic regression judged on every gearbox; None with too few.
    class_areas : (classes,) float64
        Mean damaged area of the training records of every class [mm^2].
    """

    judged: tuple[Judged, ...]
    classifier: FeatureClassifier
    network: TrainedNetworkFile | None
    split: SpecimenSplit
    specimens: dict[str, int]
    notes: tuple[str, ...]
    other: tuple[Judged, ...]
    other_name: str
    comparisons: tuple[Comparison, ...]
    rms_severe: Interval | None
    class_areas: np.ndarray
    referenced: Referenced | None = None
    nested: Nested | None = None


@single_thread()
def train_models(
    dataset: Dataset,
    table: pa.Table,
    seed: int,
    *,
    network: NetworkOptions | None = None,
    other: OtherSet | None = None,
    stage: Stage = silent_stage,
) -> Training:
    """Train and judge all classifiers of a set.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    table : pyarrow.Table
        Its feature table.
    seed : int
        Seeds bootstrap, permutations and network.
    network : NetworkOptions, optional
        What a class is; whether and how to train the network.
    other : OtherSet, optional
        A set to judge all classifiers on as well.
    stage : Stage
        Told of every step.

    Raises
    ------
    DatasetError
        If the split cannot be used (see `specimen_split`) or records are too short for a window.
    """
    options = network or NetworkOptions()
    classes = set_classes(dataset, options.classes)
    matrix = feature_matrix(table, classes)
    split = specimen_split(matrix.labels, classes)
    # first of all: records that are too short for it are said before anything is trained
    averages = table_averages(dataset, table) if options.cnn else None
    models = _feature_models(matrix, split, seed, stage)
    with stage("permuted labels", PERMUTATIONS) as advance:
        control = permutation_control(matrix, split, seed, strength=models[INDICATORS].strength, advance=advance)
    results = [_judge(name, model, matrix, split, control, seed) for name, model in models.items()]
    trained = None
    if averages is not None:
        alone, judged_alone = judge_network(NETWORK, averages, matrix, split, seed, options, stage)
        trained = TrainedNetworkFile(alone, averages.channels, str(dataset.manifest["identity"]))
        results.append(judged_alone)
    specimens = {name: _specimens(matrix, mask) for name, mask in _masks(split).items()}
    details = (str(found.details["note"]) for found in results if found.details.get("note"))
    strange = strange_states_note(other, split) if other else ""
    notes = dict.fromkeys((*table_notes(table), *details, *([strange] if strange else ())))
    return Training(
        judged=tuple(results),
        classifier=models[INDICATORS],
        network=trained,
        split=split,
        specimens=specimens,
        notes=tuple(notes),
        other=judge_other(models, trained, results, other, split, seed) if other else (),
        other_name=other.dataset.path.name if other else "",
        comparisons=_comparisons(results, split.healthy, seed),
        rms_severe=_rms_severe(results, matrix, split, seed),
        class_areas=mean_areas(matrix, split),
        referenced=referenced_classifiers(matrix, split, results, averages, seed, options, stage),
        nested=_nested(matrix, split, seed, stage),
    )


def _nested(matrix: FeatureMatrix, split: SpecimenSplit, seed: int, stage: Stage) -> Nested | None:
    with stage("nested folds", len(strange_classes(split)) or 1) as advance:
        return nested_folds(matrix, split, seed, advance)


def _masks(split: SpecimenSplit) -> dict[str, np.ndarray]:
    return {"train": split.train, "validation": split.validation, "test": split.test}


def _specimens(matrix: FeatureMatrix, mask: np.ndarray) -> int:
    return int(np.unique(matrix.labels["specimen_id"][mask]).size)


def _feature_models(
    matrix: FeatureMatrix, split: SpecimenSplit, seed: int, stage: Stage
) -> dict[str, FeatureClassifier]:
    """Return the calibrated classifiers on indicators by name."""
    alone = matrix.columns(rms_features(matrix.names))
    trainers: dict[str, Callable[[], FeatureClassifier]] = {
        INDICATORS: lambda: train_classifier(matrix, split),
        BOOSTING: lambda: train_boosting(matrix, split, seed),
        RMS_ALONE: lambda: train_classifier(alone, split),
    }
    models = {}
    with stage("classifiers on indicators", len(trainers)) as advance:
        for name, train in trainers.items():
            models[name] = calibrated_classifier(train(), matrix, split)
            advance()
    return models


def _judge(
    name: str,
    model: FeatureClassifier,
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    control: np.ndarray,
    seed: int,
) -> Judged:
    found = classifier_predictions(model, matrix.rows(split.test))
    details = {"features": len(model.features), "strength": model.strength, "note": model.note}
    validation = model.predict(matrix.rows(split.validation)) if split.validation.any() else None
    if validation:
        details |= validation_score(validation)
    permuted = control if name == INDICATORS else np.empty(0)
    result = judged(name, found, model.temperature, permuted, details, seed, split.healthy)
    return replace(result, validation=validation)


def _comparisons(results: list[Judged], healthy: str | None, seed: int) -> tuple[Comparison, ...]:
    """Compare every pair of classifiers, the later one first, with RMS alone always second."""
    order = sorted(results, key=lambda found: found.name == RMS_ALONE)
    return tuple(
        comparison((first.name, second.name), first.predictions, second.predictions, seed, healthy)
        for position, second in enumerate(order)
        for first in order[:position]
    )


def largest_state(matrix: FeatureMatrix, split: SpecimenSplit) -> str | None:
    """Return the class with the largest mean damaged area of training records; None where there is no damage."""
    areas = mean_areas(matrix, split)
    return split.classes[int(np.argmax(areas))] if areas.max() > 0 else None


def _rms_severe(results: list[Judged], matrix: FeatureMatrix, split: SpecimenSplit, seed: int) -> Interval | None:
    severe = largest_state(matrix, split)
    if severe is None or split.healthy is None:
        return None
    found = next(result.predictions for result in results if result.name == RMS_ALONE)
    return state_auc(found, split.classes.index(split.healthy), split.classes.index(severe), seed)


def training_metrics(training: Training) -> dict[str, Any]:
    """Return what `metrics.json` says about the classifiers."""
    return {
        "states": [state for states in training.split.members.values() for state in states],
        "classes_are": training.split.kind,
        "classes": {name: list(states) for name, states in training.split.members.items()},
        "specimens": training.specimens,
        "notes": list(training.notes),
        "classifiers": {found.name: judged_metrics(found) for found in training.judged},
        "other_set": training.other_name or None,
        "classifiers_on_other_set": {found.name: judged_metrics(found) for found in training.other},
        "comparisons": [_pair_metrics(pair) for pair in training.comparisons],
        "beside_a_healthy_record": _referenced_metrics(training.referenced) if training.referenced else None,
        "nested_folds": nested_metrics(training.nested) if training.nested else None,
        "rms_severe_auc": training.rms_severe.numbers() if training.rms_severe else None,
    }


def _pair_metrics(pair: Comparison) -> dict[str, Any]:
    return {
        "first": pair.first,
        "second": pair.second,
        "accuracy": pair.accuracy.numbers(),
        "macro_auroc": pair.macro_auroc.numbers(),
        "detection_auroc": pair.detection.numbers() if pair.detection else None,
    }


def _referenced_metrics(found: Referenced) -> dict[str, Any]:
    return {
        "classifiers": {judged.name: judged_metrics(judged) for judged in found.judged},
        "comparisons": [_pair_metrics(pair) for pair in found.comparisons],
    }
