"""A page that says who stands where on a benchmark: every file of predictions in a folder, beside the baselines.

Entries are ordered by the mean over the test parts of the AUC for every damage. Differences are paired on the same
resampled gearboxes, and stand beside the leader of each table. Gearboxes of different parts are independent, so the
mean over parts is taken resample by resample.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.base.extras import missing_packages
from diagnostics.bench.baselines import REFERENCE
from diagnostics.page.html import Cell, figure_block, figure_grid, heading, minus, page, paragraph, summary, table
from diagnostics.page.style import png_bytes
from diagnostics.page.tables import interval_cell
from diagnostics.scoring.benchmark import BASELINES, Benchmark
from diagnostics.scoring.benchmark_scores import JudgedPart, judged_parts, part_columns
from diagnostics.scoring.detect import DETECT, EVERY, LEAK
from diagnostics.scoring.prediction_file import CLASSIFIER, PREDICTIONS_FILE, prediction_table
from diagnostics.scoring.score_figure import score_figure
from diagnostics.scoring.score_row import ScoreRow
from diagnostics.scoring.sealed_labels import SealedLabels
from diagnostics.statistics.evaluation import RESAMPLES, Interval, bootstrap_weights, interval
from diagnostics.statistics.scores import area_interval
from siggen.errors import UsageError

BOARD, NUMBERS = "leaderboard.html", "leaderboard.json"
TRACKS = {False: "Alone", True: "Beside a healthy record of the same gearbox"}
MEAN = "mean"
SUFFIXES = (".parquet", ".csv")


@dataclass(frozen=True, slots=True)
class Entry:
    """AUC samples of one detector by part: the value itself, then those of resampled gearboxes; and of the sham.

    `gearboxes` is the number that limits count, by part.
    """

    name: str
    referenced: bool
    every: Mapping[str, np.ndarray]
    sham: Mapping[str, np.ndarray]
    gearboxes: Mapping[str, int]

    def samples(self, part: str) -> np.ndarray:
        """Return the samples of a part; of their mean only where no part is missing."""
        return np.mean([*self.every.values()], axis=0) if part == MEAN else self.every[part]

    def score(self, part: str) -> Interval:
        """Return the AUC of a part with its limits."""
        return area_interval(self.samples(part), self.count(part))

    def count(self, part: str) -> int:
        """Return the gearboxes that limits count; those of all parts for their mean, since no two parts share one."""
        return sum(self.gearboxes[one] for one in self.every) if part == MEAN else self.gearboxes[part]


def board_entries(benchmark: Benchmark, labels: SealedLabels, folder: Path | None, seed: int) -> list[Entry]:
    """Return all entries: the baselines of the benchmark, and the files of a folder.

    Raises
    ------
    UsageError
        If there is none, or one cannot be judged; all problems of the first such file.
    """
    files = sorted(path for path in (folder.iterdir() if folder else ()) if path.suffix in SUFFIXES)
    own = benchmark.path / BASELINES / PREDICTIONS_FILE
    files = [*([own] if own.is_file() else []), *(file for file in files if file.resolve() != own.resolve())]
    if not files:
        raise UsageError(
            f"{folder or benchmark.path}: holds no predictions ({', '.join(SUFFIXES)}); `siggen-diagnostics bench "
            "baselines` writes those of the baselines"
        )
    parts = judged_parts(benchmark, labels)
    weights = {part.name: bootstrap_weights(part.truth.specimen, seed, RESAMPLES) for part in parts}
    found: dict[str, Entry] = {}
    for file in files:
        read = prediction_table(file)
        columns = part_columns(benchmark, parts, read, file, file.stem)
        for name in dict.fromkeys(name for by_name in columns.values() for name in by_name):
            if name in found:
                raise UsageError(f"{file}: a second entry {name!r}; give each a name of its own (column {CLASSIFIER})")
            answers = {part: by_name[name] for part, by_name in columns.items() if name in by_name}
            found[name] = _entry(name, _is_referenced(read, name), answers, parts, weights)
    return list(found.values())


def _is_referenced(read: pa.Table, name: str) -> bool:
    if REFERENCE not in read.column_names:
        return False
    said = read.column(REFERENCE).to_pylist()
    whose = read.column(CLASSIFIER).to_pylist() if CLASSIFIER in read.column_names else [name] * len(said)
    return any(bool(one) for one, own in zip(said, whose, strict=True) if str(own) == name)


def _entry(
    name: str,
    referenced: bool,
    answers: Mapping[str, Any],
    parts: Sequence[JudgedPart],
    weights: Mapping[str, np.ndarray],
) -> Entry:
    (measure,) = DETECT.measures
    found: dict[str, dict[str, np.ndarray]] = {EVERY: {}, LEAK: {}}
    counts = {}
    for part in parts:
        damage = DETECT.answers(answers[part.name], part.truth) if part.name in answers else None
        asked = DETECT.parts(part.truth) if damage is not None else {}
        for what, samples in found.items():
            if what in asked and damage is not None:
                rows, drawn = part.truth.rows(asked[what]), weights[part.name][:, asked[what]]
                samples[part.name] = measure.samples(damage[asked[what]], rows, drawn)
        counts[part.name] = measure.gearboxes(part.truth)
    return Entry(name, referenced, found[EVERY], found[LEAK], counts)


def write_board(benchmark: Benchmark, entries: Sequence[Entry], folder: Path) -> Path:
    """Write the page, and its numbers beside it; return the page."""
    folder.mkdir(parents=True, exist_ok=True)
    tables = {referenced: _ordered(entries, benchmark.parts, referenced) for referenced in TRACKS}
    numbers = [row for ordered in tables.values() for row in _numbers(ordered, benchmark)]
    facts = {"digest": benchmark.digest, "simulation_version": benchmark.simulation_version, "entries": numbers}
    (folder / NUMBERS).write_text(json.dumps(facts, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    title = f"Leaderboard of {benchmark.title}, {benchmark.tier}"
    parts = [heading(title, 1), *summary(_sentences(benchmark, tables))]
    for referenced, ordered in tables.items():
        if ordered:
            parts += [heading(TRACKS[referenced]), _figure(ordered), *_table(ordered, benchmark.parts)]
    path = folder / BOARD
    path.write_text(page(title, parts), encoding="utf-8")
    return path


def _ordered(entries: Sequence[Entry], parts: Sequence[str], referenced: bool) -> list[Entry]:
    """Return the entries of a track, the largest mean first; those that lack a part last."""
    own = [entry for entry in entries if entry.referenced == referenced and entry.every]
    return sorted(own, key=lambda one: (len(one.every) < len(parts), -float(one.samples(MEAN)[0]), one.name))


def _sentences(benchmark: Benchmark, tables: Mapping[bool, list[Entry]]) -> list[str]:
    entries = [entry for ordered in tables.values() for entry in ordered]
    sham = [(part, entry) for entry in entries for part in entry.sham]
    outside = [f"{entry.name} on {part}" for part, entry in sham if not _holds_chance(entry, part)]
    told = f" Outside: {', '.join(outside[:5])}." if outside else ""
    return [
        *(_lead(TRACKS[referenced], ordered) for referenced, ordered in tables.items() if ordered),
        f"A sham is damage without effect. In {len(sham) - len(outside)} of {len(sham)} cases the limits of its AUC "
        f"hold 0.5; about one in 20 is outside by chance.{told}",
        "Scores are AUC of damaged against healthy records of other gearboxes, with 95 % limits over gearboxes. "
        f"Digest {benchmark.digest}, simulation version {benchmark.simulation_version}: only scores with the same two "
        "are comparable.",
    ]


def _lead(track: str, ordered: Sequence[Entry]) -> str:
    """Return who leads, and whether the gearboxes tell the second from it."""
    first, score = ordered[0], ordered[0].score(MEAN)
    said = f"{track}: {first.name} leads with a mean AUC of {score.value:.2f} ({score.low:.2f} to {score.high:.2f})"
    if len(ordered) < 2 or len(ordered[1].every) < len(first.every):
        return f"{said}."
    behind = paired(first, ordered[1], MEAN)
    telling = "" if behind.high < 0.0 else "; these gearboxes cannot tell the two apart"
    apart = minus(f"{behind.value:+.2f} ({behind.low:+.2f} to {behind.high:+.2f})")
    return f"{said}, {ordered[1].name} follows with {apart}{telling}."


def _holds_chance(entry: Entry, part: str) -> bool:
    found = area_interval(entry.sham[part], entry.gearboxes[part])
    return not (found.low > 0.5 or found.high < 0.5)


def _figure(ordered: Sequence[Entry]) -> str:
    """Return the means as a figure; nothing without matplotlib."""
    if missing_packages("matplotlib"):
        return ""
    whole = [entry for entry in ordered if len(entry.every) == len(ordered[0].every)]
    rows = [
        ScoreRow("detect", "AUC", "mean over the test parts", one.name, one.score(MEAN), 0.5, None) for one in whole
    ]
    return figure_grid([figure_block(png_bytes(score_figure(rows)), "Mean AUC with 95 % limits; dotted: chance.")])


def _table(ordered: Sequence[Entry], parts: Sequence[str]) -> list[str]:
    columns = [MEAN, *parts]
    leader = ordered[0]
    rows, apart = [], []
    for place, entry in enumerate(ordered, start=1):
        known = (*entry.every, *((MEAN,) if len(entry.every) == len(parts) else ()))
        shown = [interval_cell(entry.score(part)) if part in known else Cell("–") for part in columns]
        rows.append([Cell(f"{place}. {entry.name}", value=float(place)), *shown])
        pairs = [_behind(leader, entry, part) if part in known else Cell("–") for part in columns]
        apart.append([Cell(entry.name), *pairs])
    behind = f"Entry minus the first, {leader.name}, paired on the same resampled gearboxes."
    return [
        table(["Entry", *columns], rows, caption="AUC of every damage.", sortable=True),
        table(["Entry", *columns], apart[1:], caption=behind, sortable=True) if apart[1:] else "",
        paragraph("A difference whose limits exclude 0 is one that these gearboxes can tell."),
    ]


def _behind(leader: Entry, entry: Entry, part: str) -> Cell:
    if part not in (MEAN, *leader.every):
        return Cell("–")
    return interval_cell(paired(leader, entry, part), sign=True)


def paired(first: Entry, second: Entry, part: str) -> Interval:
    """Return the second minus the first, on the same resampled gearboxes."""
    return interval(second.samples(part) - first.samples(part), first.count(part))


def _numbers(ordered: Sequence[Entry], benchmark: Benchmark) -> list[dict[str, Any]]:
    """Return the numbers of a track; the mean only of entries that have all parts."""
    return [
        {
            "name": entry.name,
            "beside_a_healthy_record": entry.referenced,
            "auc": {part: entry.score(part).numbers() for part in _parts(entry, benchmark)},
            "sham": {part: area_interval(one, entry.gearboxes[part]).numbers() for part, one in entry.sham.items()},
            "minus_first": {
                part: paired(ordered[0], entry, part).numbers()
                for part in _parts(entry, benchmark)
                if part in _parts(ordered[0], benchmark)
            },
        }
        for entry in ordered
    ]


def _parts(entry: Entry, benchmark: Benchmark) -> tuple[str, ...]:
    return (*((MEAN,) if len(entry.every) == len(benchmark.parts) else ()), *entry.every)
