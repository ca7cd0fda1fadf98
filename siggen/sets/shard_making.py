"""What workers do: make a shard, or find it whole, and give back what the manifest and the small tables need of it.

All that is written follows from configuration and index, and every file is there as a whole or not at all: a task that
runs twice, also at once, leaves the same files. The file of rows comes last, and commits the shard.
"""

from __future__ import annotations

import hashlib
import os
import platform
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from itertools import groupby
from operator import itemgetter

import pyarrow as pa

from siggen.columns.internals import internals_schema
from siggen.columns.life import LIFE_TABLES, NULLABLE
from siggen.columns.record import (
    RecordFailure,
    SetColumns,
    damage_schema,
    label_schema,
    record_schema,
    schema_metadata,
)
from siggen.dataset.environment import fingerprint, version_text
from siggen.dataset.inventory import PromisedFile
from siggen.dataset.manifest import CONFIG
from siggen.dataset.object_name import DAMAGE, LABELS, data_name, internals_name, life_name
from siggen.dataset.shard import ABOUT, about_of, packed, promised, unpacked
from siggen.dataset.simulated_rows import RowSimulation
from siggen.dataset.storage import Storage
from siggen.errors import DatasetError, VerificationError
from siggen.file_writing import UNWRITABLE
from siggen.gearbox.plan import ShardPlan
from siggen.record.stage_times import collected, stage

DamageRows = Callable[[Sequence[int]], Iterable[Mapping[str, object]]]
"""Ids of one specimen's records -> rows of the damage table, as siggen.record gives them."""

LifeRows = Callable[[int], Mapping[str, Sequence[Mapping[str, object]]]]
"""specimen -> rows by the name of their table, as siggen.record gives them."""


@dataclass(frozen=True, slots=True)
class MadeShard:
    """What came of a shard, without its rows: some kB.

    Attributes
    ----------
    made
        Records that were simulated for it: none if it was there.
    tables
        Name of a small table -> its rows of this shard, as a compressed Arrow stream.
    note
        Why it was made again, if something was there.
    error
        What a disk or a store said that takes or gives no more; then nothing else holds.
    """

    shard: str
    rows: int = 0
    rows_per_state: Mapping[str, int] = field(default_factory=dict)
    failures: tuple[RecordFailure, ...] = ()
    files: Mapping[str, PromisedFile] = field(default_factory=dict)
    made: int = 0
    tables: Mapping[str, bytes] = field(default_factory=dict)
    note: str = ""
    cpu_s: Mapping[str, float] = field(default_factory=dict, compare=False)
    error: DatasetError | OSError | None = None


