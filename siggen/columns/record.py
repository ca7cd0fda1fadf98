"""The columns of a data set: the Arrow schema of a configuration, and records as Arrow batches."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from siggen.columns.damage import damage_columns
from siggen.columns.drivetrain import GearTrain, gear_train
from siggen.columns.labels import background_columns, channel_columns, common_columns
from siggen.columns.versions import SCHEMA_VERSION
from siggen.errors import DatasetError, counted
from siggen.keys.column import Column, Role, in_role, list_of
from siggen.mesh.contact_names import is_of_contact_alone
from siggen.sensing.measurement import converter_step

if TYPE_CHECKING:
    from siggen.gearbox.plan import PlannedRecord
    from siggen.gearbox.specimen import Specimen
    from siggen.motion.response import Sampling

BEFORE_QUANTITIES = "acceleration"
"""What channels hold in a set whose files do not say so."""


@dataclass(frozen=True, slots=True)
class ChannelColumn:
    """One axis of one sensor and the column that holds its signal, a `quantity` in a `unit`."""

    name: str
    sensor: str
    place: str
    axis: str
    unit: str
    column: str
    quantity: str = BEFORE_QUANTITIES

    @property
    def shown_unit(self) -> str:
        """The unit as pages and pictures show it."""
        return self.unit.replace("^2", "²").replace("^3", "³").replace("um", "µm")


@dataclass(frozen=True, slots=True)
class SimulatedRecord:
    """One simulated record.

    Attributes
    ----------
    planned
        Its place in the plan; gives the id columns.
    labels
        The state's name, and exactly the columns of `label_columns`.
    channels
        Channel name (`<sensor>_<axis>`) to float32 signal (n,) in the unit of the channel.
    tacho_s
        Times of the shaft pulses (k,), seconds from the first sample.
    internals
        Name -> (n,) of what no sensor sees, where the set stores it.
    """

    planned: PlannedRecord
    labels: Mapping[str, object]
    channels: Mapping[str, np.ndarray]
    tacho_s: np.ndarray
    internals: Mapping[str, np.ndarray] | None = None


@dataclass(frozen=True, slots=True)
class RecordFailure:
    """A record that could not be simulated, with the solver's status and its reason."""

    record_id: int
    status: str
    reason: str


ID_COLUMNS = in_role(
    Role.KEY,
    Column("record_id", pa.int64(), "", "index of the record in the plan"),
    Column("specimen_id", pa.int64(), "", "gearbox; splits never share one"),
    Column("state_id", pa.int32(), "", "position of the state in the configuration"),
    Column("state", pa.string(), "", "name of the state", Role.TARGET),
    Column(
        "operating_point_id", pa.int32(), "", "position of the operating point in the configuration", Role.CONDITION
    ),
    Column("repeat", pa.int32(), "", "repeat of the same gearbox, state and point"),
    Column("split", pa.string(), "", "train, validation or test"),
)
TACHO_COLUMN = Column(
    "tacho_s", list_of(pa.float64()), "s", "times of the input shaft's pulses from the first sample", Role.SIGNAL
)


@dataclass(frozen=True, slots=True)
class SetColumns:
    """Columns of the tables of a set, as one of its gearboxes has them, and what every file says of the set.

    Attributes
    ----------
    identity, sampling : of the set
    channels : in the order of its sensors and their axes
    steps : channel -> step of its converter
    labels : what `SimulatedRecord.labels` holds beside the state's name
    damage : of `damage/`
    quantities : of `internals/`; none where the set stores none
    drivetrain : what turns in its gearboxes
    lives : whether it has tables of `life/`
    """

    identity: str
    sampling: Sampling
    channels: tuple[ChannelColumn, ...]
    steps: Mapping[str, float]
    labels: tuple[Column, ...]
    damage: tuple[Column, ...]
    quantities: tuple[Column, ...]
    drivetrain: GearTrain
    lives: bool


