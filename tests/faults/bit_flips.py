"""One bit flipped in a file, then everything read that the file serves: refused in words, or read as data."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random

import siggen
from benchmarks.row import Row
from siggen.dataset.reading import Dataset
from siggen.errors import SiggenError
from tests.faults.victims import small_model, small_set

FLIPS_PER_KIND, QUICK_FLIPS = 40, 10
REFUSED, UNNAMED, SILENT = "refused in words, by its name", "refused without its name", "read as data"

SET_FILES: dict[str, tuple[tuple[str, ...], Callable[[Dataset], object]]] = {
    "signals": (("data/*.parquet",), lambda dataset: list(dataset.records())),
    "internal quantities": (("internals/*.parquet",), lambda dataset: list(dataset.internals())),
    "labels": (("labels.parquet",), lambda dataset: dataset.labels()),
    "damage": (("damage.parquet",), lambda dataset: dataset.damage()),
    "manifest": (("manifest.json",), lambda dataset: list(dataset.records())),
    "configuration": (("config.yaml",), lambda dataset: list(dataset.records())),
    "card": (("README.md",), lambda dataset: dataset.card()),
}
"""Which files of a set are flipped, and how they are read."""


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield a row per kind of file: how many flips the reader found."""
    flips = QUICK_FLIPS if quick else FLIPS_PER_KIND
    with tempfile.TemporaryDirectory() as name:
        victim = small_set(Path(name) / "set")
        for kind in SET_FILES:
            yield _row(kind, Counter(flipped_in_set(victim, kind, flips)))
        yield _row("model folder", Counter(flipped_in_model(small_model(victim, Path(name) / "model"), flips)))


def _row(kind: str, outcomes: Counter[str]) -> Row:
    count, found = outcomes.total(), outcomes[REFUSED]
    others = ", ".join(f"{outcome}: {number}" for outcome, number in outcomes.items() if outcome != REFUSED)
    what = f"{count} flipped bits, {kind}"
    return Row(what, f"{found} found by the reader", others or "no other", None, "all", found == count)


def flipped_in_set(folder: Path, kind: str, count: int, seed: int = 0) -> Iterator[str]:
    """Yield the outcome of each flip in the files of a kind."""
    patterns, read = SET_FILES[kind]
    files = sorted(file for pattern in patterns for file in folder.glob(pattern))
    yield from _outcomes(files, lambda: read(siggen.open(folder)), count, seed)


def flipped_in_model(folder: Path, count: int, seed: int = 0) -> Iterator[str]:
    """Yield the outcome of each flip in any file of a model that is loaded."""
    from diagnostics.prediction.model_facts import FACTS_FILE, MODEL_FILES
    from diagnostics.prediction.released_model import load_model

    files = [folder / name for name in (FACTS_FILE, *MODEL_FILES) if (folder / name).is_file()]
    yield from _outcomes(files, lambda: load_model(folder), count, seed)


def _outcomes(files: list[Path], read: Callable[[], object], count: int, seed: int) -> Iterator[str]:
    read()
    chance = Random(seed)
    for _ in range(count):
        file = chance.choices(files, [path.stat().st_size for path in files])[0]
        whole = file.read_bytes()
        broken = bytearray(whole)
        broken[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
        file.write_bytes(broken)
        try:
            yield _outcome(read, file.name)
        finally:
            file.write_bytes(whole)


def _outcome(read: Callable[[], object], name: str) -> str:
    try:
        read()
    except SiggenError as error:
        return REFUSED if name in str(error) else UNNAMED
    except Exception as error:
        return f"a raw {type(error).__name__}"
    return SILENT
