"""The columns of a data set: the Arrow schema of a configuration, and records as Arrow batches."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from siggen.columns.background_columns import background_columns
from siggen.columns.damage_columns import damage_columns
from siggen.columns.gearbox_columns import gearbox_columns
from siggen.columns.instrument_columns import instrument_columns
from siggen.columns.manufacture_columns import manufacture_columns
from siggen.columns.planetary_columns import of_planets
from siggen.columns.stage_columns import stage_columns
from siggen.columns.state_columns import state_columns
from siggen.columns.versions import SCHEMA_VERSION
from siggen.dynamics.mesh.contact_names import is_of_contact_alone
from siggen.errors import DatasetError, counted
from siggen.keys.column import DECIBEL, HERTZ, MILLIMETRE, Column, list_of
from siggen.sensors.quantity import STILL_M_S2

if TYPE_CHECKING:
    from siggen.config import Config
    from siggen.planning.plan import PlannedRecord
    from siggen.sensors.quantity import Quantity

BEFORE_QUANTITIES = "acceleration"
"""What channels hold in a set whose files do not say so."""


@dataclass(frozen=True, slots=True)
class Channel:
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
class Record:
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


ID_COLUMNS = (
    Column("record_id", pa.int64(), "", "index of the record in the plan; a pure function of the configuration"),
    Column("specimen_id", pa.int64(), "", "gearbox the record belongs to; splits never share one"),
    Column("state_id", pa.int32(), "", "position of the damage state in the configuration"),
    Column("state", pa.string(), "", "name of the damage state"),
    Column("operating_point_id", pa.int32(), "", "position of the operating point in the configuration"),
    Column("repeat", pa.int32(), "", "repeat of the same specimen, state and operating point"),
    Column("split", pa.string(), "", "train, validation or test"),
)
LABEL_COLUMNS = (
    Column("fault", pa.string(), "", "what the state is called: healthy, or by its kind of damage"),
    Column("severity", pa.string(), "", "healthy, slight, moderate or severe"),
    Column("faulty_gear", pa.string(), "", "gear with damage: none, pinion, gear, both, STAGE.pinion, ... or several"),
    Column("faulty_teeth_pinion", list_of(pa.int32()), "", "indices of the pinion's damaged teeth"),
    Column("faulty_teeth_gear", list_of(pa.int32()), "", "indices of the gear's damaged teeth"),
    Column("damage_count", pa.int32(), "", "number of single damages on all teeth"),
    Column("damaged_area_mm2", pa.float64(), "mm^2", "area of the union of all damage, all teeth"),
    Column("damaged_area_share", pa.float64(), "", "damaged share of the most damaged flank"),
    Column("damage_face_length_mm", pa.float64(), MILLIMETRE, "longest single damage across the face"),
    Column("damage_profile_length_mm", pa.float64(), MILLIMETRE, "longest single damage along the profile (arc)"),
    Column("contact_length_loss_mm", pa.float64(), MILLIMETRE, "largest length that a contact line loses"),
    Column(
        "mesh_stiffness_loss",
        pa.float64(),
        "",
        "largest relative loss of mesh stiffness against healthy by potential energy: a pair without contact length "
        "carries nothing; a measure of the damage alone, also where the simulation lets flanks sink instead; 0 for "
        "wear, which takes neither section nor contact length: see mesh_stiffness_loss_as_simulated",
    ),
    Column("contact_loss_share", pa.float64(), "", "share of the time without tooth contact"),
    Column("status", pa.string(), "", "ok; records that failed are in the manifest, not among the rows"),
    Column("through_face", pa.bool_(), "", "whether damage takes the whole contact length somewhere"),
    Column("sink_depth_um", pa.float64(), "um", "how far the mating flank sinks at most; 0 where lands carry"),
    Column(
        "mesh_stiffness_loss_as_simulated",
        pa.float64(),
        "",
        "largest relative loss of force over approach at rest and at the record's torque, by the simulated law; "
        "errors of single teeth are left out",
    ),
)
OPERATING_COLUMNS = (
    Column("teeth_pinion", pa.int32(), "", "number of teeth of the pinion"),
    Column("teeth_gear", pa.int32(), "", "number of teeth of the gear"),
    Column("speed_hz", pa.float64(), HERTZ, "nominal speed of the input (pinion) shaft"),
    Column("torque_nm", pa.float64(), "N m", "torque at the input shaft"),
    Column("pinion_shaft_hz", pa.float64(), HERTZ, "rotation frequency of the pinion's shaft"),
    Column("gear_shaft_hz", pa.float64(), HERTZ, "rotation frequency of the gear's shaft"),
    Column("mesh_hz", pa.float64(), HERTZ, "tooth mesh frequency"),
    Column("start_angle_rad", pa.float64(), "rad", "pinion angle at the first sample"),
)
INTEGRATION_COLUMNS = (
    Column(
        "integration_error",
        pa.float64(),
        "",
        f"estimated relative rms error of the simulated motion (of at least {STILL_M_S2:g} in SI units) by the steps "
        "of integration, from a stretch of the record with twice as many; above the set's tolerance where the motion "
        "depends on every rounding or the finest steps do not suffice, inf where it diverges",
    ),
)
"""Columns of sets of the law pairs."""
VARIATION_COLUMNS = (
    Column("speed_std_hz", pa.float64(), HERTZ, "standard deviation of the pinion's speed about pinion_shaft_hz"),
    Column("mean_torque_nm", pa.float64(), "N m", "mean of the motor's torque, what speeds the train up included"),
    Column("torque_std_nm", pa.float64(), "N m", "standard deviation of the motor's torque"),
)
"""Columns of sets in which speed or torque varies within a record."""
TACHO_COLUMN = Column("tacho_s", list_of(pa.float64()), "s", "times of the pinion shaft's pulses from the first sample")


def channels(config: Config) -> tuple[Channel, ...]:
    """Return the channels of a configuration in the order of its sensors and their axes."""
    return tuple(
        Channel(
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
    return (
        Column(floor, pa.float64(), quantity.unit, f"RMS of the white noise in {channel}"),
        Column(f"snr_{channel}_db", pa.float64(), DECIBEL, f"power of the signal over the white noise in {channel}"),
        Column(f"clipped_share_{channel}", pa.float64(), "", f"share of clipped samples in {channel}"),
    )


def label_columns(config: Config) -> tuple[Column, ...]:
    """Return what `Record.labels` holds: labels, operating conditions, errors of the gears, labels of every channel."""
    named = ((name, sensor.quantity) for sensor in config.sensors for name, _ in sensor.channels)
    per_channel = (column for one in named for column in channel_label_columns(*one))
    varying = VARIATION_COLUMNS if config.variation.active else ()
    stepped = INTEGRATION_COLUMNS if config.dynamics.method == "exponential" else ()
    operating = (*OPERATING_COLUMNS, *stepped)
    common = of_planets(config, (
        *LABEL_COLUMNS,
        *state_columns(config),
        *operating,
        *gearbox_columns(config),
        *stage_columns(config),
        *varying,
        *manufacture_columns(config),
    ))  # fmt: skip
    return (*common, *per_channel, *instrument_columns(config), *background_columns(config))


def label_names(config: Config) -> tuple[str, ...]:
    """Return the keys of `Record.labels`."""
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


def channel_metadata(channel: Channel, fs_hz: float) -> dict[str, str]:
    """Return what a file says about the column of a channel."""
    return {
        "sensor": channel.sensor,
        "place": channel.place,
        "axis": channel.axis,
        "quantity": channel.quantity,
        "unit": channel.unit,
        "fs_hz": repr(float(fs_hz)),
    }


def _signal_field(config: Config, channel: Channel) -> pa.Field:
    metadata = channel_metadata(channel, config.fs_hz)
    signal = list_of(pa.float32(), config.samples)
    return pa.field(channel.column, signal, nullable=False, metadata=metadata)


def signal_channels(schema: pa.Schema) -> tuple[Channel, ...]:
    """Return the channels that a file's schema describes, in column order."""
    found = []
    for field in schema:
        facts = {key.decode(): value.decode() for key, value in (field.metadata or {}).items()}
        if pa.types.is_fixed_size_list(field.type) and "sensor" in facts:
            place = facts["sensor"], facts["place"], facts["axis"]
            quantity = facts.get("quantity", BEFORE_QUANTITIES)
            found.append(Channel(f"{place[0]}_{place[2]}", *place, facts["unit"], field.name, quantity))
    return tuple(found)


def record_batch(config: Config, records: Sequence[Record]) -> pa.RecordBatch:
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


def record_value(record: Record, name: str) -> object:
    """Return a label of a record, or an id from its place in the plan."""
    return record.labels[name] if name in record.labels else getattr(record.planned, name)


def _check_record(config: Config, record: Record) -> None:
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


def non_finite(record: Record) -> str:
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