def set_columns(gearbox: Specimen, identity: str, quantities: Sequence[Column] = ()) -> SetColumns:
    """Return the columns of the set of an identity by one of its gearboxes, and by what it stores beside channels."""
    return SetColumns(
        identity,
        gearbox.sampling,
        channels(gearbox),
        {one.name: converter_step(one.limit, one.bits) for one in gearbox.channels},
        label_columns(gearbox),
        damage_columns(gearbox),
        tuple(quantities),
        gear_train(gearbox),
        gearbox.life is not None,
    )


def channels(gearbox: Specimen) -> tuple[ChannelColumn, ...]:
    """Return the channels of a gearbox in the order of its sensors and their axes."""
    return tuple(
        ChannelColumn(
            *(one.name, one.sensor, one.place, one.axis),
            unit=one.quantity.unit,
            column=one.quantity.column(one.name),
            quantity=one.quantity.word,
        )
        for one in gearbox.channels
    )


def label_columns(gearbox: Specimen) -> tuple[Column, ...]:
    """Return what `SimulatedRecord.labels` holds: labels, conditions, errors of the gears, labels of every channel."""
    return *common_columns(gearbox), *channel_columns(gearbox), *background_columns(gearbox)


def record_schema(columns: SetColumns) -> pa.Schema:
    """Return the schema of `data/*.parquet`: ids, labels, operating, per-channel labels, signals, tacho."""
    signals = [_signal_field(columns, channel) for channel in columns.channels]
    return pa.schema([*label_schema(columns), *signals, TACHO_COLUMN.field()], metadata=schema_metadata(columns))


def label_schema(columns: SetColumns) -> pa.Schema:
    """Return the schema of `labels.parquet`: the columns before the signals."""
    labels = [column.field() for column in (*ID_COLUMNS, *columns.labels)]
    return pa.schema(labels, metadata=schema_metadata(columns))


def damage_schema(columns: SetColumns) -> pa.Schema:
    """Return the schema of `damage.parquet`."""
    return pa.schema([column.field() for column in columns.damage], metadata=schema_metadata(columns))


def schema_metadata(columns: SetColumns) -> dict[str, str]:
    """Return what every file of the set says about the set."""
    return {
        "fs_hz": repr(float(columns.sampling.fs_hz)),
        "duration_s": repr(float(columns.sampling.duration_s)),
        "siggen.identity": columns.identity,
        "siggen.schema_version": SCHEMA_VERSION,
    }


def channel_metadata(channel: ChannelColumn, fs_hz: float) -> dict[str, str]:
    """Return what a file says about the column of a channel."""
    return {
        "sensor": channel.sensor,
        "place": channel.place,
        "axis": channel.axis,
        "quantity": channel.quantity,
        "unit": channel.unit,
        "fs_hz": repr(float(fs_hz)),
    }


def _signal_field(columns: SetColumns, channel: ChannelColumn) -> pa.Field:
    step, sampling = columns.steps[channel.name], columns.sampling
    metadata = {**channel_metadata(channel, sampling.fs_hz), "converter_step": repr(step), "role": Role.SIGNAL}
    signal = list_of(pa.float32(), sampling.samples)
    return pa.field(channel.column, signal, nullable=False, metadata=metadata)


def listed_columns(schema: pa.Schema) -> list[dict[str, str]]:
    """Return what the manifest lists of every column of `data/*.parquet` that has a role, as of `ListedColumn`."""
    facts = {field.name: field.metadata or {} for field in schema}
    kept = ("role", "section", "quantity", "of")
    return [
        {"name": name} | {key: own[key.encode()].decode() for key in kept if key.encode() in own}
        for name, own in facts.items()
        if b"role" in own
    ]


