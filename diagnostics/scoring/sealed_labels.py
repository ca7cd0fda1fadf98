"""Labels of a benchmark's test parts in one file: sealed with its maker, or revealed; and parts read with them.

The commitment is the SHA-256 of the file. Its salt, 32 random bytes, keeps anybody from trying labels until the hash
fits. The file names the digest of the benchmark, so labels cannot be laid beside other records.
"""

from __future__ import annotations

import copy
import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.base.beside import beside
from diagnostics.scoring.benchmark import SEALED, SECRET, Benchmark
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

RECORD = "record_id"


@dataclass(frozen=True, slots=True)
class SealedLabels:
    """What a file of labels says.

    Attributes
    ----------
    digest : str
        Of the benchmark that they belong to.
    simulation_version : int
    parts : mapping of str to mapping
        Of every test part `labels` and `damage`, columns by name; of lives tables by name in `life`.
    commitment : str
        SHA-256 of the file.
    file : Path
    """

    digest: str
    simulation_version: int
    parts: Mapping[str, Mapping[str, Any]]
    commitment: str
    file: Path


def read_labels(file: Path) -> SealedLabels:
    """Return the labels of a file.

    Raises
    ------
    UsageError
        If it is none.
    """
    try:
        content = file.read_bytes()
        found = json.loads(content)
        named = {name: found[name] for name in ("digest", "simulation_version", "parts")}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise UsageError(
            f"{file}: is no file of labels ({type(error).__name__}: {error}); allowed: sealed.json of the maker, or "
            "revealed.json of the benchmark"
        ) from error
    return SealedLabels(commitment=hashlib.sha256(content).hexdigest(), file=file, **named)


def labels_of(benchmark: Benchmark, file: Path | None) -> SealedLabels:
    """Return the labels of a benchmark: of a file, else those revealed, else its maker's beside it.

    Raises
    ------
    UsageError
        If there are none, or they are of another benchmark or version, or not those that were committed to.
    """
    own = beside(benchmark.path, SECRET) / SEALED
    chosen = file or benchmark.revealed() or (own if own.is_file() else None)
    if chosen is None:
        raise UsageError(
            f"{benchmark.path}: its labels are not revealed, and {own} is not there; its maker names the file with "
            "--labels, others wait for `bench reveal`"
        )
    found = read_labels(chosen)
    ours = (benchmark.digest, benchmark.simulation_version)
    if (found.digest, found.simulation_version) != ours:
        raise UsageError(
            f"{chosen}: holds labels of the digest {found.digest[:12]}, simulation version {found.simulation_version}; "
            f"this benchmark is {ours[0][:12]}, version {ours[1]}. Take its own labels"
        )
    committed = benchmark.commitment()
    if committed not in (None, found.commitment):
        raise UsageError(
            f"{chosen}: its SHA-256 is {found.commitment}; committed to was {committed}. These are other labels"
        )
    return found


class LabelledPart(Dataset):
    """A test part with its labels."""

    def with_labels(self, part: Mapping[str, Any]) -> LabelledPart:
        """Return the part with labels, table of damage and lives."""
        self._told = pa.table(dict(part["labels"]))
        self._rows = pa.table(dict(part["damage"]))
        self._lives = {name: pa.table(dict(columns)) for name, columns in part.get("life", {}).items()}
        return self

    def labels(self, split: str | None = None, columns: Sequence[str] | None = None) -> pa.Table:
        """Return labels as `Dataset.labels`, those that were sealed in place of what the files say."""
        blind = super().labels(split)
        place = pc.index_in(blind.column(RECORD).cast(pa.int64()), self._told.column(RECORD))
        told = self._told.take(place)
        for name in told.column_names:
            own = blind.schema.get_field_index(name)
            column = told.column(name)
            blind = blind.append_column(name, column) if own < 0 else blind.set_column(own, name, column)
        return blind if columns is None else blind.select(list(columns))

    def damage(self, split: str | None = None) -> pa.Table:
        """Return the damaged teeth as `Dataset.damage`."""
        return self._of_split(self._rows, split)

    def life(self, table: str, split: str | None = None) -> pa.Table:
        """Return a table as `Dataset.life`, one that was sealed in place of what the files say."""
        return self._of_split(self._lives[table], split) if table in self._lives else super().life(table, split)

    def _of_split(self, rows: pa.Table, split: str | None) -> pa.Table:
        wanted = self.labels(split, [RECORD]).column(RECORD)
        return rows.filter(pc.is_in(rows.column(RECORD), value_set=wanted.combine_chunks()))


def labelled(part: Dataset, labels: SealedLabels, name: str) -> Dataset:
    """Return a test part with its labels."""
    view = copy.copy(part)
    view.__class__ = LabelledPart
    assert isinstance(view, LabelledPart)
    return view.with_labels(labels.parts[name])
