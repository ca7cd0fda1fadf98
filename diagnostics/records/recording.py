"""Records of a set as numpy arrays, one at a time in the order of the files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.records.gear_train import further_meshes, teeth_columns
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

LABEL_NAMES = (
    *("record_id", "specimen_id", "state_id", "state", "operating_point_id", "repeat", "split"),
    *("fault", "severity", "damaged_area_mm2", "damaged_area_share", "mesh_stiffness_loss"),
    *("teeth_pinion", "teeth_gear", "speed_hz", "torque_nm"),
)
"""Columns that go along with the indicators; scalars only, so that they fit a CSV file."""

TACHO_NAME = "tacho_s"
CARRIER = "carrier_hz"
"""Column that planetary sets alone have."""
BATCH_ROWS = 16


@dataclass(frozen=True, slots=True)
class Recording:
    """One record: labels by column name, signals (n,) float32 by channel name, pulse times (k,) [s].

    `quantities` says what channels hold; those it does not name hold accelerations.
    """

    labels: Mapping[str, Any]
    channels: Mapping[str, np.ndarray]
    tacho_s: np.ndarray
    fs_hz: float
    quantities: Mapping[str, str] = field(default_factory=dict)


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
    labels = [*LABEL_NAMES, *teeth_columns(meshes_behind(dataset))]
    columns = [*labels, *(channel.column for channel in dataset.channels), TACHO_NAME]
    for split in dataset.splits if splits is None else splits:
        for batch in dataset.records(split=split, columns=columns, batch_rows=BATCH_ROWS):
            yield from _rows(batch if states is None else _in_states(batch, states), dataset, labels)


def meshes_behind(dataset: Dataset) -> tuple[str, ...]:
    """Return the names of a set's meshes behind the first one; none for gearboxes with one mesh.

    Raises
    ------
    UsageError
        If gearboxes are planetary sets.
    """
    names = dataset.labels().column_names
    if CARRIER in names:
        raise UsageError(
            f"{dataset.path}: received planetary sets (column {CARRIER}); allowed: pairs of gears on two shafts, with "
            "or without further stages. Read signals and labels with siggen.open"
        )
    return further_meshes(names)


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
    held = {channel.name: channel.quantity for channel in dataset.channels}
    for row in range(batch.num_rows):
        channels = {name: signal[row] for name, signal in signals.items()}
        yield Recording(labels[row], channels, np.asarray(tacho[row].values), dataset.fs_hz, held)
