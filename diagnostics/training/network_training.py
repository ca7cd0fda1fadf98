"""The network of a set: trained, calibrated, judged on test specimens, with its control on permuted labels."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from diagnostics.base.progress import Stage
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.record_classes import STATE, check_kind
from diagnostics.statistics.calibration import calibrated, fitted_temperature
from diagnostics.statistics.evaluation import Predictions, macro_auroc
from diagnostics.statistics.judgement import TITLES, Judged, judged, validation_score
from diagnostics.training.baselines import permuted_target, state_index
from diagnostics.training.splits import SpecimenSplit
from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.training.average_rows import AveragedRecords
    from diagnostics.training.cnn import NetworkSettings, TrainedNetwork

PERMUTED_EPOCHS = 15
DEVICES = ("cpu", "cuda")


@dataclass(frozen=True, slots=True)
class TrainedNetworkFile:
    """A trained network on averages, the channels it takes, and the identity of the set it was trained on."""

    trained: TrainedNetwork
    channels: tuple[str, ...]
    identity: str


@dataclass(frozen=True, slots=True)
class NetworkOptions:
    """How to train: what a class is, whether to train the network, where, and with changed paths and noise or not.

    Attributes
    ----------
    cnn : bool
        Whether to train it at all.
    device : str
        `cpu` or `cuda`.
    augment : bool
        Whether training averages pass random paths.
    classes : str
        What every classifier tells apart: `state`, or primary `fault`; healthy ones are one class.

    Raises
    ------
    UsageError
        If the classes are of an unknown kind.
    """

    cnn: bool = True
    device: str = "cpu"
    augment: bool = True
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


def judge_network(
    name: str,
    records: AveragedRecords,
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    seed: int,
    options: NetworkOptions,
    stage: Stage,
) -> tuple[TrainedNetwork, Judged]:
    """Train a network on averages and judge it on the test specimens.

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
        Device, and whether training averages pass random paths.
    stage : Stage
        Told of every epoch.
    """
    from diagnostics.training.cnn import NetworkSettings

    plain = NetworkSettings(device=options.device)
    settings = plain if options.augment else replace(plain, gain_db=0.0)
    truth = state_index(matrix, split.classes)
    trained = _trained(TITLES[name], records, truth, split, seed, settings, stage)
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
    seen = calibrated(validation, temperature) if split.validation.any() else None
    return replace(trained, temperature=temperature), replace(result, validation=seen)


def _trained(
    title: str,
    records: AveragedRecords,
    target: np.ndarray,
    split: SpecimenSplit,
    seed: int,
    settings: NetworkSettings,
    stage: Stage,
) -> TrainedNetwork:
    from diagnostics.training.cnn import train_network

    with stage(title, settings.most_epochs) as advance:
        return train_network(records, target, split, seed, settings, advance)


def _votes(trained: TrainedNetwork, records: AveragedRecords, matrix: FeatureMatrix, mask: np.ndarray) -> Predictions:
    from diagnostics.training.cnn import network_predictions

    truth = state_index(matrix, trained.classes)
    return network_predictions(trained, records, np.flatnonzero(mask), truth, matrix.labels["specimen_id"])


def _control(
    name: str,
    records: AveragedRecords,
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    seed: int,
    settings: NetworkSettings,
    stage: Stage,
) -> np.ndarray:
    """Return the macro-AUROC, (1,), after a short training on permuted labels."""
    short = replace(settings, most_epochs=PERMUTED_EPOCHS, patience=PERMUTED_EPOCHS)
    target = permuted_target(state_index(matrix, split.classes), split, seed, 0)
    found = _trained(f"permuted labels, {TITLES[name]}", records, target, split, seed, short, stage)
    votes = _votes(found, records, matrix, split.test)
    return macro_auroc(votes, np.ones((1, votes.truth.size)))


def network_predictions_of(network: TrainedNetworkFile, records: AveragedRecords, matrix: FeatureMatrix) -> Predictions:
    """Return uncalibrated predictions of all records of another set."""
    every = np.ones(len(records.teeth), dtype=bool)
    return _votes(replace(network.trained, temperature=1.0), records, matrix, every)
