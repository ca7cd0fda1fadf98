"""A set of given rows: the files of a generated set, so that every reader of sets takes it.

Rows hold recordings, or simulated records without what would tell their state (blind). Where a generated set has
gearboxes (`specimen_id`), a set of recordings may have these; ids, labels and splits are those of the rows. Nobody can
simulate such rows again, so `siggen verify` compares hashes alone. `siggen publish` takes neither.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from siggen.columns.record import (
    TACHO_COLUMN,
    SetColumns,
    damage_schema,
    listed_columns,
    record_schema,
    schema_metadata,
)
from siggen.dataset.environment import environment
from siggen.dataset.inventory import ListedSplit
from siggen.dataset.manifest import BLIND, CARD, CONFIG, INJECTED, MANIFEST
from siggen.dataset.object_name import DAMAGE, SPLITS, data_name, life_name
from siggen.dataset.object_name import LABELS as LABELS_FILE
from siggen.dataset.seal import json_bytes, sealed
from siggen.dataset.shard import packed
from siggen.dataset.storage import LocalFolder
from siggen.errors import DatasetError
from siggen.gearbox.design import SetDesign
from siggen.keys.column import list_of
from siggen.sets.drawn import set_columns
from siggen.sets.set_files import manifest_content, put

IDS = ("record_id", "specimen_id", "state_id", "state", "operating_point_id", "repeat", "split")
LABELS = (
    *("fault", "severity", "faulty_gear", "damaged_area_mm2", "damaged_area_share", "damage_profile_length_mm"),
    *("mesh_stiffness_loss", "speed_hz", "torque_nm"),
)
Row = Mapping[str, Any]


def write_recorded_set(
    design: SetDesign,
    folder: Path,
    rows: Sequence[Row],
    origin: pa.Schema,
    facts: Mapping[str, Any],
    card: str,
    *,
    measured: SetDesign | None = None,
    life: Mapping[str, pa.Table] | None = None,
) -> Path:
    """Write rows with signals into a new folder that `siggen.open` reads.

    Parameters
    ----------
    design : SetDesign
        Gives channels, rate and the types of the labels; stands in the folder.
    folder : Path
        New or empty.
    rows : sequence of mapping
        By ascending `record_id`, those of a split together: IDS, LABELS, teeth of all gears, the columns of `origin`,
        `signals` with one (n,) [m/s²] per channel, and `tacho_s`. Signals are cut to the shortest.
    origin : pyarrow.Schema
        Further columns, which say where a row comes from, with `role` in the metadata of each.
    facts : mapping
        What `injected.json` says, of blind rows `blind.json`.
    card : str
        README.md.
    measured : SetDesign, optional
        What blind rows were made of. It gives their channels, and nothing else of it stands in the folder.
    life : mapping of str to pyarrow.Table, optional
        Tables of `life/` by name, with the column `split`.

    Raises
    ------
    DatasetError
        If the folder is not empty.
    """
    storage = LocalFolder(folder)
    if storage.names():
        raise DatasetError(f"{folder}: is not empty; give a new folder")
    samples = min(len(signal) for row in rows for signal in row["signals"])
    identity, heard, own_facts = _identity(rows, design.identity), measured or design, BLIND if measured else INJECTED
    own, others = set_columns(design), set_columns(heard)
    schema = _schema(own, others, origin, samples)
    shares = {split: found for split in SPLITS if (found := [row for row in rows if row["split"] == split])}
    files, splits = {}, {}
    for split, of_split in shares.items():
        table = pa.Table.from_batches(_batches(of_split, schema), schema)
        files[data_name(f"{split}-00000")] = put(storage, data_name(f"{split}-00000"), packed(table))
        splits[split] = _counts(of_split, files[data_name(f"{split}-00000")].bytes)
    in_order = [row for of_split in shares.values() for row in of_split]
    tables = {LABELS_FILE: _labels(in_order, schema), DAMAGE: damage_schema(own).empty_table()}
    tables |= {life_name(name): _life(own, table, tuple(shares)) for name, table in (life or {}).items()}
    contents = {name: packed(table) for name, table in tables.items()}
    contents |= {CONFIG: design.text.encode(), CARD: card.encode(), own_facts: json_bytes(facts)}
    files |= {name: put(storage, name, content) for name, content in contents.items()}
    gearboxes = len({row["specimen_id"] for row in rows})
    about = {
        "name": f"{design.name}_{'blind' if measured else 'recorded'}",
        "identity": identity,
        "seed": design.seed,
        "specimens": gearboxes,
        "extensions": [gearboxes],
        "fs_hz": float(design.fs_hz),
        "duration_s": samples / float(design.fs_hz),
        "channels": [asdict(channel) for channel in others.channels],
        "columns": listed_columns(schema),
        "drivetrain": asdict(own.drivetrain),
    }
    counts = {f"{split}-00000": len(of_split) for split, of_split in shares.items()}
    storage.put(MANIFEST, sealed(manifest_content(about, splits, counts, (), files, environment())))
    return folder


def _counts(rows: Sequence[Row], size: int) -> ListedSplit:
    states = [row["state"] for row in rows]
    return ListedSplit(
        specimens=len({row["specimen_id"] for row in rows}),
        rows=len(rows),
        failed=0,
        states={state: states.count(state) for state in dict.fromkeys(states)},
        shards=1,
        bytes=size,
    )


def _identity(rows: Sequence[Row], configuration: str) -> str:
    digest = hashlib.sha256(configuration.encode())
    for row in rows:
        for signal in row["signals"]:
            digest.update(signal.astype(np.float32).tobytes())
    return digest.hexdigest()


def _schema(columns: SetColumns, heard: SetColumns, origin: pa.Schema, samples: int) -> pa.Schema:
    """Return the columns, those that a generated set has too as they are there; signals as the other one's."""
    own, others = record_schema(columns), record_schema(heard)
    signals = [others.field(channel.column).with_type(list_of(pa.float32(), samples)) for channel in heard.channels]
    metadata = {**schema_metadata(columns), "duration_s": repr(samples / columns.sampling.fs_hz)}
    teeth = (field.name for field in own if (field.metadata or {}).get(b"quantity") == b"teeth")
    labels = [own.field(name) for name in (*IDS, *LABELS, *teeth)]
    return pa.schema([*labels, *origin, *signals, TACHO_COLUMN.field()], metadata=metadata)


