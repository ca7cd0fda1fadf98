"""The folder of all models of a training: classifiers, network, facts for recordings and card."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa

from diagnostics.indicators.classifier_table import table_settings
from diagnostics.prediction.model_card import model_card
from diagnostics.prediction.model_seal import FACTS_FILE, MODEL_FILES
from diagnostics.prediction.release import release, save_release
from diagnostics.prediction.release_card import release_card
from diagnostics.scoring.prediction_file import PredictedRecords, write_predictions
from diagnostics.training.classifier_file import save_classifier
from diagnostics.training.splits import TEST, VALIDATION
from diagnostics.training.training import Training
from siggen.dataset.reading import Dataset


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
    folder.mkdir(parents=True, exist_ok=True)
    for name in (FACTS_FILE, *MODEL_FILES):
        # a network of an earlier run must not lie beside a card that does not know it
        (folder / name).unlink(missing_ok=True)
    identity, notes = set_identity(dataset), []
    save_classifier(training.classifier, table_settings(table), identity, folder)
    if training.network:
        from diagnostics.training.cnn_files import export_onnx, save_network

        network, facts = training.network.trained.network, training.network.facts
        save_network(network, facts, folder / "cnn.safetensors")
        try:
            export_onnx(network, facts, folder / "cnn.onnx")
        except (RuntimeError, ImportError) as error:
            notes.append(f"ONNX export failed: {error}")
    if training.circular:
        from diagnostics.training.circular_files import export_circular_onnx, save_circular

        save_circular(training.circular, folder / "circular.safetensors")
        try:
            export_circular_onnx(training.circular, folder / "circular.onnx")
        except (RuntimeError, ImportError) as error:
            notes.append(f"ONNX export of the circular network failed: {error}")
    write_predictions(_predicted(training, table), identity, folder)
    released = release(training, table, dataset)
    notes += [released.note] if released.note else []
    card = f"{model_card(training, dataset)}\n{release_card(released)}"
    (folder / "model_card.md").write_text(card, encoding="utf-8")
    save_release(training, released, table, folder)
    return notes


def _predicted(training: Training, table: pa.Table) -> list[PredictedRecords]:
    """Return what every classifier says of the validation and test records of the table."""
    record_id, split = np.asarray(table.column("record_id").to_pylist()), training.split
    parts = [(VALIDATION, split.validation, "validation"), (TEST, split.test, "predictions")]
    return [
        PredictedRecords(judged.name, name, record_id[mask], found)
        for judged in training.judged
        for name, mask, attribute in parts
        if (found := getattr(judged, attribute)) is not None
    ]


def set_identity(dataset: Dataset) -> str:
    """Return the identity of a set, a SHA-256 of its configuration."""
    return str(dataset.manifest["identity"])
