"""A small set with internal quantities and a model trained on it: what bits are flipped in."""

from __future__ import annotations

from pathlib import Path

from benchmarks.shipped import QUICKSTART, shipped
from siggen.sets.generation import generate

OVERRIDES = ("specimens=20", "internals={quantities: [mesh_force_n]}")


def small_set(folder: Path) -> Path:
    """Generate 20 gearboxes with the linear mesh law and return their folder."""
    generate(shipped(QUICKSTART, *OVERRIDES), folder)
    return folder


def small_model(dataset_folder: Path, folder: Path) -> Path:
    """Train the classifiers on indicators, without the network, and return their folder."""
    import siggen
    from diagnostics.base.progress import silent_stage
    from diagnostics.judging.of_split import NetworkOptions, train_models
    from diagnostics.judging.sets import set_table
    from diagnostics.prediction.saved_models import save_models

    dataset = siggen.open(dataset_folder)
    table = set_table(dataset, silent_stage)
    save_models(train_models(dataset, table, 0, network=NetworkOptions(cnn=False)), table, dataset, folder)
    return folder
