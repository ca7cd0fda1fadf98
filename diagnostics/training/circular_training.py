"""The circular network of a set: trained on averages alone, calibrated, judged, with its control on permuted labels.

The network on averages on disk: as safetensors, which cannot execute anything, and as ONNX for other programs.

The safetensors file carries classes, channels, identity of the set and temperature in its metadata.
"""

from __future__ import annotations

import json
import warnings
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import load_file, save_file

from diagnostics.base.progress import Stage
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.statistics.calibration import calibrated, fitted_temperature
from diagnostics.statistics.evaluation import Predictions, macro_auroc
from diagnostics.statistics.judgement import Judged, judged, validation_score
from diagnostics.training.average_rows import ROWS, STEPS
from diagnostics.training.baselines import permuted_target, state_index
from diagnostics.training.circular_network import CircularNetwork
from diagnostics.training.cnn_files import check_finite
from diagnostics.training.network_training import PERMUTED_EPOCHS, NetworkOptions
from diagnostics.training.splits import SpecimenSplit
from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.training.average_rows import AveragedRecords
    from diagnostics.training.circular_network import CircularSettings, TrainedCircular

FORMAT = "siggen-diagnostics circular network 1"


@dataclass(frozen=True, slots=True)
class CircularFacts:
    """What a file of a network on averages says about it.

    Attributes
    ----------
    classes, channels : tuple of str
        States in the order of the outputs; channels in the order of the rows, see `average_rows`.
    identity : str
        Identity of the set it was trained on.
    temperature : float
        Applied to the mean probabilities of a recording's pieces; not in the network.
    """

    classes: tuple[str, ...]
    channels: tuple[str, ...]
    identity: str
    temperature: float = 1.0


def save_circular(found: TrainedCircularFile, path: Path) -> None:
    """Write weights and facts as safetensors; the facts are JSON under the metadata key `facts`."""
    trained = found.trained
    facts = CircularFacts(trained.classes, found.channels, found.identity, trained.temperature)
    weights = {name: value.contiguous() for name, value in trained.network.state_dict().items()}
    save_file(weights, path, metadata={"format": FORMAT, "facts": json.dumps(asdict(facts))})


def load_circular(path: Path) -> tuple[CircularNetwork, CircularFacts]:
    """Read a network written by `save_circular`; nothing in the file is executed.

    Raises
    ------
    UsageError
        If the file is not one.
    """
    try:
        with safe_open(path, framework="pt") as file:
            metadata = file.metadata() or {}
    except (OSError, SafetensorError) as error:
        raise UsageError(f"{path}: cannot be read as safetensors ({error})") from error
    if metadata.get("format") != FORMAT:
        raise UsageError(f"{path}: received format {metadata.get('format')!r}; allowed is {FORMAT!r}")
    try:
        found = json.loads(metadata["facts"])
        facts = CircularFacts(
            tuple(found["classes"]), tuple(found["channels"]), str(found["identity"]), float(found["temperature"])
        )
        network = CircularNetwork(ROWS * len(facts.channels), len(facts.classes))
        network.load_state_dict(load_file(path))
    except (KeyError, TypeError, ValueError, RuntimeError, SafetensorError) as error:
        text = str(error).splitlines()[0]
        raise UsageError(f"{path}: received facts or weights of another schema ({text}); train again") from error
    check_finite(path, network, facts.temperature)
    network.eval()
    return network, facts


def export_circular_onnx(found: TrainedCircularFile, path: Path) -> None:
    """Write the network as ONNX, for any batch size.

    Input `rows` (batch, 3 channels, 1024) in m/s^2 as of `average_rows`, output `logits` (batch, classes).
    """
    example = torch.ones(2, ROWS * len(found.channels), STEPS)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the legacy exporter needs no further package; it announces its successor
        torch.onnx.export(
            found.trained.network,
            (example,),
            str(path),
            dynamo=False,
            input_names=["rows"],
            output_names=["logits"],
            dynamic_axes={"rows": {0: "batch"}, "logits": {0: "batch"}},
        )


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
