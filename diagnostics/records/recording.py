"""Records of a set as numpy arrays, one at a time in the order of the files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.records.gear_train import PAIR, GearNames, further_meshes, teeth_columns
from diagnostics.records.planetary_members import AS_PAIR, MEMBERS, as_pair, is_planetary, own_columns, planets_of
from diagnostics.signal.order_domain import geared_pulses
from siggen.dataset.reading import Dataset

LABEL_NAMES = (
    *("record_id", "specimen_id", "state_id", "state", "operating_point_id", "repeat", "split"),
    *("fault", "severity", "damaged_area_mm2", "damaged_area_share", "mesh_stiffness_loss"),
    *("teeth_pinion", "teeth_gear", "speed_hz", "torque_nm"),
)
"""Columns that go along with the indicators; scalars only, so that they fit a CSV file."""

TACHO_NAME = "tacho_s"
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
    names = gear_names(dataset)
    labels = own_columns(LABEL_NAMES) if names.is_planetary else [*LABEL_NAMES, *teeth_columns(names.meshes)]
    columns = [*labels, *(channel.column for channel in dataset.channels), TACHO_NAME]
    for split in dataset.splits if splits is None else splits:
        for batch in dataset.records(split=split, columns=columns, batch_rows=BATCH_ROWS):
            yield from _rows(batch if states is None else _in_states(batch, states), dataset, labels)


def gear_names(dataset: Dataset) -> GearNames:
    """Return what columns of a set's indicators are called after: shafts, and meshes behind the first one."""
    names = dataset.labels().column_names
    return GearNames(shafts=MEMBERS) if is_planetary(names) else GearNames(PAIR.shafts, further_meshes(names))


def pair_teeth(dataset: Dataset) -> tuple[str, str]:
    """Return the label columns that hold the teeth of a set's pair: pinion and gear, or sun and ring."""
    planetary = gear_names(dataset).is_planetary
    pinion, gear = (own if planetary else name for name, own in AS_PAIR.items())
    return pinion, gear


def turned(labels: dict[str, Any], tacho_s: np.ndarray) -> tuple[dict[str, Any], np.ndarray]:
    """Return labels and pulse times (k,) [s] of a record as those of a pair.

    Of a planetary set the pulses are those of the sun against the carrier; other records stay as they are.
    """
    planets = planets_of(labels)
    return (labels, tacho_s) if planets is None else (as_pair(labels), geared_pulses(tacho_s, planets.sun_turns))


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
        own, pulses = turned(labels[row], np.asarray(tacho[row].values))
        yield Recording(own, channels, pulses, dataset.fs_hz, held)
