"""One set of the default model made in every way there is, and the digest of its files."""

from __future__ import annotations

import importlib.util
import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from benchmarks.row import Row
from siggen.dataset.storage import LocalFolder
from siggen.dataset.storage_at import storage_at
from tests.faults.kills import PARTS_AND_END, start, steps
from tests.faults.moto_store import BUCKET, moto_store
from tests.faults.set_files import digest, set_files
from tests.faults.victim_run import SPECIMENS

FIRST = "1 process"


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the digest of the set by how it was made; all have to be the first one."""
    with tempfile.TemporaryDirectory(prefix="digest", dir="/tmp") as name:
        os.environ["RAY_TMPDIR"] = str(Path(name) / "r")
        reference: dict[str, bytes] = {}
        for what, files in _made(Path(name), quick):
            reference = reference or files
            yield _row(what, files, reference)
        yield from _extended(Path(name) / "extended", reference)


def _row(what: str, files: Mapping[str, bytes], reference: Mapping[str, bytes]) -> Row:
    found, wanted = digest(files), digest(reference)
    met = found == wanted
    return Row(f"digest of {len(files)} files, {what}", found[:16], f"{FIRST}: {wanted[:16]}", None, "equal", met)


def _made(folder: Path, quick: bool) -> Iterator[tuple[str, dict[str, bytes]]]:
    ways = {FIRST: ["--workers", "1"], "2 processes": ["--workers", "2"], "serial": ["--executor", "serial"]}
    ways |= {} if quick else {name: ["--executor", name] for name in _clusters()}
    for number, (what, options) in enumerate(ways.items()):
        place = folder / str(number)
        _run(["generate", str(place), *options])
        yield what, set_files(LocalFolder(place))
    for step in steps(PARTS_AND_END, folder / "parts"):
        _run(step)
    yield "3 parts", set_files(LocalFolder(folder / "parts"))
    if importlib.util.find_spec("moto"):
        with moto_store():
            _run(["generate", f"s3://{BUCKET}/digest"])
            yield "2 processes, s3://", set_files(storage_at(f"s3://{BUCKET}/digest"))


def _extended(place: Path, reference: Mapping[str, bytes]) -> Iterator[Row]:
    """Yield whether a smaller set keeps its shards when it is extended, and has the records of one made at once.

    Shards that came later tell it in their metadata, so their bytes are others.
    """
    _run(["generate", str(place), "--specimens", str(SPECIMENS // 2)])
    before = set_files(LocalFolder(place))
    _run(["generate", str(place), "--specimens", str(SPECIMENS)])
    after = set_files(LocalFolder(place))
    shards = {name: content for name, content in before.items() if name.startswith(("data/", "internals/"))}
    kept = sum(after[name] == content for name, content in shards.items())
    equal = _records(after).equals(_records(reference))
    what = f"{SPECIMENS // 2} gearboxes extended to {SPECIMENS}"
    measured = f"{kept} of {len(shards)} files of shards kept their bytes"
    at_once = f"records are {'' if equal else 'not '}those of a set generated at once"
    yield Row(what, measured, at_once, None, "all, equal", kept == len(shards) and equal)


def _records(files: Mapping[str, bytes]) -> pa.Table:
    """Return all records of a set by their number."""
    tables = [pq.read_table(pa.BufferReader(content)) for name, content in files.items() if name.startswith("data/")]
    return pa.concat_tables([table.replace_schema_metadata(None) for table in tables]).sort_by("record_id")


def _clusters() -> list[str]:
    return [
        name for name, package in {"dask": "distributed", "ray": "ray"}.items() if importlib.util.find_spec(package)
    ]


def _run(step: list[str]) -> None:
    with tempfile.TemporaryFile() as said:
        if start(step, said).wait():
            said.seek(0)
            raise RuntimeError(f"{step}: {said.read().decode(errors='replace')[-500:]}")
