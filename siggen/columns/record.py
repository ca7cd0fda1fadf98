"""The columns of a data set: the Arrow schema of a configuration, and records as Arrow batches."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from siggen.columns.background_columns import background_columns
from siggen.columns.common_columns import common_columns
from siggen.columns.damage_columns import damage_columns
from siggen.columns.instrument_columns import instrument_columns
from siggen.columns.versions import SCHEMA_VERSION
from siggen.dynamics.mesh.contact_names import is_of_contact_alone
from siggen.errors import DatasetError, counted
from siggen.keys.column import DECIBEL, Column, Role, in_role, list_of

if TYPE_CHECKING:
    from siggen.config import Config
    from siggen.planning.plan import PlannedRecord
    from siggen.sensors.quantity import Quantity

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
        Exactly the names of `label_names(config)`: the state's name, and the columns of `label_columns(config)`.
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
    Column("record_id", pa.int64(), "", "index of the record in the plan; a pure function of the configuration"),
    Column("specimen_id", pa.int64(), "", "gearbox the record belongs to; splits never share one"),
    Column("state_id", pa.int32(), "", "position of the damage state in the configuration"),
    Column("state", pa.string(), "", "name of the damage state", Role.TARGET),
    Column(
        "operating_point_id", pa.int32(), "", "position of the operating point in the configuration", Role.CONDITION
    ),
    Column("repeat", pa.int32(), "", "repeat of the same specimen, state and operating point"),
    Column("split", pa.string(), "", "train, validation or test"),
)
TACHO_COLUMN = Column(
    "tacho_s", list_of(pa.float64()), "s", "times of the input shaft's pulses from the first sample", Role.SIGNAL
)


def channels(config: Config) -> tuple[ChannelColumn, ...]:
    """Return the channels of a configuration in the order of its sensors and their axes."""
    return tuple(
        ChannelColumn(
            name=name,
            sensor=sensor.name,
            place=sensor.place,
            axis=axis,
            unit=sensor.quantity.unit,
            column=sensor.quantity.column(name),
            quantity=sensor.quantity.word,
        )
        for sensor in config.sensors
        for name, axis in sensor.channels
    )


def channel_label_columns(channel: str, quantity: Quantity) -> tuple[Column, ...]:
    """Return the columns that describe one channel of one record."""
    floor = f"noise_floor_{channel}_{quantity.suffix}"
    level = f"power of the signal over the white noise in {channel}"
    return in_role(
        Role.PROVENANCE,
        Column(floor, pa.float64(), quantity.unit, f"RMS of the white noise in {channel}"),
        Column(f"snr_{channel}_db", pa.float64(), DECIBEL, level, Role.CONSEQUENCE),
        Column(f"clipped_share_{channel}", pa.float64(), "", f"share of clipped samples in {channel}", Role.MEASURED),
        section="sensors",
    )


def label_columns(config: Config) -> tuple[Column, ...]:
    """Return what `SimulatedRecord.labels` holds: labels, conditions, errors of the gears, labels of every channel."""
    named = ((name, sensor.quantity) for sensor in config.sensors for name, _ in sensor.channels)
    per_channel = (column for one in named for column in channel_label_columns(*one))
    return (*common_columns(config), *per_channel, *instrument_columns(config), *background_columns(config))


def named_labels(config: Config, labels: Mapping[str, object]) -> dict[str, object]:
    """Return the labels of a record by the names of their columns."""
    column_of = {column.filled_by: column.name for column in label_columns(config)}
    named = {column_of.get(label, label): value for label, value in labels.items()}
    return {**named, "faulty_gear": config.names.gear(str(labels["faulty_gear"]))}


def label_names(config: Config) -> tuple[str, ...]:
    """Return the keys of `SimulatedRecord.labels`."""
    return ("state", *(column.name for column in label_columns(config)))


def record_schema(config: Config) -> pa.Schema:
    """Return the schema of `data/*.parquet`: ids, labels, operating, per-channel labels, signals, tacho."""
    signals = [_signal_field(config, channel) for channel in channels(config)]
    labels = [column.field() for column in (*ID_COLUMNS, *label_columns(config))]
    return pa.schema([*labels, *signals, TACHO_COLUMN.field()], metadata=schema_metadata(config))


def label_schema(config: Config) -> pa.Schema:
    """Return the schema of `metadata/*.parquet`: the columns before the signals."""
    labels = [column.field() for column in (*ID_COLUMNS, *label_columns(config))]
    return pa.schema(labels, metadata=schema_metadata(config))


def damage_schema(config: Config) -> pa.Schema:
    """Return the schema of `damage/*.parquet`."""
    return pa.schema([column.field() for column in damage_columns(config)], metadata=schema_metadata(config))


def schema_metadata(config: Config) -> dict[str, str]:
    """Return what every file of the set says about the set."""
    return {
        "fs_hz": repr(float(config.fs_hz)),
        "duration_s": repr(float(config.duration_s)),
        "siggen.identity": config.identity,
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


def _signal_field(config: Config, channel: ChannelColumn) -> pa.Field:
    step = next(sensor.converter_step for sensor in config.sensors if sensor.name == channel.sensor)
    metadata = {**channel_metadata(channel, config.fs_hz), "converter_step": repr(step), "role": Role.SIGNAL}
    signal = list_of(pa.float32(), config.samples)
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


def signal_channels(schema: pa.Schema) -> tuple[ChannelColumn, ...]:
    """Return the channels that a file's schema describes, in column order."""
    found = []
    for field in schema:
        facts = {key.decode(): value.decode() for key, value in (field.metadata or {}).items()}
        if pa.types.is_fixed_size_list(field.type) and "sensor" in facts:
            place = facts["sensor"], facts["place"], facts["axis"]
            quantity = facts.get("quantity", BEFORE_QUANTITIES)
            found.append(ChannelColumn(f"{place[0]}_{place[2]}", *place, facts["unit"], field.name, quantity))
    return tuple(found)


