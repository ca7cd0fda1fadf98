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
from diagnostics.statistics.judgement import NETWORK, Judged, judged, validation_score
from diagnostics.training.baselines import permuted_target, state_index
from diagnostics.training.splits import SpecimenSplit
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.loader.windows import OrderRecords
    from diagnostics.training.cnn import TrainedNetwork, TrainingSettings
    from diagnostics.training.cnn_files import NetworkFile

PERMUTED_EPOCHS = 15
DEVICES = ("cpu", "cuda")


@dataclass(frozen=True, slots=True)
class TrainedNetworkFile:
    """A trained network and what its file says."""

    trained: TrainedNetwork
    facts: NetworkFile


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
        Whether training windows pass random paths.
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


def network_records(dataset: Dataset, stage: Stage) -> OrderRecords:
    """Return what the network takes of a set.

    Raises
    ------
    DatasetError
        If records are too short for a window.
    """
    from diagnostics.loader.windows import order_records

    with stage("order-resampled windows", dataset.labels(columns=["record_id"]).num_rows) as advance:
        return order_records(dataset, advance=advance)


def judge_networks(
    identity: str,
    records: OrderRecords,
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    seed: int,
    options: NetworkOptions,
    stage: Stage,
) -> tuple[list[Judged], TrainedNetworkFile]:
    """Train and judge the network."""
    from diagnostics.loader.augmentation import Augmentation
    from diagnostics.training.cnn import TrainingSettings
    from diagnostics.training.cnn_files import describe_network

    settings = TrainingSettings(augmentation=Augmentation() if options.augment else None, device=options.device)
    trained, first = _judge(NETWORK, records, matrix, split, seed, settings, stage)
    results = [replace(first, permuted_auroc=_control(records, matrix, split, seed, settings, stage))]
    facts = describe_network(trained, records.channels, records.settings, identity)
    return results, TrainedNetworkFile(trained, facts)


def _judge(
    name: str,
    records: OrderRecords,
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    seed: int,
    settings: TrainingSettings,
    stage: Stage,
) -> tuple[TrainedNetwork, Judged]:
    from diagnostics.training.cnn import train_network

    truth = state_index(matrix, split.classes)
    with stage(name.replace("_", " "), settings.most_epochs) as advance:
        trained = train_network(records, truth, split, seed, settings, advance)
    validation = _votes(trained, records, matrix, split.validation, split.classes)
    temperature = fitted_temperature(validation)
    found = _votes(trained, records, matrix, split.test, split.classes)
    details = {
        "best_epoch": trained.best_epoch,
        "epochs": trained.epochs,
        "revolutions_per_window": records.settings.revolutions,
        "samples_per_revolution": records.settings.samples_per_revolution,
        "augmented": settings.augmentation is not None,
        "device": settings.device,
        "note": trained.note,
        **validation_score(validation),
    }
    result = judged(name, found, temperature, np.empty(0), details, seed, split.healthy)
    return replace(trained, temperature=temperature), replace(result, validation=calibrated(validation, temperature))


def _votes(
    trained: TrainedNetwork, records: OrderRecords, matrix: FeatureMatrix, mask: np.ndarray, classes: tuple[str, ...]
) -> Predictions:
    from diagnostics.training.cnn import network_predictions

    specimen = matrix.labels["specimen_id"]
    return network_predictions(trained, records, np.flatnonzero(mask), state_index(matrix, classes), specimen)


def _control(
    records: OrderRecords,
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    seed: int,
    settings: TrainingSettings,
    stage: Stage,
) -> np.ndarray:
    """Return the macro-AUROC, (1,), after a short training on permuted labels."""
    from diagnostics.training.cnn import train_network

    short = replace(settings, most_epochs=PERMUTED_EPOCHS, patience=PERMUTED_EPOCHS)
    target = permuted_target(state_index(matrix, split.classes), split, seed, 0)
    with stage("network on permuted labels", PERMUTED_EPOCHS) as advance:
        control = train_network(records, target, split, seed, short, advance)
    found = _votes(control, records, matrix, split.test, split.classes)
    return macro_auroc(found, np.ones((1, found.truth.size)))
