"""Reading a finished set without physics: labels, damage, and signals shard by shard."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import PurePath
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import yaml

from siggen.columns.drivetrain import GearTrain
from siggen.columns.record import TACHO_COLUMN, ChannelColumn, signal_matrix
from siggen.dataset.inventory import Inventory, ListedColumn, ListedShard, PromisedFile
from siggen.dataset.manifest import BLIND, CARD, CONFIG, INJECTED, read_manifest
from siggen.dataset.object_name import DAMAGE, LABELS, LIFE_FOLDER, SPLITS, life_name
from siggen.dataset.shard import ABOUT, columns_of, group_rows, unpacked
from siggen.dataset.storage import HOW_TO_GO_ON, Storage
from siggen.dataset.storage_at import storage_at
from siggen.dataset.table_form import check_form, form_of
from siggen.errors import DatasetError, UsageError, VerificationError, counted
from siggen.keys.column import Column, Role

_Loader = yaml.CSafeLoader if yaml.__with_libyaml__ else yaml.SafeLoader
"""The safe one, by libyaml where PyYAML was built with it."""


KEPT_BYTES = 256 << 20
"""Decoded tables that a set keeps in memory, so that records of one shard are decoded once."""


class Dataset:
    """A finished set.

    Attributes
    ----------
    path : Path
        For a set in an object store a path that is none of this machine: s3://bucket/set.
    manifest : dict
        Content of manifest.json: identity, counts, failures, environment, shards, hashes.
    inventory : Inventory
        The same as typed facts.
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
        If there is no finished set, or manifest or configuration are not what is promised. Other files are compared,
        whole, when they are read.
    """

    def __init__(self, storage: Storage) -> None:
        self._storage = storage
        self.path: PurePath = storage.path
        self.inventory: Inventory = read_manifest(storage)
        self.manifest: dict[str, Any] = self.inventory.content
        self._ids: dict[str, np.ndarray] = {}
        self._tables: OrderedDict[str, pa.Table] = OrderedDict()
        self._groups: dict[str, tuple[int, ...]] = {}
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
        """Return what goes to another process: everything but decoded tables."""
        return {**self.__dict__, "_tables": OrderedDict()}

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

    @property
    def is_simulated(self) -> bool:
        """Whether siggen can make its records again; not of recordings, and of those whose seed is secret."""
        return not {INJECTED, BLIND} & self.files.keys()

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
    def _listed(self) -> dict[str, ListedColumn]:
        return {column.name: column for column in self.inventory.columns}

    def labels(self, split: str | None = None, columns: Sequence[str] | None = None) -> pa.Table:
        """Return ids, labels and operating conditions (no signals) of one split, or of all splits in order.

        Raises
        ------
        UsageError
            If the split or a column does not exist.
        """
        first, rows = self._stretch(split)
        return self._table(LABELS, columns).slice(first, rows)

    def record_ids(self, split: str) -> np.ndarray:
        """Return the ids of a split's records in their order, (n,) int64; read once."""
        if split not in self._ids:
            self._ids[split] = self.labels(split, ["record_id"])["record_id"].to_numpy().astype(np.int64)
        return self._ids[split]

    def damage(self, split: str | None = None) -> pa.Table:
        """Return one row per single damage of every record of a split, or of all splits."""
        table = self._table(DAMAGE)
        if split is None:
            return table
        return table.filter(pc.is_in(table["record_id"], pa.array(self.record_ids(*self._splits(split)))))

    def life(self, table: str, split: str | None = None) -> pa.Table:
        """Return a table of a set that runs to failure: units, inspections, teeth, pits or outlook; as `labels`.

        Raises
        ------
        UsageError
            If the set holds no such table, or the split does not exist.
        """
        begin, end = f"{LIFE_FOLDER}/", ".parquet"
        known = sorted(name[len(begin) : -len(end)] for name in self.files if name.startswith(begin))
        if table not in known:
            allowed = ", ".join(known) or "none: the set's configuration has no section life"
            raise UsageError(f"{self.path}: received the table {table!r} of life/; allowed: {allowed}")
        found = self._table(life_name(table))
        return found if split is None else found.filter(pc.equal(found["split"], *self._splits(split)))

    def records(
        self, split: str | None = None, columns: Sequence[str] | None = None, batch_rows: int | None = None
    ) -> Iterator[pa.RecordBatch]:
        """Yield rows with signals, in the order of the labels, holding one shard at a time.

        Parameters
        ----------
        split : str, optional
            All splits in order when omitted.
        columns : sequence of str, optional
            All columns when omitted. `signal_matrix` turns a signal column into (rows, samples).
        batch_rows : int, optional
            Largest number of rows of a batch; a whole shard when omitted.

        Raises
        ------
        UsageError
            If the split or a column does not exist.
        """
        _check_batch_rows(batch_rows)
        for shard in self.shards(split):
            yield from self._shard_table(shard.file, shard.rows, columns).to_batches(max_chunksize=batch_rows)

    def shards(self, split: str | None = None) -> tuple[ListedShard, ...]:
        """Return the shards of a split, or of all splits, in the order of the labels; `shard_rows` reads one.

        Raises
        ------
        UsageError
            If the split does not exist.
        """
        wanted = self._splits(split)
        return tuple(shard for shard in self.inventory.shards if shard.split in wanted)

    def row_groups(self) -> tuple[tuple[int, ...], ...]:
        """Return how many rows each row group of every shard has, in the order of the labels; siggen writes one."""
        names = [shard.file for shard in self.shards()]
        return tuple(self._groups.get(name) or group_rows(self.content(name)) for name in names)

    def shard_rows(self, shard: ListedShard, columns: Sequence[str] | None = None) -> pa.RecordBatch:
        """Return the rows of one shard with signals, by any process and in any order.

        Raises
        ------
        UsageError
            If a column does not exist, or the shard is none.
        """
        if not isinstance(shard, ListedShard):
            raise UsageError(f"shard: received {shard!r}; allowed: one of `shards()`")
        rows = self._shard_table(shard.file, shard.rows, columns)
        return (rows.to_batches() or [pa.RecordBatch.from_pylist([], schema=rows.schema)])[0]

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
        _check_batch_rows(batch_rows)
        for shard in self.shards(split):
            yield from self._shard_table(shard.internals, None, columns).to_batches(max_chunksize=batch_rows)

    def record_internals(self, record_id: int) -> dict[str, np.ndarray] | None:
        """Return name -> float32 (n,) of one record, or None if the set does not store those of this record.

        Raises
        ------
        UsageError
            If the set stores none at all.
        """
        self._check_internals()
        place = self._places.get(record_id)
        if place is None:
            return None
        shard, _ = self._owner(place)
        table = self._table(shard.internals)
        row = pc.index(table["record_id"], record_id).as_py()
        return None if row < 0 else as_internals(table.slice(row, 1))

    def _check_internals(self) -> None:
        if not self.internal_columns:
            raise UsageError(
                f"{self.path} stores no internal quantities; `internals` in its configuration would ask for them, "
                "and `siggen show --internals --out` computes those of one record"
            )

    def record(self, record_id: int) -> dict[str, Any]:
        """Return one record: labels as Python values, channels as float32 (n,), `tacho_s` as float64 (k,).

        The signal of channel `c` is found under the channel's column, e.g. `accel_bearing_vertical_m_s2`.

        Raises
        ------
        UsageError
            If no row has this id; the message says whether the record failed or was never planned.
        """
        place = self._places.get(record_id)
        if place is None:
            raise UsageError(self._why_no_record(record_id))
        shard, row = self._owner(place)
        table = self._table(shard.file)
        if table.num_rows != shard.rows or table["record_id"][row].as_py() != record_id:
            raise self._broken(shard.file, "it holds other records than the labels say")
        return as_record(table.slice(row, 1))

    @cached_property
    def _places(self) -> dict[int, int]:
        """Which row of the labels a record is."""
        ids = self._table(LABELS, ["record_id"])["record_id"].to_pylist()
        return {record_id: place for place, record_id in enumerate(ids)}

    def _owner(self, place: int) -> tuple[ListedShard, int]:
        """Return the shard of a row of the labels, and which of its rows that is."""
        number = int(np.searchsorted(self._ends, place, side="right"))
        shard = self.inventory.shards[number]
        return shard, place - int(self._ends[number] - shard.rows)

    @cached_property
    def _ends(self) -> np.ndarray:
        return np.cumsum([shard.rows for shard in self.inventory.shards], dtype=np.int64)

    def _why_no_record(self, record_id: int) -> str:
        for failure in self.inventory.failures:
            if failure.record_id == record_id:
                return f"record {record_id} could not be simulated: {failure.status} ({failure.reason})"
        return f"{self.path} has no record {record_id}; it has records 0 to {max(self._places, default=-1)}"

    def _table(self, name: str, columns: Sequence[str] | None = None) -> pa.Table:
        """Return a table; the last ones that were asked for stay decoded."""
        if name not in self._tables:
            self._tables[name] = self._decoded(name, None)
            while len(self._tables) > 1 and sum(table.nbytes for table in self._tables.values()) > KEPT_BYTES:
                self._tables.popitem(last=False)
        self._tables.move_to_end(name)
        return self._chosen(self._tables[name], columns)

    def _shard_table(self, name: str, rows: int | None, columns: Sequence[str] | None) -> pa.Table:
        """Return the rows of a shard in one piece; it does not stay."""
        table = self._tables.get(name)
        table = self._decoded(name, columns) if table is None else self._chosen(table, columns)
        if rows is not None and table.num_rows != rows:
            raise self._broken(name, f"{counted(table.num_rows, 'row')} instead of {rows}")
        return table.combine_chunks()

    def _decoded(self, name: str, columns: Sequence[str] | None) -> pa.Table:
        """Return a table whose every byte is what is promised, before anything is decoded."""
        content = self.content(name)
        try:
            table = unpacked(content, columns, hashed=True)
            if columns is not None and not set(columns) <= set(table.column_names):
                self._check_columns(columns_of(content), columns)
            self._groups[name] = group_rows(content)
            check_form(table, form_of(name, self.inventory, table.column_names), asked=columns)
        except VerificationError as error:
            raise self._broken(name, str(error)) from error
        if name == LABELS and table.num_rows != self.inventory.rows:
            raise self._broken(name, f"{counted(table.num_rows, 'row')} instead of {self.inventory.rows}")
        facts = {key: value for key, value in (table.schema.metadata or {}).items() if key != ABOUT}
        return table.replace_schema_metadata(facts)

    def _chosen(self, table: pa.Table, columns: Sequence[str] | None) -> pa.Table:
        self._check_columns(table.column_names, columns)
        return table if columns is None else table.select(list(columns))

    def content(self, name: str) -> bytes:
        """Return a file of the set whole.

        Raises
        ------
        DatasetError
            If it is missing, none of the set, or its hash is another one.
        """
        promised = self.files.get(name)
        if promised is None:
            raise self._broken(name, "the manifest does not name it")
        content = self._storage.get(name, promised.bytes)
        if hashlib.sha256(content).hexdigest() != promised.sha256:
            raise self._broken(name, "SHA-256 differs")
        return content

    def _broken(self, name: str, why: str) -> DatasetError:
        return DatasetError(f"{self.path}/{name} is not the promised file ({why}); {HOW_TO_GO_ON}")

    def _stretch(self, split: str | None) -> tuple[int, int]:
        """Return the first row of a split among all labels, and how many it has."""
        if split is None:
            return 0, self.inventory.rows
        (own,) = self._splits(split)
        before = self.splits[: self.splits.index(own)]
        return sum(self.inventory.splits[one].rows for one in before), self.inventory.splits[own].rows

    def _splits(self, split: str | None) -> tuple[str, ...]:
        if split is None:
            return self.splits
        if split not in self.splits:
            raise UsageError(f"{self.path} has no split {split!r}; it has {', '.join(self.splits)}")
        return (split,)

    @property
    def files(self) -> dict[str, PromisedFile]:
        """Every file of the set but the manifest, by name, and what is promised of it."""
        return self.inventory.files

    def _check_columns(self, known: Sequence[str], columns: Sequence[str] | None) -> None:
        unknown = [column for column in columns or () if column not in known]
        if unknown:
            raise UsageError(f"{self.path} has no columns {unknown}; it has {', '.join(known)}")

    def card(self) -> str:
        """Return README.md, which says in words what the set is."""
        return self.content(CARD).decode("utf-8", "replace")

    def _read_config(self) -> dict[str, Any]:
        try:
            return dict(yaml.load(self.content(CONFIG), _Loader))
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


def _check_batch_rows(batch_rows: object) -> None:
    if batch_rows is not None and (type(batch_rows) is not int or batch_rows < 1):
        raise UsageError(f"batch_rows: received {batch_rows!r}; allowed: 1, 2 and so on, or None for whole shards")


def as_record(row: pa.Table | pa.RecordBatch) -> dict[str, Any]:
    """Return the first row: labels as Python values, signals and pulse times as arrays."""
    signals = {field.name for field in row.schema if pa.types.is_fixed_size_list(field.type)}
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
    UsageError
        If the path is none.
    """
    if not isinstance(path, str | PurePath):
        raise UsageError(f"path: received {path!r}; allowed: the path of a folder, or s3://bucket/set")
    return Dataset(storage_at(path))