@dataclass(frozen=True, slots=True)
class ShardMaker:
    """The function that is run for every shard; carries to the workers once what makes a set.

    Attributes
    ----------
    damage_rows, life_rows
        What makes the rows that stand in no shard: pure, and importable by name.
    environment
        Of whoever drives the run: the maker of all shards.
    earlier
        Numbers of gearboxes at which the set was finished before.
    states
        Names of all that a gearbox may be in.
    with_tables
        Whether the rows of small tables are asked for: a part of a set needs none.
    """

    simulation: RowSimulation
    storage: Storage
    damage_rows: DamageRows
    life_rows: LifeRows
    environment: Mapping[str, str]
    earlier: tuple[int, ...]
    states: tuple[str, ...]
    with_tables: bool = True

    def __call__(self, shard: ShardPlan) -> MadeShard:
        """Make a shard, if it is not there as this maker would make it."""
        try:
            self._check_place()
            with collected("other") as times:
                made = self._made(shard)
            return replace(made, cpu_s=times.seconds)
        except DatasetError as error:
            return MadeShard(shard.key, error=error)
        except OSError as error:
            if error.errno is None or error.errno not in UNWRITABLE:
                raise
            return MadeShard(shard.key, error=OSError(error.errno, os.strerror(error.errno)))

    def _check_place(self) -> None:
        if not self.storage.exists(CONFIG):
            raise DatasetError(
                f"{self.storage.location}: the worker on {platform.node()} does not see the folder of the set, into "
                "which it has to write; name a folder that all machines of the cluster share, or s3://bucket/set"
            )

    def _made(self, shard: ShardPlan) -> MadeShard:
        note, made = "", 0
        try:
            with stage("files"):
                table, failures, files = self._there(shard)
        except FileNotFoundError:
            table, failures, files = self._simulated(shard)
            made = shard.record_count
        except VerificationError as error:
            note = str(error)
            table, failures, files = self._simulated(shard)
            made = shard.record_count
        per_state = dict.fromkeys(self.states, 0)
        for state in table["state"].to_pylist():
            per_state[state] += 1
        with stage("files"):
            tables = self._tables(shard, table) if self.with_tables else {}
        return MadeShard(shard.key, table.num_rows, per_state, failures, files, made, tables, note)

    def _about(self, shard: ShardPlan, failures: Sequence[RecordFailure], internals: str | None) -> dict[str, object]:
        return {
            "shard": shard.key,
            "identity": self.simulation.columns.identity,
            "fingerprint": fingerprint(self.environment),
            "made_by": version_text(self.environment),
            "earlier": [count for count in self.earlier if count <= shard.specimens[0]],
            "specimens": list(shard.specimens),
            "failures": [list(asdict(failure).values()) for failure in failures],
            "internals": internals,
        }

    def _simulated(self, shard: ShardPlan) -> tuple[pa.Table, tuple[RecordFailure, ...], dict[str, PromisedFile]]:
        columns = self.simulation.columns
        rows, inner, failures = [], [], list[RecordFailure]()
        for ids in shard.of_specimens:
            for block in self.simulation.blocks(ids):
                rows.append(block.rows)
                failures += block.failures
                inner += [] if block.internals is None else [block.internals]
        files: dict[str, PromisedFile] = {}
        table = pa.Table.from_batches(rows, record_schema(columns))
        del rows
        with stage("files"):
            if columns.quantities:
                content = packed(pa.Table.from_batches(inner, internals_schema(columns)))
                self.storage.put(name := internals_name(shard.key), content)
                files[name] = promised(content)
            internals = files[internals_name(shard.key)].sha256 if files else None
            content = packed(table, self._about(shard, failures, internals))
            self.storage.put(name := data_name(shard.key), content)
            files[name] = promised(content)
        return table, tuple(failures), files

    def _there(self, shard: ShardPlan) -> tuple[pa.Table, tuple[RecordFailure, ...], dict[str, PromisedFile]]:
        """Return what is there of a shard.

        Whoever writes a table again that was read gets its bytes, unless one of them was changed: the checksums of
        pages leave out their headers and the footer.

        Raises
        ------
        FileNotFoundError
            If nothing is there.
        VerificationError
            If it is damaged, or another maker made it, with the reason.
        """
        name, columns = data_name(shard.key), self.simulation.columns
        if not self.storage.exists(name):
            raise FileNotFoundError(name)
        content = self.storage.get(name)
        table = unpacked(content)
        about = about_of(table)
        failures = self._failures(about.get("failures"))
        internals = about.get("internals")
        wanted = self._about(shard, failures, internals)
        if about.get("identity") != wanted["identity"]:
            raise VerificationError("it is of another set")
        if about.get("fingerprint") != wanted["fingerprint"]:
            raise VerificationError(f"made by {str(about.get('made_by'))[:100]}")
        if about != wanted or table.num_rows + len(failures) != shard.record_count:
            raise VerificationError("it holds other gearboxes")
        if not _without_about(table.schema).equals(record_schema(columns), check_metadata=True):
            raise VerificationError("it has other columns")
        if packed(table) != content:
            raise VerificationError(f"{name} is damaged")
        files = {}
        if columns.quantities:
            other = internals_name(shard.key)
            inner = self.storage.get(other) if self.storage.exists(other) else b""
            if hashlib.sha256(inner).hexdigest() != internals:
                raise VerificationError(f"{other} is missing or damaged")
            files[other] = promised(inner)
        files[name] = promised(content)
        return table.replace_schema_metadata(schema_metadata(columns)), failures, files

    def _failures(self, listed: object) -> tuple[RecordFailure, ...]:
        try:
            return tuple(RecordFailure(int(i), str(status), str(reason)) for i, status, reason in listed)  # type: ignore[attr-defined]
        except (TypeError, ValueError) as error:
            raise VerificationError("it does not say what failed") from error

    def _tables(self, shard: ShardPlan, table: pa.Table) -> dict[str, bytes]:
        schemas = table_schemas(self.simulation.columns)
        owners = zip(table["specimen_id"].to_pylist(), table["record_id"].to_pylist(), strict=True)
        records = ([record for _, record in own] for _, own in groupby(owners, key=itemgetter(0)))
        rows = {DAMAGE: [row for of_specimen in records for row in self.damage_rows(of_specimen)]}
        if self.simulation.columns.lives:
            rows |= {life_name(name): [] for name in LIFE_TABLES}
            for specimen in shard.specimens:
                for name, found in self.life_rows(specimen).items():
                    rows[life_name(name)] += [{**row, "split": shard.split} for row in found]
        made = {name: pa.RecordBatch.from_pylist(own, schema=schemas[name]) for name, own in rows.items()}
        labels = table.select(schemas[LABELS].names).cast(schemas[LABELS]).combine_chunks()
        return {name: _stream(batch) for name, batch in made.items()} | {LABELS: _stream(labels)}


def table_schemas(columns: SetColumns) -> dict[str, pa.Schema]:
    """Return name -> schema of the small tables of a set; those of lives only if it has some."""
    lives = {life_name(name): _life_schema(columns, name) for name in (LIFE_TABLES if columns.lives else ())}
    return {LABELS: label_schema(columns), DAMAGE: damage_schema(columns), **lives}


def _life_schema(columns: SetColumns, table: str) -> pa.Schema:
    fields = [column.field().with_nullable(column.name in NULLABLE) for column in LIFE_TABLES[table]]
    return pa.schema(fields, metadata=schema_metadata(columns))


def _without_about(schema: pa.Schema) -> pa.Schema:
    return schema.with_metadata({key: value for key, value in (schema.metadata or {}).items() if key != ABOUT})


def _stream(rows: pa.RecordBatch | pa.Table) -> bytes:
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, rows.schema, options=pa.ipc.IpcWriteOptions(compression="zstd")) as writer:
        writer.write(rows)
    return bytes(sink.getvalue().to_pybytes())


def streamed(content: bytes) -> Iterator[pa.RecordBatch]:
    """Yield the rows of a small table."""
    with pa.ipc.open_stream(pa.py_buffer(content)) as stream:
        yield from stream
