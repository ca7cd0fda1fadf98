"""Where the table of a set is kept: `DIR_table/` beside the set's folder, one Parquet file per settings and channels.

A file's name carries what its numbers depend on: the set (digest of its manifest, size and time of its files), the
source code of signals, records and indicators, the settings, the channels. So nothing has to be declared out of date;
files of another state of the set are deleted where a new one is written. The folder can be deleted at any time.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict
from functools import lru_cache
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from diagnostics.indicators.settings import IndicatorSettings
from siggen.dataset.reading import Dataset

CODE = ("signal", "records", "indicators")
DIGITS = 12


def table_file(dataset: Dataset, settings: IndicatorSettings, channels: Sequence[str]) -> Path | None:
    """Return the file of a set's table, whether it exists or not; None for a set that is no folder.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    settings : IndicatorSettings
        How values are taken.
    channels : sequence of str
        Channels of the table.
    """
    folder = Path(dataset.path)
    if not (folder / "manifest.json").is_file():
        return None
    folder = folder.resolve()
    files = sorted(name for name in dataset.manifest.get("files", {}) if name.startswith(("data/", "metadata/")))
    facts = [(name, *_stat(folder / name)) for name in files]
    state = _digest([dataset.manifest, facts, _code_digest()])
    chosen = _digest([asdict(settings), list(channels)])
    return folder.with_name(f"{folder.name}_table") / f"{state}-{chosen}.parquet"


def _stat(path: Path) -> tuple[int, int]:
    try:
        found = path.stat()
    except OSError:  # reading the set says which file is missing, and what to do
        return 0, 0
    return found.st_size, found.st_mtime_ns


def _digest(content: Any) -> str:
    text = json.dumps(content, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:DIGITS]


@lru_cache(maxsize=1)
def _code_digest() -> str:
    """Return the digest of the code that makes the numbers: another version of it never takes over old ones."""
    package = Path(__file__).resolve().parents[1]
    files = sorted(file for folder in CODE for file in (package / folder).glob("*.py"))
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


def is_readable(path: Path) -> bool:
    """Return whether a table lies there as it was written; one that was changed since is computed again."""
    try:
        return _hash_file(path).read_text(encoding="ascii") == _sha256(path)
    except (OSError, UnicodeDecodeError):
        return False


def keep_table(table: pa.Table, path: Path) -> str:
    """Write a table and delete those of other states of the set; return why it could not be kept, or an empty text."""
    partial = path.with_suffix(".partial")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        pq.write_table(table, partial, compression="zstd")
        _hash_file(path).write_text(_sha256(partial), encoding="ascii")
        partial.replace(path)
        for other in path.parent.glob("*-*.parquet"):
            if other.name.split("-")[0] != path.name.split("-")[0]:
                other.unlink(missing_ok=True)
                _hash_file(other).unlink(missing_ok=True)
    except OSError as error:
        return f"the table of indicators could not be kept ({error}); the next command computes it again"
    return ""


def _hash_file(path: Path) -> Path:
    return path.with_suffix(".sha256")


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
