"""The folder of all models of a training: classifiers, network, and what they need to be used on recordings.

Beside them stand facts, distances from the training records, the healthy-referenced variant, and a card: what the
models are, on what they were trained, what their scores mean, to what they are limited and when they abstain.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pyarrow as pa

from diagnostics.indicators.classifier_table import feature_matrix, table_settings
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.registry import indicator_columns
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.judging.judgement import REFERENCED as REFERENCED_NAME
from diagnostics.judging.of_split import Training
from diagnostics.page.sentences import filled
from diagnostics.prediction.model_facts import FACTS_FILE, MODEL_FILES, REFERENCED, ModelFacts, model_facts, write_facts
from diagnostics.prediction.noise_floor import floor_features
from diagnostics.prediction.training_distance import TrainingDistance, calibrated_distance, distance_features
from diagnostics.records.gear_train import GearNames
from diagnostics.records.record_classes import STATE, set_classes
from diagnostics.records.recording import names_of, recordings
from diagnostics.records.state_classes import HEALTHY
from diagnostics.scoring.prediction_file import predicted_rows, write_predictions
from diagnostics.statistics.evaluation import IntervalScores
from diagnostics.training.feature_classifier import FeatureClassifier, save_classifier
from diagnostics.training.realism import meaning_of_scores
from diagnostics.training.referenced import healthy_referenced, log_values, reference_speed_ratio
from diagnostics.training.splits import TEST, VALIDATION, SpecimenSplit
from siggen.dataset.reading import Dataset
from siggen.file_writing import write_file


@dataclass(frozen=True, slots=True)
class ReferencedVariant:
    """Classifier and distance on features minus those of the same machine in healthy state, and its test scores.

    `outside` is the share of the test records that the distance calls unlike training.
    """

    classifier: FeatureClassifier
    distance: TrainingDistance
    scores: IntervalScores
    outside: float


@dataclass(frozen=True, slots=True)
class Release:
    """Everything that goes along with a classifier.

    Attributes
    ----------
    facts : ModelFacts
    distance : TrainingDistance
        On log features.
    outside : float
        Share of the test records that it calls unlike training; false alarms, since they are of the same family.
    referenced : ReferencedVariant or None
        None where healthy records do not suffice; `note` says why.
    note : str
    """

    facts: ModelFacts
    distance: TrainingDistance
    outside: float
    referenced: ReferencedVariant | None
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
    distance, outside = _distance(log_values(whole.values), whole, split, names_of(dataset))
    referenced, note = _referenced(training, whole, names_of(dataset))
    seen = {name: column[~split.test] for name, column in matrix.labels.items()}
    ratio = reference_speed_ratio(seen) if referenced else None
    facts = replace(model_facts(dataset, table, split), reference_speed_ratio=ratio)
    return Release(facts, distance, outside, referenced, note)


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
) -> tuple[TrainingDistance, float]:
    """Return the distance, and the share of the test records that lie beyond its threshold."""
    parts = distance_features(matrix.names, gears)
    chosen = logs[:, [matrix.names.index(name) for part in parts for name in part]]
    speed_hz = matrix.labels["speed_hz"].astype(np.float64)
    found = calibrated_distance(chosen, speed_hz, parts, split, matrix.labels["specimen_id"])
    return found, float(np.mean(found.distance(chosen, speed_hz)[split.test] > found.threshold))


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
    distance, outside = _distance(apart.values, apart, found.split, gears)
    return ReferencedVariant(found.classifier, distance, judged.scores, outside), ""


def save_release(training: Training, found: Release, table: pa.Table, folder: Path) -> None:
    """Write the variant's classifier under names that begin with `referenced_`, then `model.json` over all files."""
    scored, variant = {judged.name: judged.scores for judged in training.judged}, found.referenced
    if variant:
        scored[REFERENCED_NAME] = variant.scores
        save_classifier(variant.classifier, table_settings(table), found.facts.identity, folder, REFERENCED)
    scores = {
        "test": {
            name: {"accuracy": score.accuracy.numbers(), "macro_auroc": score.macro_auroc.numbers()}
            for name, score in scored.items()
        },
        "test_records_outside": found.outside,
        "referenced_test_records_outside": variant.outside if variant else None,
    }
    write_facts(found.facts, found.distance, variant.distance if variant else None, scores, folder)


