"""All classifiers of one set, trained and judged the same way: indicators, RMS alone, network; each with a control."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa

from diagnostics.baselines import (
    PERMUTATIONS,
    FeatureClassifier,
    permutation_control,
    permuted_target,
    rms_features,
    state_index,
    train_classifier,
)
from diagnostics.evaluation import Predictions, Scores, macro_auroc, scores
from diagnostics.feature_table import FeatureMatrix, feature_matrix, feature_settings
from diagnostics.progress import Stage, silent_stage
from diagnostics.splits import SpecimenSplit, specimen_split

if TYPE_CHECKING:
    from diagnostics.cnn import TrainedNetwork
    from diagnostics.cnn_files import NetworkFile

INDICATORS, RMS_ALONE, NETWORK = "indicators", "rms", "network"
TITLES = {INDICATORS: "logistic regression on indicators", RMS_ALONE: "RMS alone", NETWORK: "1-D network"}
PERMUTED_EPOCHS = 15
MODEL_FILES = (
    *("classifier.skops", "feature_names.json", "cnn.safetensors", "cnn.onnx", "model_card.md"),
    *("model.json", "referenced_classifier.skops", "referenced_feature_names.json"),
)


@dataclass(frozen=True, slots=True)
class Judged:
    """One classifier on the test specimens.

    Attributes
    ----------
    name : str
        `indicators`, `rms` or `network`.
    scores : Scores
        Accuracy, macro-AUROC, confusion matrix.
    permuted_auroc : (repeats,) float64
        Macro-AUROC of the same classifier trained on permuted labels; empty where not run.
    details : dict
        How it was chosen: C, epochs, notes.
    """

    name: str
    scores: Scores
    permuted_auroc: np.ndarray
    details: dict[str, Any]


@dataclass(frozen=True, slots=True)
class TrainedNetworkFile:
    """A trained network and what its file says."""

    trained: TrainedNetwork
    facts: NetworkFile


@dataclass(frozen=True, slots=True)
class Training:
    """Everything that training a set gave: judged classifiers and the models to save."""

    judged: tuple[Judged, ...]
    classifier: FeatureClassifier
    network: TrainedNetworkFile | None
    split: SpecimenSplit
    specimens: dict[str, int]
    notes: tuple[str, ...]


def train_models(
    dataset: Any, table: pa.Table, seed: int, *, cnn: bool = True, stage: Stage = silent_stage
) -> Training:
    """Train and judge all classifiers of a set.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned; the network reads its signals.
    table : pyarrow.Table
        Its feature table.
    seed : int
        Seeds bootstrap, permutations and network.
    cnn : bool
        Whether to train the network.
    stage : Stage
        Told of every step.

    Raises
    ------
    DatasetError
        If the split cannot be used (see `specimen_split`) or records are too short for a window.
    """
    matrix = feature_matrix(table)
    split = specimen_split(matrix.labels)
    classifier, judged = _judge_indicators(matrix, split, seed, stage)
    results = [judged, _judge_rms(matrix, split, seed)]
    network = None
    if cnn:
        result, network = _judge_network(dataset, matrix, split, seed, stage)
        results.append(result)
    specimens = {name: _specimens(matrix, mask) for name, mask in _masks(split).items()}
    notes = dict.fromkeys(str(found.details["note"]) for found in results if found.details.get("note"))
    return Training(tuple(results), classifier, network, split, specimens, tuple(notes))


def _masks(split: SpecimenSplit) -> dict[str, np.ndarray]:
    return {"train": split.train, "validation": split.validation, "test": split.test}


def _specimens(matrix: FeatureMatrix, mask: np.ndarray) -> int:
    return int(np.unique(matrix.labels["specimen_id"][mask]).size)


def _judge_indicators(
    matrix: FeatureMatrix, split: SpecimenSplit, seed: int, stage: Stage
) -> tuple[FeatureClassifier, Judged]:
    model = train_classifier(matrix, split)
    with stage("permuted labels", PERMUTATIONS) as advance:
        permuted = permutation_control(matrix, split, seed, advance=advance)
    found = scores(model.predict(matrix.rows(split.test)), seed)
    details = {"features": len(model.features), "strength": model.strength, "note": model.note}
    return model, Judged(INDICATORS, found, permuted, details)


def _judge_rms(matrix: FeatureMatrix, split: SpecimenSplit, seed: int) -> Judged:
    alone = matrix.columns(rms_features(matrix.names))
    model = train_classifier(alone, split)
    details = {"features": len(model.features), "strength": model.strength, "note": model.note}
    return Judged(RMS_ALONE, scores(model.predict(alone.rows(split.test)), seed), np.empty(0), details)


def _judge_network(
    dataset: Any, matrix: FeatureMatrix, split: SpecimenSplit, seed: int, stage: Stage
) -> tuple[Judged, TrainedNetworkFile]:
    from diagnostics.cnn import TrainingSettings, network_predictions, train_network
    from diagnostics.cnn_files import describe_network
    from diagnostics.windows import order_records

    with stage("order-resampled windows", len(matrix.values)) as advance:
        records = order_records(dataset, advance=advance)
    truth, settings = state_index(matrix, split.classes), TrainingSettings()
    with stage("network", settings.most_epochs) as advance:
        trained = train_network(records, truth, split, seed, settings, advance)
    test, specimen = np.flatnonzero(split.test), matrix.labels["specimen_id"]
    found = scores(network_predictions(trained, records, test, truth, specimen), seed)
    short = TrainingSettings(most_epochs=PERMUTED_EPOCHS, patience=PERMUTED_EPOCHS)
    with stage("network on permuted labels", PERMUTED_EPOCHS) as advance:
        control = train_network(records, permuted_target(truth, split, seed, 0), split, seed, short, advance)
    permuted = _plain_auroc(network_predictions(control, records, test, truth, specimen))
    details = {
        "best_epoch": trained.best_epoch,
        "epochs": trained.epochs,
        "revolutions_per_window": records.settings.revolutions,
        "samples_per_revolution": records.settings.samples_per_revolution,
        "note": trained.note,
    }
    facts = describe_network(trained, records.channels, records.settings, set_identity(dataset))
    return Judged(NETWORK, found, np.array([permuted]), details), TrainedNetworkFile(trained, facts)


def _plain_auroc(predictions: Predictions) -> float:
    return float(macro_auroc(predictions, np.ones((1, predictions.truth.size)))[0])


def set_identity(dataset: Any) -> str:
    """Return the identity of a set, a SHA-256 of its configuration."""
    return str(dataset.manifest["identity"])


def training_metrics(training: Training) -> dict[str, Any]:
    """Return what `metrics.json` says about the classifiers."""
    return {
        "states": list(training.split.classes),
        "specimens": training.specimens,
        "notes": list(training.notes),
        "classifiers": {found.name: _judged_metrics(found) for found in training.judged},
    }


def _judged_metrics(found: Judged) -> dict[str, Any]:
    return {
        "title": TITLES[found.name],
        "test_specimens": found.scores.specimens,
        "test_records": found.scores.records,
        "accuracy": found.scores.accuracy.numbers(),
        "macro_auroc": found.scores.macro_auroc.numbers(),
        "chance_accuracy": 1.0 / len(found.scores.classes),
        "confusion": found.scores.confusion.tolist(),
        "permuted_macro_auroc": [float(area) for area in found.permuted_auroc],
        **{key: value for key, value in found.details.items() if value != ""},
    }


def save_models(training: Training, table: pa.Table, dataset: Any, folder: Path) -> list[str]:
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
    from diagnostics.classifier_file import save_classifier
    from diagnostics.model_card import model_card
    from diagnostics.prediction.release import release, save_release
    from diagnostics.prediction.release_card import release_card

    folder.mkdir(parents=True, exist_ok=True)
    for name in MODEL_FILES:  # a network of an earlier run must not lie beside a card that does not know it
        (folder / name).unlink(missing_ok=True)
    identity, notes = set_identity(dataset), []
    save_classifier(training.classifier, feature_settings(table), identity, folder)
    if training.network:
        from diagnostics.cnn_files import export_onnx, save_network

        network, facts = training.network.trained.network, training.network.facts
        save_network(network, facts, folder / "cnn.safetensors")
        try:
            export_onnx(network, facts, folder / "cnn.onnx")
        except (RuntimeError, ImportError) as error:
            notes.append(f"ONNX export failed: {error}")
    released = release(training, table, dataset)
    save_release(training, released, table, folder)
    notes += [released.note] if released.note else []
    card = f"{model_card(training, dataset)}\n{release_card(released)}"
    (folder / "model_card.md").write_text(card, encoding="utf-8")
    return notes