def _batches(rows: Sequence[Row], schema: pa.Schema) -> Iterator[pa.RecordBatch]:
    fields = [field for field in schema if pa.types.is_fixed_size_list(field.type)]
    samples, duration_s = fields[0].type.list_size, float(schema.metadata[b"duration_s"])
    for row in rows:
        signals = zip(fields, row["signals"], strict=True)
        cut = {field.name: signal[:samples].astype(np.float32) for field, signal in signals}
        inside = row[TACHO_COLUMN.name][row[TACHO_COLUMN.name] < duration_s]
        yield pa.RecordBatch.from_pylist([{**row, **cut, TACHO_COLUMN.name: inside}], schema=schema)


def _labels(rows: Sequence[Row], schema: pa.Schema) -> pa.Table:
    fields = [field for field in schema if not pa.types.is_list(field.type) | pa.types.is_fixed_size_list(field.type)]
    names = pa.schema(fields, metadata=schema.metadata)
    return pa.Table.from_pylist([{name: row[name] for name in names.names} for row in rows], schema=names)


def _life(columns: SetColumns, table: pa.Table, splits: Sequence[str]) -> pa.Table:
    """Return a table of lives, split by split."""
    parts = [table.filter(pc.equal(table.column("split"), split)) for split in splits]
    return pa.concat_tables(parts).replace_schema_metadata(schema_metadata(columns))
