"""Reading a finished set without physics: labels, damage, and signals group by group."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import yaml

from siggen.columns.drivetrain import GearTrain
from siggen.columns.record import TACHO_COLUMN, ChannelColumn, signal_channels, signal_matrix
from siggen.dataset.inventory import Inventory, ListedColumn, ListedShard, PromisedFile
from siggen.dataset.manifest import CARD, CONFIG, DAMAGE_FOLDER, LIFE_FOLDER, METADATA_FOLDER, SPLITS, read_manifest
from siggen.dataset.object_name import CHECKSUMS
from siggen.dataset.promises import Promises
from siggen.dataset.shard_index import ShardIndex, promised_files
from siggen.dataset.storage import Storage
from siggen.dataset.storage_at import storage_at
from siggen.errors import ConfigError, DatasetError, UsageError, counted
from siggen.keys.column import Column, Role

if TYPE_CHECKING:
    from siggen.gearbox.design import FlankLaw

_Loader = yaml.CSafeLoader if yaml.__with_libyaml__ else yaml.SafeLoader
"""The safe one, by libyaml where PyYAML was built with it."""


KEPT_BYTES = 256 << 20
"""Decoded row groups that a set keeps in memory, so that records of one row group are decoded once."""


@dataclass(frozen=True, slots=True)
class RowGroup:
    """The smallest piece of a set that is decoded at once: number `number` of `file`, with `rows` records."""

    file: str
    number: int
    rows: int


class Dataset:
    """A finished set.

    Attributes
    ----------
    path : Path
        For a set in an object store a path that is none of this machine: s3://bucket/set.
    manifest : dict
        Content of manifest.json: identity, counts, failures, environments, hashes.
    inventory : Inventory
        The same as typed facts.
    index : ShardIndex
        The shards, one by one.
    config : dict
        Content of config.yaml.
    splits : tuple of str
        Splits that have records, in the order train, validation, test.
    channels : tuple of Channel
    drivetrain : GearTrain
        Shafts, gears and meshes of its gearboxes.
    fs_hz, duration_s : float
    internal_columns : tuple of Column
        Quantities that no sensor sees, in sets that store some (`internals` in the configuration).

    Raises
    ------
    DatasetError
        If there is no finished set, or manifest, index or configuration are not what is promised. Other files are
        compared when they are read.
    """

    def __init__(self, storage: Storage) -> None:
        self._storage = storage
        self.path: PurePath = storage.path
        self.inventory: Inventory = read_manifest(storage)
        self.manifest: dict[str, Any] = self.inventory.content
        self.index = ShardIndex(storage, self.inventory)
        self._promises = Promises(storage, self.inventory, self.index)
        self._ids: dict[str, np.ndarray] = {}
        self._groups: OrderedDict[tuple[str, int], pa.Table] = OrderedDict()
        self.config: dict[str, Any] = self._read_config()
        self.splits: tuple[str, ...] = tuple(s for s in SPLITS if s in self.inventory.splits)
        self.channels: tuple[ChannelColumn, ...] = self.inventory.channels
        self.drivetrain: GearTrain = self.inventory.drivetrain
        self.fs_hz: float = self.inventory.fs_hz
        self.duration_s: float = self.inventory.duration_s
        self.internal_columns: tuple[Column, ...] = tuple(
            Column(one.name, pa.float32(), one.unit, one.meaning) for one in self.inventory.internals
        )

    def __repr__(self) -> str:
        rows = ", ".join(f"{split}: {self.inventory.splits[split].rows}" for split in self.splits)
        channels = counted(len(self.channels), "channel")
        return f"Dataset({str(self.path)!r}, {rows} records, {channels} at {self.fs_hz:g} Hz)"

    def __getstate__(self) -> dict[str, Any]:
        """Return what goes to another process: everything but the decoded row groups."""
        return {**self.__dict__, "_groups": OrderedDict()}

    def __len__(self) -> int:
        """Return the number of records of all splits."""
        return sum(self.inventory.splits[split].rows for split in self.splits)

    def __getitem__(self, split: str) -> Split:
        """Return a split.

        Raises
        ------
        UsageError
            If it does not exist.
        """
        return Split(self, *self._splits(split))

    def role(self, name: str) -> Role:
        """Return the role of a column of records; one that the set does not list is a condition."""
        return self._listed[name].role if name in self._listed else Role.CONDITION

    def section(self, name: str) -> str:
        """Return the section of the configuration that says how a column is drawn; empty where none does."""
        return self._listed[name].section if name in self._listed else ""

    def columns_of(self, quantity: str) -> dict[str, str]:
        """Return the columns of records that hold a quantity, by the gear, shaft or mesh that they are about."""
        return {column.of: name for name, column in self._listed.items() if column.quantity == quantity}

    @cached_property
    def gears(self) -> dict[str, FlankLaw]:
        """What the configuration says of the flanks of every gear, by its name; no ring.

        Empty for a configuration of another version.
        """
        from siggen.gearbox.design import design_of

        try:
            return design_of(self.config, CONFIG).flanks
        except ConfigError:
            return {}

    @cached_property
    def _listed(self) -> dict[str, ListedColumn]:
        return {column.name: column for column in self.inventory.columns}

    def labels(self, split: str | None = None, columns: Sequence[str] | None = None) -> pa.Table:
        """Return ids, labels and operating conditions (no signals) of one split, or of all splits in order.

        Raises
        ------
        UsageError
            If the split or a column does not exist.
        """
        return self._table(METADATA_FOLDER, split, columns)

    def record_ids(self, split: str) -> np.ndarray:
        """Return the ids of a split's records in their order, (n,) int64; read once."""
        if split not in self._ids:
            self._ids[split] = self.labels(split, ["record_id"])["record_id"].to_numpy().astype(np.int64)
        return self._ids[split]

    def damage(self, split: str | None = None) -> pa.Table:
        """Return one row per single damage of every record of a split, or of all splits."""
        return self._table(DAMAGE_FOLDER, split, None)

    def life(self, table: str, split: str | None = None) -> pa.Table:
        """Return a table of a set that runs to failure: units, inspections, teeth, pits or outlook; as `labels`.

        Raises
        ------
        UsageError
            If the set holds no such table, or the split does not exist.
        """
        known = sorted({name.split("/")[1] for name in self.inventory.files if name.startswith(f"{LIFE_FOLDER}/")})
        if table not in known:
            allowed = ", ".join(known) or "none: the set's configuration has no section life"
            raise UsageError(f"{self.path}: received the table {table!r} of life/; allowed: {allowed}")
        return self._table(f"{LIFE_FOLDER}/{table}", split, None)

    def records(
        self, split: str | None = None, columns: Sequence[str] | None = None, batch_rows: int | None = None
    ) -> Iterator[pa.RecordBatch]:
        """Yield rows with signals, in the order of the labels, holding one row group at a time.

        Parameters
        ----------
        split : str, optional
            All splits in order when omitted.
        columns : sequence of str, optional
            All columns when omitted. `signal_matrix` turns a signal column into (rows, samples).
        batch_rows : int, optional
            Largest number of rows of a batch; a whole row group when omitted.

        Raises
        ------
        UsageError
            If the split or a column does not exist.
        """
        yield from self._batches((shard.file for shard in self._shards(split)), columns, batch_rows)

    def row_groups(self, split: str | None = None) -> tuple[RowGroup, ...]:
        """Return the row groups of a split, or of all splits, in the order of the labels; `row_group` reads one.

        Raises
        ------
        UsageError
            If the split does not exist.
        """
        size = self.inventory.rows_per_group
        files = (one for name in self._splits(split) for one in self.index.rows_of_files(name))
        return tuple(
            RowGroup(file, number, min(size, rows - number * size))
            for file, rows in files
            for number in range(-(-rows // size))
        )

    def row_group(self, group: RowGroup, columns: Sequence[str] | None = None) -> pa.RecordBatch:
        """Return the rows of one row group with signals, by any process and in any order.

        Raises
        ------
        UsageError
            If a column does not exist.
        """
        with self._promises.table(group.file) as file:
            self._check_columns(file.schema, columns)
            footer = file.footer
            if group.number >= footer.num_row_groups or footer.row_group(group.number).num_rows != group.rows:
                raise DatasetError(f"{self.path}/{group.file}: row group {group.number} is not the one that is listed")
            table = file.group(group.number, columns)
        return table.combine_chunks().to_batches()[0]

    def internals(
        self, split: str | None = None, columns: Sequence[str] | None = None, batch_rows: int | None = None
    ) -> Iterator[pa.RecordBatch]:
        """Yield rows of internal quantities with the ids of their records; as `records`, but only where stored.

        Raises
        ------
        UsageError
            If the set stores none, or the split or a column does not exist.
        """
        self._check_internals()
        yield from self._batches((shard.internals or "" for shard in self._shards(split)), columns, batch_rows)

    def record_internals(self, record_id: int) -> dict[str, np.ndarray] | None:
        """Return name -> float32 (n,) of one record, or None if the set does not store those of this record.

        Raises
        ------
        UsageError
            If the set stores none at all.
        """
        self._check_internals()
        shard = self.index.owner(record_id)
        row = None if shard is None or shard.internals is None else self._row(shard.internals, record_id)
        return None if row is None else as_internals(row)

    def _check_internals(self) -> None:
        if not self.internal_columns:
            raise UsageError(
                f"{self.path} stores no internal quantities; `internals` in its configuration would ask for them, "
                "and `siggen simulate` computes those of one record"
            )

    def _batches(
        self, names: Iterable[str], columns: Sequence[str] | None, batch_rows: int | None
    ) -> Iterator[pa.RecordBatch]:
        """Yield the rows of all files, a row group at a time."""
        for name in names:
            with self._promises.table(name) as file:
                self._check_columns(file.schema, columns)
                for group in file.groups(columns):
                    yield from group.combine_chunks().to_batches(max_chunksize=batch_rows)

    def record(self, record_id: int) -> dict[str, Any]:
        """Return one record: labels as Python values, channels as float32 (n,), `tacho_s` as float64 (k,).

        The signal of channel `c` is found under the channel's column, e.g. `accel_bearing_vertical_m_s2`.

        Raises
        ------
        UsageError
            If no row has this id; the message says whether the record failed or was never planned.
        """
        shard = self.index.owner(record_id)
        row = None if shard is None else self._row(shard.file, record_id)
        if row is None:
            raise UsageError(self._why_no_record(record_id))
        return as_record(row)

    def _row(self, name: str, record_id: int) -> pa.Table | None:
        """Return the row of a record in a file whose first column is `record_id`; None if there is none."""
        footer = self._promises.footer(name)
        for number in range(footer.num_row_groups):
            statistics = footer.row_group(number).column(0).statistics
            if statistics is None or not statistics.has_min_max or statistics.min <= record_id <= statistics.max:
                table = self._decoded(name, number)
                place = pc.index(table["record_id"], record_id).as_py()
                if place >= 0:
                    return table.slice(place, 1)
        return None

    def _decoded(self, name: str, number: int) -> pa.Table:
        """Return a row group of a file; the last ones that were asked for stay in memory."""
        key = (name, number)
        if key not in self._groups:
            with self._promises.table(name) as file:
                self._groups[key] = file.group(number)
            while len(self._groups) > 1 and sum(table.nbytes for table in self._groups.values()) > KEPT_BYTES:
                self._groups.popitem(last=False)
        self._groups.move_to_end(key)
        return self._groups[key]

    def _why_no_record(self, record_id: int) -> str:
        for failure in self.inventory.failures:
            if failure.record_id == record_id:
                return f"record {record_id} could not be simulated: {failure.status} ({failure.reason})"
        return f"{self.path} has no record {record_id}; it has records 0 to {int(self.index.records.last.max())}"

    def _table(self, folder: str, split: str | None, columns: Sequence[str] | None) -> pa.Table:
        tables = []
        for name in self._splits(split):
            with self._promises.table(f"{folder}/{name}.parquet") as file:
                self._check_columns(file.schema, columns)
                tables.append(file.read(columns))
        return pa.concat_tables(tables)

    def _splits(self, split: str | None) -> tuple[str, ...]:
        if split is None:
            return self.splits
        if split not in self.splits:
            raise UsageError(f"{self.path} has no split {split!r}; it has {', '.join(self.splits)}")
        return (split,)

    def _shards(self, split: str | None) -> Iterator[ListedShard]:
        for name in self._splits(split):
            yield from self.index.shards(name)

    @cached_property
    def files(self) -> dict[str, PromisedFile]:
        """Every file of the set but the manifest, by name, and what is promised of it."""
        return {**self.inventory.files, **dict(promised_files(self._storage, self.inventory.files[CHECKSUMS]))}

    def _check_columns(self, schema: pa.Schema, columns: Sequence[str] | None) -> None:
        unknown = [column for column in columns or () if column not in schema.names]
        if unknown:
            raise UsageError(f"{self.path} has no columns {unknown}; it has {', '.join(schema.names)}")

    def card(self) -> str:
        """Return README.md, which says in words what the set is."""
        return self._promises.content(CARD).decode("utf-8", "replace")

    def _read_config(self) -> dict[str, Any]:
        try:
            return dict(yaml.load(self._promises.content(CONFIG), _Loader))
        except (OSError, ValueError, TypeError, yaml.YAMLError) as error:
            raise DatasetError(f"{self.path}/{CONFIG} cannot be read ({error})") from error


@dataclass(frozen=True, slots=True)
class Split:
    """The records of one split: `dataset["train"]`. It has a length, and `split[k]` is its k-th record.

    Attributes
    ----------
    dataset : Dataset
    name : str
        train, validation or test.
    """

    dataset: Dataset
    name: str

    def __len__(self) -> int:
        return self.dataset.inventory.splits[self.name].rows

    def __getitem__(self, number: int) -> dict[str, Any]:
        """Return a record as `Dataset.record` gives it; negative numbers count from the end."""
        if not -len(self) <= number < len(self):
            raise IndexError(f"record {number} of {len(self)} of the split {self.name}")
        return self.dataset.record(int(self.dataset.record_ids(self.name)[number % len(self)]))

    def __iter__(self) -> Iterator[dict[str, Any]]:
        for batch in self.dataset.records(self.name):
            yield from (as_record(batch.slice(row, 1)) for row in range(batch.num_rows))

    def labels(self, columns: Sequence[str] | None = None) -> pa.Table:
        """Return ids, labels and operating conditions (no signals), see `Dataset.labels`."""
        return self.dataset.labels(self.name, columns)

    def arrays(self, channel: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return all signals of a channel, the state of every record, and its gearbox.

        Parameters
        ----------
        channel : str
            Name of a channel; a set that does not fit into memory has `Dataset.records`.

        Returns
        -------
        (n, samples) float32
            In the unit of the channel.
        (n,) str
            Names of states.
        (n,) int64
            Number of the gearbox, for splits by group.

        Raises
        ------
        UsageError
            If there is no such channel.
        """
        columns = {known.name: known.column for known in self.dataset.channels}
        if channel not in columns:
            raise UsageError(f"channel: received {channel!r}; allowed are {', '.join(columns)}")
        batches = self.dataset.records(self.name, [columns[channel]])
        labels = self.labels(["state", "specimen_id"])
        return (
            np.concatenate([signal_matrix(batch.column(0)) for batch in batches]),
            np.array(labels["state"].to_pylist()),
            labels["specimen_id"].to_numpy().astype(np.int64),
        )


def as_record(row: pa.Table | pa.RecordBatch) -> dict[str, Any]:
    """Return the first row: labels as Python values, signals and pulse times as arrays."""
    signals = {channel.column for channel in signal_channels(row.schema)}
    record: dict[str, Any] = {}
    for name in row.schema.names:
        column = row.column(name)
        if name in signals:
            record[name] = signal_matrix(column)[0].copy()  # what Arrow holds cannot be written to
        elif name == TACHO_COLUMN.name:
            record[name] = np.asarray(column[0].as_py(), dtype=np.float64)
        else:
            record[name] = column[0].as_py()
    return record


def as_internals(row: pa.Table | pa.RecordBatch) -> dict[str, np.ndarray]:
    """Return the first row of internal quantities: name -> float32 (n,)."""
    series = [field.name for field in row.schema if pa.types.is_fixed_size_list(field.type)]
    return {name: signal_matrix(row.column(name))[0].copy() for name in series}


def open(path: PurePath | str) -> Dataset:
    """Open a finished set for reading, in a folder or at s3://bucket/set.

    Raises
    ------
    DatasetError
        If the folder is not a finished set; for an interrupted one the message says how to finish it.
    """
    return Dataset(storage_at(path))
