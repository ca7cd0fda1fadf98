"""A benchmark on disk: a part to learn from, test parts without labels, and the digest that binds scores to them.

The digest is the SHA-256 of what the signals and labels of all parts must be, of the versions and of the tier. It
stands in every score. Predictions or labels that name another one are refused.

Labels of the test parts are one file: sealed with its maker, or revealed. The commitment is the SHA-256 of that file.
Its salt, 32 random bytes, keeps anybody from trying labels until the hash fits.
"""

from __future__ import annotations

import copy
import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.base.beside import beside
from diagnostics.indicators.table import WHOLE
from siggen.dataset.reading import Dataset
from siggen.dataset.reading import open as open_set
from siggen.errors import DatasetError, UsageError

FACTS, COMMITMENT, REVEALED = WHOLE, "commitment.json", "revealed.json"
LEARN, TESTS, BASELINES = "learn", "test", "baselines"
SECRET, SEALED = "_secret", "sealed.json"
"""Ending of the maker's folder beside the benchmark, and its file of labels."""
FORMAT = "siggen benchmark"
NAME = re.compile(r"[a-z0-9_]{1,60}")
"""Of a test part: that of a folder."""
PER_PART = 1_000_000
"""Numbers of records of a part begin at its place, from 1, times this: one file may hold predictions for all parts."""
BOUND = ("data/", "labels.", "life/")
"""Files of a part that the digest holds: rows. Cards may be mended."""


@dataclass(frozen=True, slots=True)
class Benchmark:
    """A benchmark whose files are those that it promises.

    Attributes
    ----------
    path : Path
    title, tier, digest : str
    simulation_version : int
    parts : tuple of str
        Names of the test parts; their folders are `test/NAME`.
    """

    path: Path
    title: str
    tier: str
    digest: str
    simulation_version: int
    parts: tuple[str, ...]

    def learn(self) -> Dataset:
        """Return the part to learn from."""
        return open_set(self.path / LEARN)

    def part(self, name: str) -> Dataset:
        """Return a test part."""
        return open_set(self.path / TESTS / name)

    def commitment(self) -> str | None:
        """Return the hash that was committed to; None before."""
        file = self.path / COMMITMENT
        return str(_json(file)["sha256"]) if file.is_file() else None

    def revealed(self) -> Path | None:
        """Return the file of revealed labels; None before."""
        file = self.path / REVEALED
        return file if file.is_file() else None

    def __str__(self) -> str:
        """Return what stands above scores."""
        return f"{self.title}, {self.tier}, digest {self.digest[:12]}, simulation version {self.simulation_version}"


def is_benchmark(path: Path) -> bool:
    """Return whether a folder holds a benchmark."""
    return (path / FACTS).is_file()


def open_benchmark(path: Path | str) -> Benchmark:
    """Return a benchmark.

    Raises
    ------
    UsageError
        If the folder holds none.
    DatasetError
        If its parts are not those that its digest is of, or of several versions of the simulation.
    """
    path = Path(path)
    if not is_benchmark(path):
        raise UsageError(f"{path}: holds no {FACTS}; allowed: a folder that `diagnostics.make_benchmark` wrote")
    facts = _json(path / FACTS)
    try:
        title, tier, parts = str(facts["title"]), str(facts["tier"]), tuple(map(str, facts["parts"]))
    except (KeyError, TypeError) as error:
        raise UsageError(f"{path / FACTS}: is not what `make_benchmark` writes ({error}); fetch it again") from error
    if wrong := [name for name in parts if not NAME.fullmatch(name)]:
        raise UsageError(f"{path / FACTS}: received the part {wrong[0]!r}; allowed: lower-case letters, digits, _")
    found = benchmark_facts(path, title, tier, parts)
    if found != facts:
        changed = ", ".join(name for name in found if found[name] != facts.get(name))
        raise DatasetError(f"{path}: its parts are not those that were published (other: {changed}); fetch them again")
    return Benchmark(path, title, tier, str(found["digest"]), int(found["simulation_version"]), parts)


def benchmark_facts(path: Path, title: str, tier: str, parts: tuple[str, ...]) -> dict[str, Any]:
    """Return what `benchmark.json` says of finished parts.

    Raises
    ------
    DatasetError
        If they were made by several versions of the simulation.
    """
    folders = {LEARN: path / LEARN, **{name: path / TESTS / name for name in parts}}
    sets = {name: open_set(folder) for name, folder in folders.items()}
    versions = {int(one.manifest["simulation_version"]) for one in sets.values()}
    if len(versions) > 1:
        raise DatasetError(f"{path}: made by the simulation versions {sorted(versions)}; allowed is one. Make it again")
    promised = {
        f"{name}/{file}": facts.sha256
        for name, one in sets.items()
        for file, facts in one.files.items()
        if file.startswith(BOUND)
    }
    facts: dict[str, Any] = {
        "format": FORMAT,
        "title": title,
        "tier": tier,
        "simulation_version": versions.pop(),
        "parts": list(parts),
        "records": {name: one.inventory.rows for name, one in sets.items()},
    }
    return {**facts, "digest": _digest({**facts, "files": promised})}


def _digest(content: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _json(file: Path) -> dict[str, Any]:
    try:
        return dict(json.loads(file.read_text(encoding="utf-8")))
    except (OSError, ValueError) as error:
        raise UsageError(f"{file}: cannot be read ({error})") from error


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
            "--labels, others wait for `diagnostics.reveal_benchmark`"
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
