"""The network that comes with the package: what it makes of the records of a set, for any classifier to learn from.

    matrix = diagnostics.pretrained_features(siggen.open("runs/quickstart"))
    print(diagnostics.evaluate(make_pipeline(StandardScaler(), LogisticRegression()), matrix))

It has seen thousands of simulated gearboxes. A classifier that learns from its numbers needs few gearboxes of its own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.indicators.classifier_table import with_kinds
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.workers import mapped
from diagnostics.records.gear_train import meshes_of
from diagnostics.records.record_classes import STATE, check_dataset, set_classes
from diagnostics.records.recording import Recording, label_names, recordings
from diagnostics.records.state_classes import CLASS
from diagnostics.training.gear_rows import ACCELERATION, GearLines, gear_lines, gear_rows, joined
from diagnostics.training.gearbox_network import GEARS, GearboxNetwork, load_gearbox_network
from diagnostics.training.referenced import healthy_references
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

SHIPPED = Path(__file__).with_name("gearboxes.safetensors")
DAMAGE = "damage_log_odds"
CHUNK = 256


@cache
def shipped_network() -> tuple[GearboxNetwork, Mapping[str, Any]]:
    """Return the network that comes with the package, and what it covers."""
    return load_gearbox_network(SHIPPED)


def knows(dataset: Dataset) -> bool:
    """Return whether a set has what the network takes: one pair of gears, and accelerations."""
    meshes = meshes_of(dataset.drivetrain)
    return len(meshes) == 1 and meshes[0].planets is None and bool(_accelerations(dataset))


def _accelerations(dataset: Dataset) -> tuple[str, ...]:
    return tuple(channel.name for channel in dataset.channels if channel.quantity == ACCELERATION)


def gear_averages(dataset: Dataset, workers: int = 1) -> GearLines:
    """Return the averages of all records of a set that the network knows, in the order of its table."""
    return joined(list(mapped(recordings(dataset), partial(_averages, _accelerations(dataset)), workers)))


def _averages(channels: Sequence[str], record: Recording) -> GearLines:
    """Return those of one record; a function that other processes can take."""
    own = {name: record.channels[name] for name in channels}
    return gear_lines(own, record.tacho_s, record.fs_hz, record.train)


def heads(
    records: GearLines,
    healthy: GearLines | None = None,
    references: Sequence[np.ndarray] | np.ndarray | None = None,
    network: GearboxNetwork | None = None,
) -> np.ndarray:
    """Return what the network says of records, (records, numbers), as of `pretrained_features`.

    Parameters are those of `gear_rows`. Some hundred records are asked at once: rows take 8 KB a channel and gear.
    """
    asked, found = network or shipped_network()[0], []
    for start in range(0, len(records.lines), CHUNK):
        own = slice(start, start + CHUNK)
        rows = gear_rows(records.chosen(own), healthy, None if references is None else references[own])
        told = asked.tell(rows)
        parts = told.damage[:, None], told.kind, told.gear[:, :1] - told.gear[:, 1:2], told.size[:, 1:2]
        found.append(np.concatenate(parts, axis=1).astype(np.float64))
    return np.concatenate(found)


def pretrained_features(dataset: Dataset, *, beside: bool = False, classes: str = STATE) -> FeatureMatrix:
    """Return one row per record: labels, and what the shipped network says of it.

    Columns are the log odds of damage, of each kind and of the pinion against the gear, and the logarithm of the
    damaged share of the worst flank; means over the channels of acceleration.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned; of one pair of gears.
    beside : bool
        Whether records are seen beside other healthy records of their gearbox; only those that have such are returned.
    classes : str
        What the label `class` is: the `state` of a record, or its primary `fault`; healthy ones are one class.

    Raises
    ------
    DatasetError
        If no set is given.
    UsageError
        If it has several meshes, planets or no acceleration, or the classes are of an unknown kind.
    """
    check_dataset(dataset, "pretrained_features")
    if not knows(dataset):
        raise UsageError(
            f"{dataset.path}: received other gears than one pair, or no acceleration; allowed: one pair of gears, and "
            "one channel of acceleration or more"
        )
    rows = [{name: record.labels[name] for name in label_names(dataset)} for record in recordings(dataset)]
    labels = {name: np.array([row[name] for row in rows]) for name in label_names(dataset)}
    labels[CLASS] = set_classes(dataset, classes).of(labels["state"])
    lines, references = gear_averages(dataset), healthy_references(labels)
    values = heads(lines, lines, references) if beside else heads(lines)
    kinds = (f"{kind}_log_odds" for kind in shipped_network()[0].kinds)
    names = (DAMAGE, *kinds, f"{GEARS[0]}_log_odds", "log_damaged_share")
    matrix = with_kinds(FeatureMatrix(values, names, labels), dataset)
    return matrix.rows(np.array([known.size > 0 for known in references])) if beside else matrix
