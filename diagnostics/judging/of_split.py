"""All classifiers of one set, learnt on training specimens and judged on test specimens, and compared there.

They stand alone, or beside a healthy record of the same gearbox; another set may be judged on too: other gears,
supports or paths than those that were trained on.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa

from diagnostics.base.progress import Stage, silent_stage
from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.classifier_table import feature_matrix, table_notes
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.judgement import (
    BOOSTING,
    INDICATORS,
    NETWORK,
    NETWORK_REFERENCED,
    REFERENCED,
    RMS_ALONE,
    TITLES,
    Comparison,
    Judged,
    comparison,
    judged,
    judged_metrics,
    state_auc,
    validation_score,
)
from diagnostics.judging.nested_folds import Nested, nested_folds, nested_metrics, strange_classes
from diagnostics.judging.sets import OtherSet
from diagnostics.records.record_classes import STATE, check_kind, set_classes
from diagnostics.records.state_classes import CLASS
from diagnostics.statistics.calibration import calibrated, fitted_temperature, predictions_of
from diagnostics.statistics.evaluation import UNKNOWN, Interval, Predictions, macro_auroc
from diagnostics.training.average_rows import AveragedRecords, table_averages, with_references
from diagnostics.training.feature_classifier import (
    PERMUTATIONS,
    FeatureClassifier,
    permutation_control,
    permuted_target,
    rms_features,
    state_index,
)
from diagnostics.training.referenced import healthy_referenced, healthy_references
from diagnostics.training.splits import SpecimenSplit, specimen_split
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError, counted

if TYPE_CHECKING:
    from diagnostics.training.cnn import NetworkSettings, TrainedNetwork

PERMUTED_EPOCHS = 15
DEVICES = ("cpu", "cuda")
PAIRS = ((REFERENCED, INDICATORS), (NETWORK_REFERENCED, NETWORK), (NETWORK_REFERENCED, REFERENCED))
"""Differences that are told: what the reference is worth, and which classifier uses it better."""


@dataclass(frozen=True, slots=True)
class NetworkOptions:
    """How to train: what a class is, whether to train the network, and where.

    Attributes
    ----------
    cnn : bool
        Whether to train it at all.
    device : str
        `cpu` or `cuda`.
    classes : str
        What every classifier tells apart: `state`, or primary `fault`; healthy ones are one class.

    Raises
    ------
    UsageError
        If the classes are of an unknown kind.
    """

    cnn: bool = True
    device: str = "cpu"
    classes: str = STATE

    def __post_init__(self) -> None:
        check_kind(self.classes)


def check_device(device: str) -> None:
    """Check that the network can be trained there.

    Raises
    ------
    UsageError
        If the device is unknown or this machine has none of its kind.
    """
    if device not in DEVICES:
        raise UsageError(f"--device: received {device!r}; allowed are {', '.join(DEVICES)}")
    if device == "cuda":
        import torch

        if not torch.cuda.is_available():
            found = "PyTorch finds no CUDA device here" if torch.version.cuda else "this PyTorch is built without CUDA"
            raise UsageError(
                f"--device cuda: {found}; leave --device out to train on the CPU, or install a driver and a CUDA build "
                "of PyTorch (pytorch.org, 'Get started')"
            )


@dataclass(frozen=True, slots=True)
class Referenced:
    """Healthy-referenced classifiers.

    Attributes
    ----------
    classifier : FeatureClassifier
        Logistic regression on log indicators minus those of the gearbox's own healthy records.
    kept : (records,) bool
        Records that have such a reference.
    split : SpecimenSplit
        Of the kept records.
    judged : tuple of Judged
        On the kept test records: those that stand alone, and those with a reference.
    comparisons : tuple of Comparison
        Paired differences on these records.
    """

    classifier: FeatureClassifier
    kept: np.ndarray
    split: SpecimenSplit
    judged: tuple[Judged, ...]
    comparisons: tuple[Comparison, ...]


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
    network : TrainedNetwork or None
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
    network: TrainedNetwork | None
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
    nothing = np.empty(0)
    results = [
        judge_classifier(name, model, matrix, split, control if name == INDICATORS else nothing, seed)
        for name, model in models.items()
    ]
    trained = None
    if averages is not None:
        trained, judged_alone = judge_network(NETWORK, averages, matrix, split, seed, options, stage)
        trained = replace(trained, identity=str(dataset.manifest["identity"]))
        results.append(judged_alone)
    masks = {"train": split.train, "validation": split.validation, "test": split.test}
    details = (str(found.details["note"]) for found in results if found.details.get("note"))
    strange = strange_states_note(other, split) if other else ""
    order = sorted(results, key=lambda found: found.name == RMS_ALONE)  # which is always the second
    pairs = [(first, second) for place, second in enumerate(order) for first in order[:place]]
    areas = mean_areas(matrix, split)
    with stage("nested folds", len(strange_classes(split)) or 1) as advance:
        nested = nested_folds(matrix, split, seed, advance)
    return Training(
        judged=tuple(results),
        classifier=models[INDICATORS],
        network=trained,
        split=split,
        specimens={name: int(np.unique(matrix.groups[mask]).size) for name, mask in masks.items()},
        notes=tuple(dict.fromkeys((*table_notes(table), *details, *([strange] if strange else ())))),
        other=judge_other(models, trained, results, other, split, seed) if other else (),
        other_name=other.dataset.path.name if other else "",
        comparisons=tuple(_compared(first, second, split.healthy, seed) for first, second in pairs),
        rms_severe=_rms_severe(results, areas, split, seed),
        class_areas=areas,
        referenced=referenced_classifiers(matrix, split, results, averages, seed, options, stage),
        nested=nested,
    )


def _feature_models(
    matrix: FeatureMatrix, split: SpecimenSplit, seed: int, stage: Stage
) -> dict[str, FeatureClassifier]:
    """Return the calibrated classifiers on indicators by name."""
    from diagnostics.training.classifiers import BoostingBaseline, LogisticBaseline, trained

    alone = matrix.columns(rms_features(matrix.names))
    learners = {
        INDICATORS: (LogisticBaseline(), matrix),
        BOOSTING: (BoostingBaseline(seed), matrix),
        RMS_ALONE: (LogisticBaseline(), alone),
    }
    models = {}
    with stage("classifiers on indicators", len(learners)) as advance:
        for name, (learner, taken) in learners.items():
            models[name] = trained(learner, taken, split)
            advance()
    return models


def judge_classifier(
    name: str, model: FeatureClassifier, matrix: FeatureMatrix, split: SpecimenSplit, control: np.ndarray, seed: int
) -> Judged:
    """Judge a classifier on the test specimens; `control` are its areas with permuted labels."""
    found = replace(model, temperature=1.0).predict(matrix.rows(split.test))
    details = {"features": len(model.features), "strength": model.strength, "note": model.note}
    validation = model.predict(matrix.rows(split.validation)) if split.validation.any() else None
    details |= validation_score(validation) if validation else {}
    result = judged(name, found, model.temperature, control, details, seed, split.healthy)
    return replace(result, validation=validation)


def judge_network(
    name: str,
    records: AveragedRecords,
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    seed: int,
    options: NetworkOptions,
    stage: Stage,
) -> tuple[TrainedNetwork, Judged]:
    """Train a network on averages and judge it on the test specimens, with its control on permuted labels.

    Parameters
    ----------
    name : str
        `network`, or `network_referenced` for averages beside a healthy reference.
    records : AveragedRecords
        All records of the matrix, in its order.
    matrix : FeatureMatrix
        Labels of the records.
    split : SpecimenSplit
        Whose specimens are which.
    seed : int
        Seeds weights, paths and bootstrap.
    options : NetworkOptions
        Device.
    stage : Stage
        Told of every epoch.
    """
    from diagnostics.training.cnn import NetworkSettings, train_network

    settings, truth = NetworkSettings(device=options.device), state_index(matrix, split.classes)

    def learnt(title: str, target: np.ndarray, chosen: NetworkSettings) -> TrainedNetwork:
        with stage(title, chosen.most_epochs) as advance:
            return train_network(records, target, split, seed, chosen, advance)

    trained = learnt(TITLES[name], truth, settings)
    validation = network_votes(trained, records, matrix, split.validation)
    temperature = fitted_temperature(validation)
    details = {
        "best_epoch": trained.best_epoch,
        "epochs": trained.epochs,
        "augmented": settings.gain_db > 0.0,
        "device": options.device,
        "note": trained.note,
        **validation_score(validation),
    }
    short = replace(settings, most_epochs=PERMUTED_EPOCHS, patience=PERMUTED_EPOCHS)
    blind = learnt(f"permuted labels, {TITLES[name]}", permuted_target(truth, split, seed, 0), short)
    by_chance = network_votes(blind, records, matrix, split.test)
    control = macro_auroc(by_chance, np.ones((1, by_chance.truth.size)))
    found = network_votes(trained, records, matrix, split.test)
    result = judged(name, found, temperature, control, details, seed, split.healthy)
    seen = calibrated(validation, temperature) if split.validation.any() else None
    return replace(trained, temperature=temperature), replace(result, validation=seen)


def network_votes(
    trained: TrainedNetwork, records: AveragedRecords, matrix: FeatureMatrix, mask: np.ndarray
) -> Predictions:
    """Return the uncalibrated predictions of some records (n,) bool by a network."""
    from diagnostics.training.cnn import network_probability

    truth = state_index(matrix, trained.classes)[mask]
    probability = network_probability(trained.network, records.chosen(np.flatnonzero(mask)))
    return calibrated(Predictions(trained.classes, truth, probability, matrix.groups[mask]), 1.0)


def _compared(first: Judged, second: Judged, healthy: str | None, seed: int) -> Comparison:
    return comparison((first.name, second.name), first.predictions, second.predictions, seed, healthy)


def mean_areas(matrix: FeatureMatrix, split: SpecimenSplit) -> np.ndarray:
    """Return the mean damaged area of the training records of every class [mm^2], (classes,)."""
    area, own = matrix.labels["damaged_area_mm2"][split.train], matrix.labels[CLASS][split.train]
    return np.array([area[own == name].mean() if (own == name).any() else 0.0 for name in split.classes])


def _rms_severe(results: list[Judged], areas: np.ndarray, split: SpecimenSplit, seed: int) -> Interval | None:
    """Return the AUC of RMS alone for the class of the largest mean area; None where there is no damage."""
    if split.healthy is None or not areas.max() > 0:
        return None
    found = next(result.predictions for result in results if result.name == RMS_ALONE)
    return state_auc(found, split.classes.index(split.healthy), int(np.argmax(areas)), seed)


def referenced_classifiers(
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    alone: list[Judged],
    averages: AveragedRecords | None,
    seed: int,
    options: NetworkOptions,
    stage: Stage,
) -> Referenced | None:
    """Return the healthy-referenced classifiers; None where the set has no second healthy record of its gearboxes.

    Parameters
    ----------
    matrix : FeatureMatrix
        All records.
    split : SpecimenSplit
        Whose specimens are which.
    alone : list of Judged
        Classifiers without a reference, judged on all test records.
    averages : AveragedRecords, optional
        For the 1-D network; None leaves it out.
    seed : int
        Seeds networks and bootstrap.
    options : NetworkOptions
        Of the network.
    stage : Stage
        Told of every step.
    """
    from diagnostics.training.classifiers import LogisticBaseline, trained

    differences, kept = healthy_referenced(matrix)
    part = replace(split, train=split.train[kept], validation=split.validation[kept], test=split.test[kept])
    if np.unique(differences.labels[CLASS][part.train]).size < 2 or not part.test.any():
        return None
    classifier = trained(LogisticBaseline(take_logarithms=False), differences, part)
    shown, nothing = kept[split.test], np.empty(0)
    results = [
        # the probabilities are calibrated already
        judged(one.name, predictions_of(one.predictions, shown), 1.0, nothing, one.details, seed, split.healthy)
        for one in alone
        if one.name in (INDICATORS, NETWORK)
    ]
    results.append(judge_classifier(REFERENCED, classifier, differences, part, nothing, seed))
    if averages is not None:
        places, rows = np.flatnonzero(kept), healthy_references(matrix.labels)
        beside = with_references(averages, places, [rows[place] for place in places])
        results.append(judge_network(NETWORK_REFERENCED, beside, differences, part, seed, options, stage)[1])
    by_name = {found.name: found for found in results}
    pairs = [pair for pair in PAIRS if set(pair) <= set(by_name)]
    compared = (_compared(by_name[first], by_name[second], split.healthy, seed) for first, second in pairs)
    return Referenced(classifier, kept, part, tuple(results), tuple(compared))


def strange_states_note(other: OtherSet, split: SpecimenSplit) -> str:
    """Return how records were judged whose class training does not know; an empty text without any."""
    matrix = _other_matrix(other, split)
    strange = state_index(matrix, split.classes) == UNKNOWN
    if not strange.any():
        return ""
    names = ", ".join(sorted(set(matrix.labels[CLASS][strange].tolist())))
    return (
        f"--test: {counted(int(strange.sum()), 'record')} of {names}, which training does not know, are judged by "
        "whether damage is found, and left out of what names it."
    )


def _other_matrix(other: OtherSet, split: SpecimenSplit) -> FeatureMatrix:
    return feature_matrix(other.table, set_classes(other.dataset, split.kind, split.healthy))


def judge_other(
    models: dict[str, FeatureClassifier],
    network: TrainedNetwork | None,
    results: list[Judged],
    other: OtherSet,
    split: SpecimenSplit,
    seed: int,
) -> tuple[Judged, ...]:
    """Judge every classifier on all records of the other set, none of whose gearboxes was trained on."""
    matrix = _other_matrix(other, split)
    said = {
        name: (replace(model, temperature=1.0).predict(matrix), model.temperature) for name, model in models.items()
    }
    if network:
        every = np.ones(len(matrix.values), dtype=bool)
        votes = network_votes(network, table_averages(other.dataset, other.table), matrix, every)
        said[NETWORK] = (votes, network.temperature)
    details = {result.name: result.details for result in results}
    return tuple(judged(name, *votes, np.empty(0), details[name], seed, split.healthy) for name, votes in said.items())


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
        "comparisons": [pair.numbers() for pair in training.comparisons],
        "beside_a_healthy_record": _referenced_metrics(training.referenced) if training.referenced else None,
        "nested_folds": nested_metrics(training.nested) if training.nested else None,
        "rms_severe_auc": training.rms_severe.numbers() if training.rms_severe else None,
    }


def _referenced_metrics(found: Referenced) -> dict[str, Any]:
    return {
        "classifiers": {one.name: judged_metrics(one) for one in found.judged},
        "comparisons": [pair.numbers() for pair in found.comparisons],
    }
