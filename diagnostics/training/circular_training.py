"""The circular network of a set: trained on averages alone, calibrated, judged, with its control on permuted labels."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from diagnostics.base.progress import Stage
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.statistics.calibration import calibrated, fitted_temperature
from diagnostics.statistics.evaluation import Predictions, macro_auroc
from diagnostics.statistics.judgement import Judged, judged, validation_score
from diagnostics.training.baselines import permuted_target, state_index
from diagnostics.training.network_training import PERMUTED_EPOCHS, NetworkOptions
from diagnostics.training.splits import SpecimenSplit

if TYPE_CHECKING:
    from diagnostics.training.average_rows import AveragedRecords
    from diagnostics.training.circular_network import CircularSettings, TrainedCircular


def judge_circular(
    name: str,
    records: AveragedRecords,
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    seed: int,
    options: NetworkOptions,
    stage: Stage,
) -> tuple[TrainedCircular, Judged]:
    """Train a network on averages and judge it on the test specimens.

    Parameters
    ----------
    name : str
        `circular`, or `circular_referenced` for averages beside a healthy reference.
    records : AveragedRecords
        All records of the matrix, in its order.
    matrix : FeatureMatrix
        Labels of the records.
    split : SpecimenSplit
        Whose specimens are which.
    seed : int
        Seeds weights, paths and bootstrap.
    options : NetworkOptions
        Device, and whether training averages pass random paths.
    stage : Stage
        Told of every epoch.
    """
    from diagnostics.training.circular_network import CircularSettings

    plain = CircularSettings(device=options.device)
    settings = plain if options.augment else replace(plain, gain_db=0.0)
    truth = state_index(matrix, split.classes)
    trained = _trained(name.replace("_", " "), records, truth, split, seed, settings, stage)
    validation = _votes(trained, records, matrix, split.validation)
    temperature = fitted_temperature(validation)
    details = {
        "best_epoch": trained.best_epoch,
        "epochs": trained.epochs,
        "augmented": options.augment,
        "device": options.device,
        "note": trained.note,
        **validation_score(validation),
    }
    found = _votes(trained, records, matrix, split.test)
    control = _control(name, records, matrix, split, seed, settings, stage)
    result = judged(name, found, temperature, control, details, seed, split.healthy)
    return replace(trained, temperature=temperature), replace(result, validation=calibrated(validation, temperature))


def _trained(
    title: str,
    records: AveragedRecords,
    target: np.ndarray,
    split: SpecimenSplit,
    seed: int,
    settings: CircularSettings,
    stage: Stage,
) -> TrainedCircular:
    from diagnostics.training.circular_network import train_circular

    with stage(f"{title} network", settings.most_epochs) as advance:
        return train_circular(records, target, split, seed, settings, advance)


def _votes(trained: TrainedCircular, records: AveragedRecords, matrix: FeatureMatrix, mask: np.ndarray) -> Predictions:
    from diagnostics.training.circular_network import circular_predictions

    truth = state_index(matrix, trained.classes)
    return circular_predictions(trained, records, np.flatnonzero(mask), truth, matrix.labels["specimen_id"])


def _control(
    name: str,
    records: AveragedRecords,
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    seed: int,
    settings: CircularSettings,
    stage: Stage,
) -> np.ndarray:
    """Return the macro-AUROC, (1,), after a short training on permuted labels."""
    short = replace(settings, most_epochs=PERMUTED_EPOCHS, patience=PERMUTED_EPOCHS)
    target = permuted_target(state_index(matrix, split.classes), split, seed, 0)
    found = _trained(f"permuted labels, {name.replace('_', ' ')}", records, target, split, seed, short, stage)
    votes = _votes(found, records, matrix, split.test)
    return macro_auroc(votes, np.ones((1, votes.truth.size)))


@dataclass(frozen=True, slots=True)
class TrainedCircularFile:
    """A trained network on averages, the channels it takes, and the identity of the set it was trained on."""

    trained: TrainedCircular
    channels: tuple[str, ...]
    identity: str


def circular_predictions_of(
    network: TrainedCircularFile, records: AveragedRecords, matrix: FeatureMatrix
) -> Predictions:
    """Return uncalibrated predictions of all records of another set."""
    every = np.ones(len(records.teeth), dtype=bool)
    return _votes(replace(network.trained, temperature=1.0), records, matrix, every)
