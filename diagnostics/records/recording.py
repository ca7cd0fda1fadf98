"""Records of a set as numpy arrays, one at a time in the order of the files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.records.gear_train import GearNames, gear_names, meshes_of, with_teeth
from diagnostics.signal.order_domain import geared_pulses
from siggen.columns.drivetrain import GearTrain
from siggen.dataset.reading import Dataset

LABEL_NAMES = (
    *("record_id", "specimen_id", "state_id", "state", "operating_point_id", "repeat", "split"),
    *("fault", "severity", "damaged_area_mm2", "damaged_area_share", "mesh_stiffness_loss"),
)
OPERATING = ("speed_hz", "torque_nm")
TACHO_NAME = "tacho_s"
BATCH_ROWS = 16


@dataclass(frozen=True, slots=True)
class Recording:
    """One record: labels by column name, signals (n,) float32 by channel name, pulse times (k,) [s].

    `train` has the teeth of its gearbox. `quantities` says what channels hold; those it does not name hold
    accelerations.
    """

    labels: Mapping[str, Any]
    channels: Mapping[str, np.ndarray]
    tacho_s: np.ndarray
    fs_hz: float
    train: GearTrain
    quantities: Mapping[str, str] = field(default_factory=dict)

    @property
    def teeth(self) -> tuple[int, int]:
        """Of the first mesh."""
        return meshes_of(self.train)[0].teeth


def names_of(dataset: Dataset) -> GearNames:
    """Return what columns of a set's indicators are called after."""
    return gear_names(dataset.drivetrain)


def pair_teeth(dataset: Dataset) -> tuple[str, str]:
    """Return the label columns with the teeth of the first and the last gear of a set's first mesh."""
    first, *_, last = names_of(dataset)[0].gears
    columns = dataset.columns_of("teeth")
    return columns[first], columns[last]


def label_names(dataset: Dataset) -> tuple[str, ...]:
    """Return the columns that go along with the indicators; scalars only, so that they fit a CSV file."""
    return (*LABEL_NAMES, *pair_teeth(dataset), *OPERATING)


def recordings(
    dataset: Dataset, splits: Sequence[str] | None = None, states: Sequence[str] | None = None
) -> Iterator[Recording]:
    """Yield the records of a set.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    splits : sequence of str, optional
        Splits to read, in this order; default all.
    states : sequence of str, optional
        States to read; default all.
    """
    labels = list(dict.fromkeys([*label_names(dataset), *dataset.columns_of("teeth").values()]))
    columns = [*labels, *(channel.column for channel in dataset.channels), TACHO_NAME]
    for split in dataset.splits if splits is None else splits:
        for batch in dataset.records(split=split, columns=columns, batch_rows=BATCH_ROWS):
            yield from _rows(batch if states is None else _in_states(batch, states), dataset, labels)


def one_recording(dataset: Dataset, number: int) -> Recording:
    """Return the record of a number, with all of its labels."""
    found = dataset.record(number)
    signals = {channel.name: found[channel.column] for channel in dataset.channels}
    return _recording(dataset, found, signals, found[TACHO_NAME])


def _in_states(batch: Any, states: Sequence[str]) -> Any:
    return batch.filter(pc.is_in(batch.column("state"), value_set=pa.array(states)))


def _rows(batch: Any, dataset: Dataset, names: list[str]) -> Iterator[Recording]:
    labels = batch.select(names).to_pylist()
    # flatten() respects the offset of a sliced batch, .values does not
    signals = {
        channel.name: batch.column(channel.column).flatten().to_numpy().reshape(batch.num_rows, -1)
        for channel in dataset.channels
    }
    tacho = batch.column(TACHO_NAME)
    for row in range(batch.num_rows):
        channels = {name: signal[row] for name, signal in signals.items()}
        yield _recording(dataset, labels[row], channels, tacho[row].values)


def _recording(
    dataset: Dataset, labels: Mapping[str, Any], channels: Mapping[str, np.ndarray], tacho_s: Any
) -> Recording:
    """Return a record; of a planetary set with the pulses of the sun against the carrier."""
    teeth = {gear: labels[column] for gear, column in dataset.columns_of("teeth").items()}
    train, pulses = with_teeth(dataset.drivetrain, teeth), np.asarray(tacho_s)
    if names_of(dataset)[0].planetary:
        planets = meshes_of(train)[0].planets
        assert planets is not None
        pulses = geared_pulses(pulses, planets.sun_turns)
    held = {channel.name: channel.quantity for channel in dataset.channels}
    return Recording(labels, channels, pulses, dataset.fs_hz, train, held)
