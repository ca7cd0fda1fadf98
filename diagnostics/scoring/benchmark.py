"""A benchmark on disk: a part to learn from, test parts without labels, and the digest that binds scores to them.

The digest is the SHA-256 of what the signals and labels of all parts must be, of the versions and of the tier. It
stands in every score. Predictions or labels that name another one are refused.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

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
BOUND = ("data/", "metadata/", "life/")
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
        raise UsageError(f"{path}: holds no {FACTS}; allowed: a folder that `siggen-diagnostics bench make` wrote")
    facts = _json(path / FACTS)
    try:
        title, tier, parts = str(facts["title"]), str(facts["tier"]), tuple(map(str, facts["parts"]))
    except (KeyError, TypeError) as error:
        raise UsageError(f"{path / FACTS}: is not what `bench make` writes ({error}); fetch it again") from error
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