def model_card(training: Training, found: Release, dataset: Dataset) -> str:
    """Return the card as Markdown.

    Parameters
    ----------
    training : Training
        The judged classifiers.
    found : Release
        What goes along with them.
    dataset : siggen Dataset
        The set they were trained on.
    """
    return filled(
        Path(__file__).with_name("templates") / "model_card.md",
        name=dataset.path.name,
        meaning=meaning_of_scores(dataset.config),
        classes=class_text(training.split, dataset),
        channels=dataset.channels,
        columns=columns_text(training.classifier.features, names_of(dataset)),
        training=training,
        released=found,
        facts=found.facts,
    )


def class_text(split: SpecimenSplit, dataset: Dataset) -> str:
    """Return the classes, which states they hold where that is not one each, and what is damaged in states."""
    merged = {name: states for name, states in split.members.items() if len(states) > 1}
    told = f"{split.kind}s" if not merged else "classes" if split.kind == STATE else "classes (primary faults)"
    held = "; ".join(f"{name}: records of {', '.join(states)}" for name, states in merged.items())
    listed = f"{told}: {', '.join(split.classes)}" + (f" ({held})" if held else "")
    return f"{listed}; {_faults_text(dataset)}" if split.kind == STATE else listed


def _faults_text(dataset: Dataset) -> str:
    """Return which faults the states of a set have; a class of one state says how far, not what."""
    labels = dataset.labels(columns=["state", "fault"]).to_pylist()
    faults: dict[str, dict[str, None]] = {}
    for one in labels:
        if one["fault"] != HEALTHY:
            faults.setdefault(one["fault"], {})[one["state"]] = None
    held = "; ".join(f"{fault} in {', '.join(states)}" for fault, states in faults.items())
    return f"faults: {held or 'none'}"


def columns_text(columns: Sequence[str], gears: GearNames) -> str:
    """Return the indicators that columns are of, with how many columns each has."""
    known, names = indicator_columns(IndicatorSettings(), gears), (column.partition("__")[0] for column in columns)
    counts = Counter(known[name].entry.name if name in known else name for name in names)
    return ", ".join(f"{name} ({count})" for name, count in counts.items())


def save_models(training: Training, table: pa.Table, dataset: Dataset, folder: Path) -> list[str]:
    """Write all models and the model card into a folder; return notes on what could not be written.

    Parameters
    ----------
    training : Training
        What to save.
    table : pyarrow.Table
        The feature table; its settings go along.
    dataset : siggen Dataset
        Names the set in the card.
    folder : Path
        Created where missing.
    """
    for name in (FACTS_FILE, *MODEL_FILES):
        # a network of an earlier run must not lie beside a card that does not know it
        (folder / name).unlink(missing_ok=True)
    identity, notes = str(dataset.manifest["identity"]), []
    save_classifier(training.classifier, table_settings(table), identity, folder)
    if training.network:
        from diagnostics.training.cnn import save_network

        save_network(training.network, folder / "cnn.safetensors")
    write_predictions(_predicted(training, table), identity, folder, training.split.kind)
    released = release(training, table, dataset)
    notes += [released.note] if released.note else []
    write_file(folder / "model_card.md", model_card(training, released, dataset))
    save_release(training, released, table, folder)
    return notes


def _predicted(training: Training, table: pa.Table) -> list[pa.Table]:
    """Return what every classifier says of the validation and test records of the table."""
    record_id, split = np.asarray(table.column("record_id").to_pylist()), training.split
    parts = [(VALIDATION, split.validation, "validation"), (TEST, split.test, "predictions")]
    return [
        predicted_rows(judged.name, name, record_id[mask], found, training.class_areas)
        for judged in training.judged
        for name, mask, attribute in parts
        if (found := getattr(judged, attribute)) is not None
    ]