def record_batch(columns: SetColumns, records: Sequence[SimulatedRecord]) -> pa.RecordBatch:
    """Return records as rows of `record_schema`.

    Raises
    ------
    DatasetError
        If a record lacks a column, has one too many, holds a null or NaN, or a signal of another length or type.
    """
    schema = record_schema(columns)
    for record in records:
        _check_record(columns, record)
    arrays: dict[str, pa.Array] = {}
    for column in (*ID_COLUMNS, *columns.labels):
        arrays[column.name] = pa.array([record_value(record, column.name) for record in records], column.type)
    for channel in columns.channels:
        signals = [record.channels[channel.name] for record in records]
        arrays[channel.column] = signal_array(signals, schema.field(channel.column).type)
    tacho_s = [np.asarray(record.tacho_s, dtype=np.float64) for record in records]
    arrays[TACHO_COLUMN.name] = pa.array(tacho_s, TACHO_COLUMN.type)
    _check_nulls(arrays)
    return pa.RecordBatch.from_arrays([arrays[name] for name in schema.names], schema=schema)


def signal_matrix(column: pa.FixedSizeListArray | pa.ChunkedArray) -> np.ndarray:
    """Return a signal column as a float32 matrix (rows, samples); without a copy for a single chunk."""
    array = column.combine_chunks() if isinstance(column, pa.ChunkedArray) else column
    # flatten() respects slices; .values would return the whole parent buffer
    return np.asarray(array.flatten().to_numpy(zero_copy_only=True).reshape(len(array), array.type.list_size))


def signal_array(signals: Sequence[np.ndarray], signal_type: pa.DataType) -> pa.FixedSizeListArray:
    """Return signals of one length as a column; there may be none."""
    values = np.concatenate(signals) if signals else np.empty(0, dtype=np.float32)
    return pa.FixedSizeListArray.from_arrays(pa.array(values, pa.float32()), type=signal_type)


def record_value(record: SimulatedRecord, name: str) -> object:
    """Return a label of a record, or an id from its place in the plan."""
    return record.labels[name] if name in record.labels else getattr(record.planned, name)


def _check_record(columns: SetColumns, record: SimulatedRecord) -> None:
    where = f"record {record.planned.record_id}"
    _check_names(where, "labels", record.labels, ["state", *(column.name for column in columns.labels)])
    _check_names(where, "channels", record.channels, [channel.name for channel in columns.channels])
    samples = columns.sampling.samples
    for name, signal in record.channels.items():
        if signal.shape != (samples,) or signal.dtype != np.float32:
            received = f"{signal.dtype} of shape {signal.shape}"
            raise DatasetError(
                f"{where}, channel {name}: received {received}; a signal is float32 of shape ({samples},)"
            )
    if reason := non_finite(record):
        raise DatasetError(f"{where}: {reason}; a record that could not be simulated is a RecordFailure, never a row")


def non_finite(record: SimulatedRecord) -> str:
    """Return what in a record is NaN or infinite, or an empty string.

    Allowed are an infinite signal-to-noise ratio, and NaN in what a tooth pair has only while it touches.
    """
    for name, signal in record.channels.items():
        if not np.isfinite(signal).all():
            return f"channel {name} has {counted(int((~np.isfinite(signal)).sum()), 'value')} not finite"
    for name, label in record.labels.items():
        if isinstance(label, float) and np.isnan(label):
            return f"label {name} is NaN"
    for name, values in (record.internals or {}).items():
        bad = np.isinf(values) if is_of_contact_alone(name) else ~np.isfinite(values)
        if bad.any():
            return f"internal quantity {name} has {counted(int(bad.sum()), 'value')} not finite"
    return "" if np.isfinite(record.tacho_s).all() else "tacho_s is not finite"


def _check_names(where: str, what: str, received: Mapping[str, object], allowed: Sequence[str]) -> None:
    missing = [name for name in allowed if name not in received]
    unknown = sorted(set(received) - set(allowed))
    if missing or unknown:
        raise DatasetError(f"{where}: {what} lack {missing or 'nothing'} and have unknown {unknown or 'nothing'}")


def _check_nulls(columns: Mapping[str, pa.Array]) -> None:
    with_nulls = [name for name, array in columns.items() if array.null_count]
    if with_nulls:
        raise DatasetError(f"columns {with_nulls} hold nulls; every column of a set is complete")
