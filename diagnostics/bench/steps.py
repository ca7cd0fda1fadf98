"""A benchmark in Python: make it, commit to its labels, write baselines, show a leaderboard, reveal."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from diagnostics.base.beside import beside
from diagnostics.base.extras import require_packages
from diagnostics.base.progress import silent_stage
from diagnostics.bench.conditions import TIERS
from diagnostics.bench.derived_secret import read_secret
from diagnostics.bench.leaderboard import board_entries, write_board
from diagnostics.bench.making import LEARNT, SECRET_FILE, WantedBench, commit, reveal, write_benchmark
from diagnostics.bench.questions import write_baselines
from diagnostics.scoring.benchmark import SECRET, Benchmark, labels_of, open_benchmark
from siggen.errors import UsageError


def make_benchmark(
    folder: str | Path,
    tier: str = "tiny",
    *,
    config: Any = None,
    overrides: Sequence[str] = (),
    secret: str | Path | None = None,
    facts: str | Path | None = None,
    workers: int | None = None,
) -> Benchmark:
    """Make a part to learn from, and test parts without labels whose seeds nobody knows; or go on with them.

    Parameters
    ----------
    folder : path
        New; publish it.
    tier : str
        `tiny`, `small` or `full`: how many gearboxes.
    config : path or mapping, optional
        To learn from, that of siggen-bench unless told; one of lives asks how long they last.
    overrides : sequence of str
        `PATH=VALUE`, in all parts.
    secret : path, optional
        Folder for the secret, the simulated test sets and sealed.json, FOLDER_secret unless told. Never publish it.
    facts : path, optional
        Licence, authors and citation, as `siggen publish` takes them.
    workers : int, optional
        Processes, one per core unless told.

    Raises
    ------
    UsageError
        If the tier is unknown, or one folder lies in the other.
    ConfigError, DatasetError
        As of `siggen.generate`.
    """
    if tier not in TIERS:
        raise UsageError(f"tier: received {tier!r}; allowed are {', '.join(TIERS)}")
    hidden = Path(secret) if secret else beside(Path(folder), SECRET)
    wanted = WantedBench(tier, TIERS[tier], config or LEARNT, tuple(overrides), facts=Path(facts) if facts else None)
    return write_benchmark(Path(folder), hidden, read_secret(hidden / SECRET_FILE), wanted, workers)


def commit_benchmark(folder: str | Path, labels: str | Path | None = None) -> str:
    """Return the SHA-256 of labels, salt, seeds and configurations, written into the benchmark: publish it first."""
    return commit(open_benchmark(folder), Path(labels) if labels else None)


def reveal_benchmark(folder: str | Path, labels: str | Path | None = None) -> Path:
    """Write labels, salt, seeds and configurations of the test parts into the benchmark; return the file."""
    return reveal(open_benchmark(folder), Path(labels) if labels else None)


def benchmark_baselines(folder: str | Path, seed: int = 0, workers: int = 1) -> Path:
    """Learn the baselines on the part to learn from, write what they say of all test parts; return the file."""
    require_packages("baselines", "sklearn")
    return write_baselines(open_benchmark(folder), seed, workers, silent_stage)


def leaderboard(
    folder: str | Path,
    entries: str | Path | None = None,
    *,
    out: str | Path | None = None,
    labels: str | Path | None = None,
    seed: int = 0,
) -> Path:
    """Write leaderboard.html: all entries and baselines, with limits over gearboxes and paired differences.

    Parameters
    ----------
    folder : path
        Of the benchmark.
    entries : path, optional
        Folder with files of predictions. One that used the healthy references says so in a column `reference`.
    out : path, optional
        FOLDER_board unless told.
    labels : path, optional
        Those revealed, else FOLDER_secret/sealed.json unless told.
    seed : int
        Of the resampled gearboxes.

    Returns
    -------
    Path
        The page.
    """
    found = open_benchmark(folder)
    sealed = labels_of(found, Path(labels) if labels else None)
    judged = board_entries(found, sealed, Path(entries) if entries else None, seed)
    return write_board(found, judged, Path(out) if out else beside(found.path, "_board"))
