"""A page that says who stands where on a benchmark: every file of predictions in a folder, beside the baselines.

Entries are ordered by the mean over the test parts of the score that ranks, the best first. Differences are paired on
the same resampled gearboxes, and stand beside the leader of each table. Gearboxes of different parts are independent,
so the mean over parts is taken resample by resample.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.base.beside import beside
from diagnostics.base.extras import missing_packages
from diagnostics.base.seeding import Purpose, generator
from diagnostics.bench.baselines import CHANCE_OWNER, REFERENCE
from diagnostics.bench.conditions import parts_of
from diagnostics.bench.question import Ranking
from diagnostics.bench.questions import question_of
from diagnostics.page.blocks import (
    Block,
    Cell,
    FigureBlock,
    FigureGrid,
    Heading,
    Page,
    Paragraph,
    TableBlock,
    summary_blocks,
)
from diagnostics.page.style import png_bytes
from diagnostics.page.tables import interval_cell
from diagnostics.page.template import write_page
from diagnostics.page.wording import capitalised, decimal, minus
from diagnostics.scoring.benchmark import BASELINES, Benchmark, labels_of, open_benchmark
from diagnostics.scoring.benchmark_scores import JudgedPart, judged_parts, part_columns
from diagnostics.scoring.prediction_file import CLASSIFIER, PREDICTIONS_FILE, prediction_table
from diagnostics.scoring.score_rows import ScoreRow, score_figure
from diagnostics.statistics.evaluation import RESAMPLES, Interval, area_interval, bootstrap_weights, interval
from siggen.errors import UsageError, counted
from siggen.file_writing import write_file
from siggen.plain_json import json_text

BOARD, NUMBERS = "leaderboard.html", "leaderboard.json"
MEAN = "mean"
BLIND_ANSWERS, LEVEL = 200, 0.95
"""Answers without knowledge whose scatter is taken, known to 5 %, and the level of the limit of the best."""
SUFFIXES = (".parquet", ".csv")


@dataclass(frozen=True, slots=True)
class BoardEntry:
    """Samples of the score of one entry by part: the value itself, then those of resampled gearboxes; and of the leak.

    By part too, `gearboxes` is the number that limits count, `chance` what an answer without knowledge reaches.
    """

    name: str
    referenced: bool
    ranking: Ranking
    every: Mapping[str, np.ndarray]
    leak: Mapping[str, np.ndarray]
    gearboxes: Mapping[str, int]
    chance: Mapping[str, float]

    def samples(self, part: str) -> np.ndarray:
        """Return the samples of a part; of their mean only where no part is missing."""
        return np.mean([*self.every.values()], axis=0) if part == MEAN else self.every[part]

    def score(self, part: str) -> Interval:
        """Return the score of a part with its limits."""
        limits = area_interval if self.ranking.measure.is_share else interval
        return limits(self.samples(part), self.count(part))

    def count(self, part: str) -> int:
        """Return the gearboxes that limits count; those of all parts for their mean, since no two parts share one."""
        return sum(self.gearboxes[one] for one in self.every) if part == MEAN else self.gearboxes[part]


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
    benchmark = open_benchmark(folder)
    parts = judged_parts(benchmark, labels_of(benchmark, Path(labels) if labels else None))
    judged = board_entries(benchmark, parts, Path(entries) if entries else None, seed)
    ranking, spread = ranking_of(benchmark), {}
    for side in ranking.tracks:
        names = parts_of(benchmark.parts, referenced=side)
        spread[side] = chance_spread(ranking, [one for one in parts if one.name in names], seed)
    return write_board(benchmark, judged, spread, Path(out) if out else beside(benchmark.path, "_board"))


def board_entries(
    benchmark: Benchmark, parts: Sequence[JudgedPart], folder: Path | None, seed: int
) -> list[BoardEntry]:
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
            f"{folder or benchmark.path}: holds no predictions ({', '.join(SUFFIXES)}); `diagnostics."
            "benchmark_baselines` writes those of the baselines"
        )
    ranking = ranking_of(benchmark)
    weights = {part.name: bootstrap_weights(part.truth.specimen, seed, RESAMPLES) for part in parts}
    found: dict[str, BoardEntry] = {}
    for file in files:
        read = prediction_table(file)
        columns = part_columns(benchmark, parts, read, file, file.stem)
        for name in dict.fromkeys(name for by_name in columns.values() for name in by_name):
            if name in found:
                raise UsageError(f"{file}: a second entry {name!r}; give each a name of its own (column {CLASSIFIER})")
            referenced = True in ranking.tracks and _is_referenced(read, name)
            names = parts_of(benchmark.parts, referenced=referenced)
            answers = {part: by_name[name] for part, by_name in columns.items() if name in by_name and part in names}
            found[name] = _entry(name, ranking, referenced, answers, parts, weights)
    return list(found.values())


def chance_spread(ranking: Ranking, parts: Sequence[JudgedPart], seed: int) -> float:
    """Return the standard deviation of the mean score of answers without knowledge; NaN of errors in hours.

    Parameters
    ----------
    ranking : Ranking
    parts : sequence of JudgedPart
    seed : int
        Of the answers.
    """
    if not ranking.measure.is_share:
        return math.nan
    means = np.zeros(BLIND_ANSWERS)
    for place, part in enumerate(parts):
        rng = generator(seed, Purpose.PERMUTATION, CHANCE_OWNER, place)
        asked = ranking.task.parts(part.truth)[ranking.records]
        truth, once = part.truth.rows(asked), np.ones((1, int(asked.sum())))
        own = [ranking.measure.samples(rng.uniform(size=once.size), truth, once)[0] for _ in means]
        means += np.array(own) / len(parts)
    return float(np.std(means, ddof=1))


def best_by_chance(entries: int, spread: float) -> float:
    """Return the AUC that the best of so many entries without knowledge exceeds in 5 % of the cases.

    Means over parts are normal for the purpose; entries are independent, which leaves the limit on the safe side for
    those that resemble each other. Source: maximum of independent numbers, standard literature.
    """
    return 0.5 + spread * NormalDist().inv_cdf(LEVEL ** (1.0 / entries))


def ranking_of(benchmark: Benchmark) -> Ranking:
    """Return by what the entries of a benchmark are ranked."""
    return question_of(benchmark.learn().config).ranking


def _is_referenced(read: pa.Table, name: str) -> bool:
    if REFERENCE not in read.column_names:
        return False
    said = read.column(REFERENCE).to_pylist()
    whose = read.column(CLASSIFIER).to_pylist() if CLASSIFIER in read.column_names else [name] * len(said)
    return any(bool(one) for one, own in zip(said, whose, strict=True) if str(own) == name)


def _entry(
    name: str,
    ranking: Ranking,
    referenced: bool,
    answers: Mapping[str, Any],
    parts: Sequence[JudgedPart],
    weights: Mapping[str, np.ndarray],
) -> BoardEntry:
    task, measure = ranking.task, ranking.measure
    found: dict[str | None, dict[str, np.ndarray]] = {ranking.records: {}, ranking.leak: {}}
    for part in parts:
        said = task.answers(answers[part.name], part.truth) if part.name in answers else None
        asked = task.parts(part.truth) if said is not None else {}
        for what, samples in found.items():
            if what in asked and said is not None:
                rows, drawn = part.truth.rows(asked[what]), weights[part.name][:, asked[what]]
                samples[part.name] = measure.samples(said[asked[what]], rows, drawn)
    counts = {part.name: measure.gearboxes(part.truth) for part in parts}
    chance = {part.name: measure.chance(part.truth) for part in parts}
    return BoardEntry(name, referenced, ranking, found[ranking.records], found[ranking.leak], counts, chance)


def write_board(
    benchmark: Benchmark, entries: Sequence[BoardEntry], spread: Mapping[bool, float], folder: Path
) -> Path:
    """Write the page, and its numbers beside it; return the page.

    Parameters
    ----------
    benchmark : Benchmark
    entries : sequence of BoardEntry
    spread : mapping of bool to float
        As of `chance_spread`, by track.
    folder : Path
    """
    ranking = ranking_of(benchmark)
    tables = {side: _ordered(entries, parts_of(benchmark.parts, referenced=side), side) for side in ranking.tracks}
    numbers = [row for ordered in tables.values() for row in _numbers(ordered, benchmark)]
    limits = {
        ranking.tracks[side]: {"entries": len(ordered), "best_by_chance": best_by_chance(len(ordered), spread[side])}
        for side, ordered in tables.items()
        if ordered and spread[side] > 0.0
    }
    facts = {
        "digest": benchmark.digest,
        "simulation_version": benchmark.simulation_version,
        "counted": limits,
        "entries": numbers,
    }
    write_file(folder / NUMBERS, json_text(facts))
    title = f"Leaderboard of {benchmark.title}, {benchmark.tier}"
    parts: list[Block] = [Heading(title, 1), *summary_blocks(_sentences(benchmark, tables, spread))]
    for referenced, ordered in tables.items():
        if ordered:
            parts += [
                Heading(ranking.tracks[referenced]),
                _figure(ordered),
                *_table(ordered, parts_of(benchmark.parts, referenced=referenced)),
            ]
    path = folder / BOARD
    write_page(path, Page(title, parts))
    return path


def _ordered(entries: Sequence[BoardEntry], parts: Sequence[str], referenced: bool) -> list[BoardEntry]:
    """Return the entries of a track, the best mean first; those that lack a part last."""
    own = [entry for entry in entries if entry.referenced == referenced and entry.every]
    return sorted(own, key=lambda one: (len(one.every) < len(parts), -_goodness(one), one.name))


def _goodness(entry: BoardEntry) -> float:
    """Return the mean score, of a score that falls with its sign turned: more is better."""
    return float(entry.samples(MEAN)[0]) * (-1.0 if entry.ranking.measure.falls else 1.0)


def _sentences(
    benchmark: Benchmark, tables: Mapping[bool, list[BoardEntry]], spread: Mapping[bool, float]
) -> list[str]:
    entries, ranking = [entry for ordered in tables.values() for entry in ordered], ranking_of(benchmark)
    return [
        *(_lead(ranking.tracks[referenced], ordered) for referenced, ordered in tables.items() if ordered),
        *(
            _count_sentence(ranking.tracks[side], len(own), spread[side])
            for side, own in tables.items()
            if own and spread[side] > 0.0
        ),
        *([_leak_sentence(entries)] if ranking.leak else []),
        f"Scores are {ranking.said}, with 95 % limits over gearboxes. Digest {benchmark.digest}, simulation version "
        f"{benchmark.simulation_version}: only scores with the same two are comparable.",
    ]


def _count_sentence(track: str, entries: int, spread: float) -> str:
    """Say what the best of all entries of a track reaches without knowledge."""
    return (
        f"{track}: {counted(entries, 'entry', 'entries')} counted, baselines among them. The best of so many without "
        f"knowledge exceeds a mean AUC of {decimal(best_by_chance(entries, spread))} in 5 % of the cases; a mean below "
        "shows nothing."
    )


def _leak_sentence(entries: Sequence[BoardEntry]) -> str:
    sham = [(part, entry) for entry in entries for part in entry.leak]
    outside = [f"{entry.name} on {part}" for part, entry in sham if not _holds_chance(entry, part)]
    told = f" Outside: {', '.join(outside[:5])}." if outside else ""
    return (
        f"A sham is damage without effect. In {len(sham) - len(outside)} of {len(sham)} cases the limits of its AUC "
        f"hold 0.5; about one in 20 is outside by chance.{told}"
    )


def _lead(track: str, ordered: Sequence[BoardEntry]) -> str:
    """Return who leads, and whether the gearboxes tell the second from it."""
    first, score = ordered[0], ordered[0].score(MEAN)
    measure = first.ranking.measure
    limits = f"{score.value:.2f} ({score.low:.2f} to {score.high:.2f})"
    said = f"{track}: {first.name} leads with a mean {first.ranking.name} of {limits}"
    if len(ordered) < 2 or len(ordered[1].every) < len(first.every):
        return f"{said}."
    behind = paired(first, ordered[1], MEAN)
    is_worse = behind.low > 0.0 if measure.falls else behind.high < 0.0
    telling = "" if is_worse else "; these gearboxes cannot tell the two apart"
    apart = minus(f"{behind.value:+.2f} ({behind.low:+.2f} to {behind.high:+.2f})")
    return f"{said}, {ordered[1].name} follows with {apart}{telling}."


def _holds_chance(entry: BoardEntry, part: str) -> bool:
    found = area_interval(entry.leak[part], entry.gearboxes[part])
    return not (found.low > 0.5 or found.high < 0.5)


def _figure(ordered: Sequence[BoardEntry]) -> FigureGrid:
    """Return the means as a figure; empty without matplotlib."""
    if missing_packages("matplotlib"):
        return FigureGrid(())
    whole = [entry for entry in ordered if len(entry.every) == len(ordered[0].every)]
    task, measure = ordered[0].ranking.task.name, ordered[0].ranking.measure
    chance = float(np.mean(list(ordered[0].chance.values())))
    mean = "mean of the parts"
    rows = [ScoreRow(task, measure.name, mean, one.name, one.score(MEAN), chance, None, measure.falls) for one in whole]
    caption = f"Mean {ordered[0].ranking.name} with 95 % limits; dotted: chance."
    return FigureGrid([FigureBlock(png_bytes(score_figure(rows)), caption)])


def _table(ordered: Sequence[BoardEntry], parts: Sequence[str]) -> list[Block]:
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
        TableBlock(["Entry", *columns], rows, caption=_caption(leader.ranking), sortable=True),
        TableBlock(["Entry", *columns], apart[1:], caption=behind, sortable=True),
        Paragraph("A difference whose limits exclude 0 is one that these gearboxes can tell."),
    ]


def _caption(ranking: Ranking) -> str:
    return f"{capitalised(ranking.measure.name)} of {ranking.records}."


def _behind(leader: BoardEntry, entry: BoardEntry, part: str) -> Cell:
    if part not in (MEAN, *leader.every):
        return Cell("–")
    return interval_cell(paired(leader, entry, part), sign=True)


def paired(first: BoardEntry, second: BoardEntry, part: str) -> Interval:
    """Return the second minus the first, on the same resampled gearboxes."""
    return interval(second.samples(part) - first.samples(part), first.count(part))


def _numbers(ordered: Sequence[BoardEntry], benchmark: Benchmark) -> list[dict[str, Any]]:
    """Return the numbers of a track; the mean only of entries that have all parts."""
    return [
        {
            "name": entry.name,
            "beside_a_healthy_record": entry.referenced,
            entry.ranking.key: {part: entry.score(part) for part in _parts(entry, benchmark)},
            "sham": {part: area_interval(one, entry.gearboxes[part]) for part, one in entry.leak.items()},
            "minus_first": {
                part: paired(ordered[0], entry, part)
                for part in _parts(entry, benchmark)
                if part in _parts(ordered[0], benchmark)
            },
        }
        for entry in ordered
    ]


def _parts(entry: BoardEntry, benchmark: Benchmark) -> tuple[str, ...]:
    own = parts_of(benchmark.parts, referenced=entry.referenced)
    return (*((MEAN,) if len(entry.every) == len(own) else ()), *entry.every)
