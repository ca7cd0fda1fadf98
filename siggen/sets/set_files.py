"""The files of a set that come after its shards: small tables, card, configuration, and the manifest last."""

from __future__ import annotations

import pickle
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from tempfile import TemporaryFile
from typing import IO, Any

from siggen.columns.record import RecordFailure, SetColumns, listed_columns, record_schema
from siggen.columns.versions import SCHEMA_VERSION, SIMULATION_VERSION
from siggen.dataset.card import card
from siggen.dataset.inventory import ListedSplit, PromisedFile
from siggen.dataset.manifest import CARD, CONFIG, MANIFEST
from siggen.dataset.object_name import SPLITS, data_name
from siggen.dataset.seal import sealed
from siggen.dataset.shard import PackedTable, promised
from siggen.dataset.storage import Storage
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import ShardPlan
from siggen.sets.shard_making import MadeShard, streamed


@dataclass(slots=True)
class MadeShards:
    """What came of shards, by name; small tables grow in the order of the shards while workers make others.

    Rows of shards whose turn has not come wait in a file without a name, so that memory does not grow with the set.
    """

    order: Sequence[str]
    by_name: dict[str, MadeShard] = field(default_factory=dict)
    tables: dict[str, PackedTable] = field(default_factory=dict)
    _places: dict[str, int] = field(default_factory=dict)
    _waiting: IO[bytes] = field(default_factory=TemporaryFile)
    _next: int = 0

    def add(self, made: MadeShard) -> None:
        """Keep what came of a shard."""
        self.by_name[made.shard] = replace(made, tables={})
        if not self.tables:
            return
        self._places[made.shard] = self._waiting.seek(0, 2)
        pickle.dump(dict(made.tables), self._waiting)
        while self._next < len(self.order) and self.order[self._next] in self._places:
            self._waiting.seek(self._places.pop(self.order[self._next]))
            for name, content in pickle.load(self._waiting).items():
                for batch in streamed(content):
                    self.tables[name].add(batch)
            self._next += 1
        if not self._places:
            self._waiting.truncate(0)

    def close(self) -> None:
        """Give the files back."""
        self._waiting.close()
        for table in self.tables.values():
            table.close()

    def put_tables(self, storage: Storage) -> dict[str, PromisedFile]:
        """Write labels, damage and lives of all shards; return what is promised of them."""
        promises = {}
        for name, table in self.tables.items():
            file, promises[name] = table.finish()
            storage.put(name, file)
        return promises


def put(storage: Storage, name: str, content: bytes) -> PromisedFile:
    """Write a file and return what is promised of it."""
    storage.put(name, content)
    return promised(content)


def put_last(
    design: SetDesign,
    storage: Storage,
    columns: SetColumns,
    planned: Sequence[ShardPlan],
    made: MadeShards,
    extensions: Sequence[int],
    environment: Mapping[str, str],
) -> Mapping[str, Any]:
    """Write what comes after the shards, the manifest last; return its content."""
    shards = [made.by_name[shard.key] for shard in planned]
    splits = {split: _split(of_split, made) for split, of_split in _by_split(planned) if of_split}
    failures = [failure for shard in shards for failure in shard.failures]
    files = {name: file for shard in shards for name, file in shard.files.items()}
    files |= made.put_tables(storage)
    files[CARD] = put(storage, CARD, card(design, splits, failures, environment, columns).encode())
    files[CONFIG] = put(storage, CONFIG, design.text.encode())
    rows = {shard.shard: shard.rows for shard in shards}
    facts = {**facts_of_design(design, columns), "extensions": list(extensions)}
    content = manifest_content(facts, splits, rows, failures, files, environment)
    storage.put(MANIFEST, sealed(content))
    return content


def facts_of_design(design: SetDesign, columns: SetColumns) -> dict[str, Any]:
    """Return what the manifest says of a set beside its files."""
    internals = [{"name": c.name, "unit": c.unit, "meaning": c.meaning} for c in columns.quantities]
    return {
        **({"internals": internals} if internals else {}),
        "name": design.name,
        "identity": design.identity,
        "seed": design.seed,
        "specimens": design.specimens,
        "fs_hz": float(design.fs_hz),
        "duration_s": float(design.duration_s),
        "channels": [asdict(channel) for channel in columns.channels],
        "columns": listed_columns(record_schema(columns)),
        "drivetrain": asdict(columns.drivetrain),
        **({} if design.tolerance is None else {"integration_tolerance": design.tolerance}),
    }


def manifest_content(
    facts: Mapping[str, Any],
    splits: Mapping[str, ListedSplit],
    rows: Mapping[str, int],
    failures: Sequence[RecordFailure],
    files: Mapping[str, PromisedFile],
    environment: Mapping[str, str],
) -> dict[str, Any]:
    """Return what a manifest says.

    Parameters
    ----------
    facts : mapping
        What the configuration says about the set: name, identity, channels, ...
    rows : mapping
        Shard -> rows, in the order of the shards.
    """
    return {
        "format": "siggen data set",
        "schema_version": SCHEMA_VERSION,
        "simulation_version": SIMULATION_VERSION,
        **facts,
        "splits": {name: asdict(split) for name, split in splits.items()},
        "rows": sum(rows.values()),
        "shards": [{"shard": shard, "rows": count} for shard, count in rows.items()],
        "failures": [asdict(failure) for failure in failures],
        "environment": dict(environment),
        "files": {name: asdict(file) for name, file in files.items()},
    }


def _by_split(planned: Sequence[ShardPlan]) -> Iterator[tuple[str, list[ShardPlan]]]:
    return ((split, [shard for shard in planned if shard.split == split]) for split in SPLITS)


def _split(planned: Sequence[ShardPlan], made: MadeShards) -> ListedSplit:
    shards = [made.by_name[shard.key] for shard in planned]
    states: dict[str, int] = {}
    for shard in shards:
        for state, rows in shard.rows_per_state.items():
            states[state] = states.get(state, 0) + rows
    return ListedSplit(
        specimens=sum(len(shard.specimens) for shard in planned),
        rows=sum(shard.rows for shard in shards),
        failed=sum(len(shard.failures) for shard in shards),
        states=states,
        shards=len(shards),
        bytes=sum(shard.files[data_name(plan.key)].bytes for plan, shard in zip(planned, shards, strict=True)),
    )