def record_batch(config: Config, records: Sequence[SimulatedRecord]) -> pa.RecordBatch:
    """Return records as rows of `record_schema(config)`.

    Raises
    ------
    DatasetError
        If a record lacks a column, has one too many, holds a null or NaN, or a signal of another length or type.
    """
    schema = record_schema(config)
    for record in records:
        _check_record(config, record)
    columns: dict[str, pa.Array] = {}
    for column in (*ID_COLUMNS, *label_columns(config)):
        columns[column.name] = pa.array([record_value(record, column.name) for record in records], column.type)
    for channel in channels(config):
        signals = [record.channels[channel.name] for record in records]
        columns[channel.column] = _signal_array(signals, schema.field(channel.column).type)
    tacho_s = [np.asarray(record.tacho_s, dtype=np.float64) for record in records]
    columns[TACHO_COLUMN.name] = pa.array(tacho_s, TACHO_COLUMN.type)
    _check_nulls(columns)
    return pa.RecordBatch.from_arrays([columns[name] for name in schema.names], schema=schema)


def signal_matrix(column: pa.FixedSizeListArray | pa.ChunkedArray) -> np.ndarray:
    """Return a signal column as a float32 matrix (rows, samples); without a copy for a single chunk."""
    array = column.combine_chunks() if isinstance(column, pa.ChunkedArray) else column
    # flatten() respects slices; .values would return the whole parent buffer
    return np.asarray(array.flatten().to_numpy(zero_copy_only=True).reshape(len(array), array.type.list_size))


def _signal_array(signals: Sequence[np.ndarray], signal_type: pa.DataType) -> pa.FixedSizeListArray:
    values = np.concatenate(signals) if signals else np.empty(0, dtype=np.float32)
    return pa.FixedSizeListArray.from_arrays(pa.array(values, pa.float32()), type=signal_type)


def record_value(record: SimulatedRecord, name: str) -> object:
    """Return a label of a record, or an id from its place in the plan."""
    return record.labels[name] if name in record.labels else getattr(record.planned, name)


def _check_record(config: Config, record: SimulatedRecord) -> None:
    where = f"record {record.planned.record_id}"
    _check_names(where, "labels", record.labels, label_names(config))
    _check_names(where, "channels", record.channels, [channel.name for channel in channels(config)])
    samples = config.samples
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
