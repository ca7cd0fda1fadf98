"""Who stands where on a benchmark: what its baselines predict, and the page of all entries.

Baselines are what anybody's detector is compared with, each learned on the part to learn from alone. The stack weighs
others by logistic regression on what they say of gearboxes that they have not seen (nested folds); so nothing is chosen
on a test part. Source: stacked generalisation (Wolpert 1992), standard literature. Everything comes from the one table
of each set. What depends on a set, such as levels of convolutions, depends on the records to learn from alone: a test
record is judged by itself, whatever stands beside it. Baselines of lives count hours by what wears as much in the part
to learn from: the load of every part and the exponent of torque are published.

The page has every file of predictions in a folder, beside the baselines. Entries are ordered by the mean over the test
parts of the score that ranks, the best first. Differences are paired on the same resampled gearboxes, and stand beside
the leader of each table. Gearboxes of different parts are independent, so the mean over parts is taken resample by
resample.

A board counts every entry that was ever judged in its folder, also one whose file is gone: its numbers hold a log, each
line with the hash of all lines before it. Whoever noted a hash sees whether a later board goes on from there; that its
keeper begins anew in an empty folder nothing prevents.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import partial
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np
import pyarrow as pa
from pyarrow import parquet

from diagnostics.audit.averaged_lines import band_bank, kurtogram_maximum, line_array
from diagnostics.audit.detectability import ADDED, LEVELS, PLAIN
from diagnostics.audit.signal_detectors import convolution_features, level_waves, over_channels
from diagnostics.base.beside import beside
from diagnostics.base.extras import missing_packages, require_packages
from diagnostics.base.process_pool import process_pool
from diagnostics.base.seeding import Purpose, generator
from diagnostics.base.single_thread import single_thread
from diagnostics.bench.question import (
    LIFE_CONDITIONS,
    LIFE_QUESTION,
    TEMPLATES,
    Question,
    is_alone,
    parts_of,
    question_of,
)
from diagnostics.indicators.classifier_table import check_table, classifier_table, feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.table import record_table
from diagnostics.judging.alarms import PRETRAINED
from diagnostics.judging.evaluation import Design, Entry, pooled_scores
from diagnostics.judging.learners import BestColumn, Odds
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
from diagnostics.page.sentences import Sentences
from diagnostics.page.style import png_bytes
from diagnostics.page.tables import cell
from diagnostics.page.template import write_page
from diagnostics.page.wording import capitalised
from diagnostics.records.state_classes import HEALTHY, SHAM
from diagnostics.scoring.benchmark import BASELINES, Benchmark, labels_of, open_benchmark
from diagnostics.scoring.benchmark_scores import JudgedPart, judged_parts, part_columns
from diagnostics.scoring.detect import DAMAGE
from diagnostics.scoring.prediction_file import CLASSIFIER, IDENTITY_KEY, PREDICTIONS_FILE, RECORD, prediction_table
from diagnostics.scoring.remaining_life import COLUMNS
from diagnostics.scoring.score_rows import ScoreRow, score_figure
from diagnostics.signal.innovations import residual_lines
from diagnostics.statistics.evaluation import RESAMPLES, Interval, area_interval, bootstrap_weights, interval
from diagnostics.training.average_rows import AveragedRecords, padded_lines
from diagnostics.training.feature_classifier import DEFAULT_STRENGTH
from diagnostics.training.gear_rows import GearLines
from diagnostics.training.gear_rows import joined as joined_lines
from diagnostics.training.lives import Inspections, blind_inspections, inspections_of, predictors
from diagnostics.training.referenced import log_values
from diagnostics.training.splits import SpecimenSplit
from siggen.errors import DatasetError, UsageError
from siggen.file_writing import write_file
from siggen.plain_json import json_text

CHUNK = 400
"""Records whose bands are taken at once."""


@dataclass(frozen=True, slots=True)
class BenchRecords:
    """Records of all sets, those to learn from first.

    Attributes
    ----------
    matrix : FeatureMatrix
        Indicators with labels.
    lines : (records, channels, orders) complex128
        Averaged lines, of the orders that those to learn from have.
    reference : (records,) int
        Row of the first healthy record of the gearbox at its operating point, -1 for itself.
    asked : (records,) bool
        Records to learn from, and those of the split test of test parts.
    alone : (records,) bool
        Records to learn from, and those of test parts of which a gearbox has one record.
    learn : int
        How many records are to learn from.
    channels : tuple of str
    teeth : str
        Label of the teeth of the shaft that was averaged.
    gears : GearLines, optional
        Averages of both gears; None where the network of many gearboxes does not know such sets.
    """

    matrix: FeatureMatrix
    lines: np.ndarray
    reference: np.ndarray
    asked: np.ndarray
    alone: np.ndarray
    learn: int
    channels: tuple[str, ...]
    teeth: str
    gears: GearLines | None


@dataclass(frozen=True, slots=True)
class SeenRecords:
    """Records to learn from, then those of the test parts.

    Attributes
    ----------
    matrix : FeatureMatrix
        Indicators; beside a reference the differences of their logarithms.
    learn : int
        How many records are to learn from.
    damaged : (learn,) bool
    kurtogram : (records,) float64
        Largest kurtosis of the envelope over all bands.
    bands : (records, columns) float64
    convolutions : (records, columns) float64
    averages : AveragedRecords
    heads : (records, numbers) float64, optional
        What the network of many gearboxes says.
    referenced : bool
    """

    matrix: FeatureMatrix
    learn: int
    damaged: np.ndarray
    kurtogram: np.ndarray
    bands: np.ndarray
    convolutions: np.ndarray
    averages: AveragedRecords
    heads: np.ndarray | None
    referenced: bool

    @property
    def gearbox(self) -> np.ndarray:
        """(learn,) int: gearboxes of the records to learn from."""
        return np.asarray(self.matrix.groups[: self.learn])

    def tests(self) -> np.ndarray:
        """Return the numbers of the test records."""
        return np.asarray(self.matrix.labels["record_id"][self.learn :])


def benchmark_records(benchmark: Benchmark, workers: int) -> BenchRecords:
    """Return the records of all sets of a benchmark; indicators from some processes."""
    learn = benchmark.learn()
    first = record_table(learn, workers=workers)
    check_table(first, learn)  # test records are answered whatever they are
    tables = [first, *(record_table(benchmark.part(name), workers=workers) for name in benchmark.parts)]
    matrices = [feature_matrix(classifier_table(table)) for table in tables]
    labels = {name: np.concatenate([part.labels[name] for part in matrices]) for name in matrices[0].labels}
    matrix = replace(matrices[0], values=np.concatenate([part.values for part in matrices]), labels=labels)
    waveforms = [row for table in tables for row in table.complex_rows("waveform")]
    count = len(matrices[0].values)
    orders = max(lines.size for row in waveforms[:count] for lines in row)
    asked = (np.arange(len(matrix.values)) < count) | (labels["split"] == "test")
    lines = line_array(waveforms)[..., : max(orders, 1)]
    ways = [True, *map(is_alone, benchmark.parts)]
    alone = np.repeat(ways, [len(part.values) for part in matrices])
    named, gears = (first.channels, first.teeth[0]), _gear_averages(benchmark, workers)
    return BenchRecords(matrix, lines, _references(labels), asked, alone, count, *named, gears)


def _gear_averages(benchmark: Benchmark, workers: int) -> GearLines | None:
    from diagnostics.training.shipped_network import gear_averages, knows

    sets = [benchmark.learn(), *map(benchmark.part, benchmark.parts)]
    return joined_lines([gear_averages(one, workers) for one in sets]) if all(map(knows, sets)) else None


def _references(labels: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return the row of the first healthy record of each one's gearbox and operating point; -1 for itself."""
    first: dict[tuple[int, int], int] = {}
    places = list(zip(labels["specimen_id"].tolist(), labels["operating_point_id"].tolist(), strict=True))
    for row in np.flatnonzero((labels["fault"] == HEALTHY) & (labels["state"] != SHAM)).tolist():
        first.setdefault(places[row], row)
    rows = np.array([first.get(place, -1) for place in places], dtype=np.int64)
    return np.where(rows == np.arange(rows.size), -1, rows)


def seen_records(records: BenchRecords, *, referenced: bool) -> SeenRecords:
    """Return what baselines see; records without a reference are left out if asked for.

    Parameters
    ----------
    records : BenchRecords
    referenced : bool
        Whether every record stands beside a healthy one of its gearbox.
    """
    kept = np.flatnonzero(records.asked & (records.reference >= 0 if referenced else records.alone))
    matrix, lines = records.matrix.rows(kept), records.lines[kept]
    teeth, learn = matrix.labels[records.teeth], int((kept < records.learn).sum())
    difference, known, beside = residual_lines(lines, teeth), None, None
    if referenced:
        reference = records.reference[kept]
        logarithms = log_values(records.matrix.values)
        matrix = replace(matrix, values=logarithms[kept] - logarithms[reference])
        known = residual_lines(records.lines[reference], teeth)
        difference, beside = difference - known, _as_averages(records.lines[reference])
    highest, bands = _in_chunks(difference, known)
    return SeenRecords(
        matrix=matrix,
        learn=learn,
        damaged=np.asarray(matrix.labels["fault"][:learn] != HEALTHY),
        kurtogram=highest,
        bands=bands,
        convolutions=convolution_features(level_waves(difference, known), learn),
        averages=AveragedRecords(_as_averages(lines), teeth, records.channels, beside),
        heads=_heads(records, kept, referenced=referenced),
        referenced=referenced,
    )


def _heads(records: BenchRecords, kept: np.ndarray, *, referenced: bool) -> np.ndarray | None:
    if records.gears is None:
        return None
    from diagnostics.training.shipped_network import heads

    own = records.gears.chosen(kept)
    return heads(own, records.gears, records.reference[kept, None]) if referenced else heads(own)


def _as_averages(lines: np.ndarray) -> np.ndarray:
    return padded_lines([list(row) for row in lines.astype(np.complex64)])


def _in_chunks(difference: np.ndarray, known: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
    """Return the kurtogram and the columns of all bands, a few hundred records at once: each asks for megabytes."""
    highest, bands = [], []
    for start in range(0, len(difference), CHUNK):
        rows = slice(start, start + CHUNK)
        highest.append(np.nanmean(kurtogram_maximum(difference[rows]), axis=1))
        bands.append(over_channels(*band_bank(difference[rows], None if known is None else known[rows]))[0])
    return np.concatenate(highest), np.concatenate(bands)


REFERENCE = "reference"
BESIDE = ", beside a healthy record"
TRACKS = (False, True)
"""Alone, and beside a reference."""
FOLDS, LEFT_OUT = 4, 5
CHANCE_OWNER = 4242
"""Owner of the generator of the baseline without knowledge: permutations have others."""
CHANCE, RMS, KURTOGRAM, SIX, BAND = "chance", "RMS alone", "kurtogram", "six columns", "best band"
BOOSTING, CONVOLUTIONS, NETWORK, STACK = "gradient boosting", "random convolutions", "1-D network", "stack"
STACKED = (KURTOGRAM, BAND, BOOSTING, CONVOLUTIONS, NETWORK)


class AsItIs:
    """A number that nothing is learnt for."""

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> AsItIs:  # noqa: ARG002
        """Learn nothing."""
        return self

    def score(self, X: np.ndarray) -> np.ndarray:
        """Return the number."""
        return X


class StoppedNetwork:
    """The 1-D network; every fifth gearbox says when to stop. X are places of records; scores are log odds."""

    def __init__(self, records: AveragedRecords, stops: np.ndarray, seed: int) -> None:
        self.records, self.stops, self.seed = records, stops, seed

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> StoppedNetwork:  # noqa: ARG002
        """Train."""
        from diagnostics.training.cnn import train_network

        stops = self.stops[X]
        learn, chooses, nobody = (np.zeros(len(self.records.teeth), dtype=bool) for _ in range(3))
        learn[X[~stops]], chooses[X[stops]] = True, True
        target = np.zeros(learn.size, dtype=np.int64)
        target[X] = y
        split = SpecimenSplit(learn, chooses, nobody, ("healthy", "damaged"))
        self.network = train_network(self.records, target, split, self.seed).network
        return self

    def score(self, X: np.ndarray) -> np.ndarray:
        """Return the logarithm of the odds."""
        from diagnostics.training.cnn import network_probability

        probability = np.clip(network_probability(self.network, self.records.chosen(X))[:, 1], 1e-12, 1.0 - 1e-12)
        return np.asarray(np.log(probability) - np.log1p(-probability))


def entries(seen: SeenRecords, seed: int) -> list[Entry]:
    """Return the baselines without the stack; the network only with PyTorch."""
    from sklearn.linear_model import RidgeClassifierCV
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    from diagnostics.training.classifiers import DEFAULT_TREES, BoostingBaseline, LogisticBaseline

    every = np.ones(len(seen.kurtogram), dtype=bool)
    gearbox = np.unique(seen.gearbox, return_inverse=True)[1]
    stops = gearbox % LEFT_OUT == LEFT_OUT - 1

    def logistic() -> Odds:
        return Odds(LogisticBaseline((DEFAULT_STRENGTH,), take_logarithms=not seen.referenced))

    def ridge() -> Odds:
        """Return ridge regression whose penalty is chosen by leaving one record out, as MiniRocket does."""
        model = RidgeClassifierCV(np.logspace(-1, 5, 10), class_weight="balanced")
        return Odds(make_pipeline(StandardScaler(), model))

    def named(*indicators: str) -> np.ndarray:
        """Return the values of some indicators, of every channel."""
        names = seen.matrix.names
        return seen.matrix.values[:, [k for k, name in enumerate(names) if name.partition("__")[0] in indicators]]

    bands, convolutions = (np.where(np.isfinite(x), x, 0.0) for x in (seen.bands, seen.convolutions))
    lots = generator(seed, Purpose.PERMUTATION, CHANCE_OWNER).uniform(size=every.size)
    baselines = [
        Entry(CHANCE, AsItIs, lots, every),
        Entry(RMS, logistic, named("rms"), every),
        Entry(KURTOGRAM, AsItIs, seen.kurtogram, every),
        Entry(SIX, logistic, named(*LEVELS, *PLAIN, *ADDED), every),
        Entry(BAND, partial(BestColumn, [str(k) for k in range(bands.shape[1])]), bands, every),
        Entry(BOOSTING, lambda: Odds(BoostingBaseline(seed, DEFAULT_TREES)), seen.matrix.values, every),
        Entry(CONVOLUTIONS, ridge, convolutions, every),
        Entry(NETWORK, partial(StoppedNetwork, seen.averages, stops, seed), np.arange(every.size), every),
    ]
    if missing_packages("torch", "safetensors"):
        return [baseline for baseline in baselines if baseline.name != NETWORK]
    if seen.heads is not None:
        baselines.append(Entry(PRETRAINED, AsItIs, seen.heads[:, 0], every))
    return baselines


def stacked(seen: SeenRecords, known: Sequence[Entry], every: Mapping[str, np.ndarray], seed: int) -> np.ndarray:
    """Return the scores of the stack.

    Parameters
    ----------
    seen : SeenRecords
    known : sequence of Entry
        Those to be weighed.
    every : mapping of str to (records,) float64
        Their scores after learning from all records to learn from.
    seed : int
        Deals gearboxes into folds.
    """
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    fold = Design(FOLDS, CHANCE_OWNER).dealt(seen.gearbox, seed)[0]
    learning = (replace(entry, X=entry.X[: seen.learn]) for entry in known)
    unseen = np.stack([pooled_scores(entry, seen.damaged, seen.gearbox, fold)[0] for entry in learning], axis=1)
    model = make_pipeline(StandardScaler(), LogisticRegression(class_weight="balanced", max_iter=1000))
    model.fit(unseen, seen.damaged)
    return np.asarray(model.decision_function(np.stack([every[entry.name] for entry in known], axis=1)))


def damage_predictions(benchmark: Benchmark, seed: int, workers: int) -> Iterator[pa.Table]:
    """Yield the rows of every baseline, alone and beside a healthy record; with two processes both at once."""
    records = benchmark_records(benchmark, workers)
    if workers == 1:
        for referenced in TRACKS:
            yield from _track(records, seed, referenced)
        return
    with process_pool(len(TRACKS)) as pool:
        for tables in pool.map(partial(_track, records, seed), TRACKS):
            yield from tables


@single_thread()
def _track(records: BenchRecords, seed: int, referenced: bool) -> list[pa.Table]:
    seen = seen_records(records, referenced=referenced)
    if not seen.tests().size or np.unique(seen.damaged).size < 2:
        return []
    known, scores = entries(seen, seed), {}
    for entry in known:
        scores[entry.name] = entry.make().fit(entry.X[: seen.learn], seen.damaged, seen.gearbox).score(entry.X)
    scores[STACK] = stacked(seen, [entry for entry in known if entry.name in STACKED], scores, seed)
    tests, beside = seen.tests(), BESIDE if referenced else ""
    return [_rows(f"{name}{beside}", tests, score[seen.learn :], referenced) for name, score in scores.items()]


def _rows(name: str, records: np.ndarray, damage: np.ndarray, referenced: bool) -> pa.Table:
    count = records.size
    return pa.table(
        {
            CLASSIFIER: [name] * count,
            REFERENCE: [referenced] * count,
            RECORD: pa.array(records, pa.int64()),
            DAMAGE: np.asarray(damage, dtype=np.float64),
        }
    )


def life_predictions(benchmark: Benchmark, seed: int, workers: int) -> Iterator[pa.Table]:
    """Yield the rows of every baseline.

    Raises
    ------
    DatasetError
        If fewer than four gearboxes of the part to learn from failed.
    """
    parts = {name: benchmark.part(name) for name in benchmark.parts}
    learn = inspections_of(benchmark.learn(), record_table(benchmark.learn(), workers=workers))
    tests = [blind_inspections(part, record_table(part, workers=workers)) for part in parts.values()]
    inspections = joined([learn, *tests])
    paces = [pace(benchmark.learn().config, LIFE_CONDITIONS.get(name, {})) for name in parts]
    hour = np.repeat([1.0, *paces], [of_set.specimen.size for of_set in (learn, *tests)])
    inspections = replace(inspections, age_h=inspections.age_h * hour)
    known = np.arange(inspections.specimen.size) < learn.specimen.size
    asked = ~known & (inspections.split == "test")
    for name, predict in predictors(inspections, seed).items():
        hours = np.maximum(predict(known, asked) / hour[asked, None], 0.0)  # lives are never below 0
        record = pa.array(inspections.record_id[asked], pa.int64())
        yield pa.table({CLASSIFIER: [name] * len(record), RECORD: record, **dict(zip(COLUMNS, hours.T, strict=True))})


TORQUE_EXPONENT = 6.55
"""With which lives fall with the torque: gearboxes draw theirs (`siggen.life.pitting`), this is the middle."""


def pace(config: Mapping[str, Any], changes: Mapping[str, Any]) -> float:
    """Return how many hours of a configuration of lives wear as much as one with some changes; speeds are alike.

    It is 1 where the configuration gives its load in N m: that of the test part is relative.
    """
    life = config["life"]
    histories = [load or [[1.0, 1.0]] for load in ({**life, **changes.get("life", {})}["history"], life["history"])]
    if any(len(block) > 2 for load in histories for block in load):
        return 1.0
    wear, usual = (sum(h * ratio**TORQUE_EXPONENT for h, ratio in load) / sum(h for h, _ in load) for load in histories)
    return float(wear / usual)


def joined(parts: Sequence[Inspections]) -> Inspections:
    """Return the inspections of several sets, no two of which share a number of a gearbox; without averages."""
    arrays = {
        field.name: np.concatenate([getattr(part, field.name) for part in parts])
        for field in fields(Inspections)
        if field.name not in ("indicators", "averages")
    }
    indicators = {name: np.concatenate([part.indicators[name] for part in parts]) for name in parts[0].indicators}
    return replace(parts[0], **arrays, indicators=indicators, averages=None)


@single_thread()
def benchmark_baselines(folder: str | Path, seed: int = 0, workers: int = 1) -> Path:
    """Learn the baselines, write what they say of all test parts, and return the file."""
    require_packages("baselines", "sklearn")
    benchmark = open_benchmark(folder)
    predictions = life_predictions if question_of(benchmark.learn().config) is LIFE_QUESTION else damage_predictions
    rows = list(predictions(benchmark, seed, workers))
    table = pa.concat_tables(rows).replace_schema_metadata({IDENTITY_KEY: benchmark.digest.encode()})
    path = benchmark.path / BASELINES / PREDICTIONS_FILE
    write_file(path, lambda draft: parquet.write_table(table, draft, compression="zstd"))
    return path


BOARD, NUMBERS = "leaderboard.html", "leaderboard.json"
MEAN = "mean"
BLIND_ANSWERS, LEVEL = 200, 0.95
"""Answers without knowledge whose scatter is taken, known to 5 %, and the level of the limit of the best."""
SUFFIXES = (".parquet", ".csv")
BOARD_WORDS = Sentences(TEMPLATES / "board.txt", mean=MEAN)


@dataclass(frozen=True, slots=True)
class BoardEntry:
    """Samples of the score of one entry by part: the value itself, then those of resampled gearboxes; and of the leak.

    By part too, `gearboxes` is the number that limits count, `chance` what an answer without knowledge reaches.
    `answers` is the SHA-256 of what it says of all parts.
    """

    name: str
    referenced: bool
    question: Question
    every: Mapping[str, np.ndarray]
    leak: Mapping[str, np.ndarray]
    gearboxes: Mapping[str, int]
    chance: Mapping[str, float]
    answers: str

    def samples(self, part: str) -> np.ndarray:
        """Return the samples of a part; of their mean only where no part is missing."""
        return np.mean([*self.every.values()], axis=0) if part == MEAN else self.every[part]

    def score(self, part: str) -> Interval:
        """Return the score of a part with its limits."""
        limits = area_interval if self.question.measure.is_share else interval
        return limits(self.samples(part), self.count(part))

    def count(self, part: str) -> int:
        """Return the gearboxes that limits count; those of all parts for their mean, since no two parts share one."""
        return sum(self.gearboxes[name] for name in self.every) if part == MEAN else self.gearboxes[part]


def leaderboard(
    folder: str | Path,
    entries: str | Path | None = None,
    *,
    out: str | Path | None = None,
    labels: str | Path | None = None,
    seed: int = 0,
) -> Path:
    """Write leaderboard.html: all entries and baselines, with limits and paired differences.

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
    question, spread = question_of(benchmark.learn().config), {}
    for side in question.tracks:
        names = parts_of(benchmark.parts, referenced=side)
        spread[side] = chance_spread(question, [part for part in parts if part.name in names], seed)
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
    baselines = benchmark.path / BASELINES / PREDICTIONS_FILE
    others = [file for file in files if file.resolve() != baselines.resolve()]
    files = [*([baselines] if baselines.is_file() else []), *others]
    if not files:
        raise UsageError(
            f"{folder or benchmark.path}: holds no predictions ({', '.join(SUFFIXES)}); `diagnostics."
            "benchmark_baselines` writes those of the baselines"
        )
    question = question_of(benchmark.learn().config)
    weights = {part.name: bootstrap_weights(part.truth.specimen, seed, RESAMPLES) for part in parts}
    board: dict[str, BoardEntry] = {}
    for file in files:
        read = prediction_table(file)
        columns = part_columns(benchmark, parts, read, file, file.stem)
        for name in dict.fromkeys(name for by_name in columns.values() for name in by_name):
            if name in board:
                raise UsageError(f"{file}: a second entry {name!r}; give each a name of its own (column {CLASSIFIER})")
            referenced = True in question.tracks and _is_referenced(read, name)
            names = parts_of(benchmark.parts, referenced=referenced)
            answers = {part: by_name[name] for part, by_name in columns.items() if name in by_name and part in names}
            board[name] = _entry(name, question, referenced, answers, parts, weights)
    return list(board.values())


def chance_spread(question: Question, parts: Sequence[JudgedPart], seed: int) -> float:
    """Return the standard deviation of the mean score of answers without knowledge; NaN of errors in hours.

    Parameters
    ----------
    question : Question
    parts : sequence of JudgedPart
    seed : int
        Of the answers.
    """
    if not question.measure.is_share:
        return math.nan
    means = np.zeros(BLIND_ANSWERS)
    for place, part in enumerate(parts):
        rng = generator(seed, Purpose.PERMUTATION, CHANCE_OWNER, place)
        asked = question.task.parts(part.truth)[question.records]
        truth, once = part.truth.rows(asked), np.ones((1, int(asked.sum())))
        scores = [question.measure.samples(rng.uniform(size=once.size), truth, once)[0] for _ in means]
        means += np.array(scores) / len(parts)
    return float(np.std(means, ddof=1))


def best_by_chance(entries: int, spread: float) -> float:
    """Return the AUC that the best of so many entries without knowledge exceeds in 5 % of the cases.

    Means over parts are normal for the purpose; entries are independent, which leaves the limit on the safe side for
    those that resemble each other. Source: maximum of independent numbers, standard literature.
    """
    return 0.5 + spread * NormalDist().inv_cdf(LEVEL ** (1.0 / entries))


def _is_referenced(read: pa.Table, name: str) -> bool:
    if REFERENCE not in read.column_names:
        return False
    said = read.column(REFERENCE).to_pylist()
    whose = read.column(CLASSIFIER).to_pylist() if CLASSIFIER in read.column_names else [name] * len(said)
    return any(bool(used) for used, entry in zip(said, whose, strict=True) if str(entry) == name)


def _entry(
    name: str,
    question: Question,
    referenced: bool,
    answers: Mapping[str, Any],
    parts: Sequence[JudgedPart],
    weights: Mapping[str, np.ndarray],
) -> BoardEntry:
    task, measure = question.task, question.measure
    by_records: dict[str | None, dict[str, np.ndarray]] = {question.records: {}, question.leak: {}}
    for part in parts:
        said = task.answers(answers[part.name], part.truth) if part.name in answers else None
        asked = task.parts(part.truth) if said is not None else {}
        for what, samples in by_records.items():
            if what in asked and said is not None:
                rows, drawn = part.truth.rows(asked[what]), weights[part.name][:, asked[what]]
                samples[part.name] = measure.samples(said[asked[what]], rows, drawn)
    counts = {part.name: measure.gearboxes(part.truth) for part in parts}
    chance = {part.name: measure.chance(part.truth) for part in parts}
    digest = hashlib.sha256()
    for of_part, columns in sorted(answers.items()):
        for column, values in sorted(columns.items()):
            digest.update(f"/{of_part}/{column}/".encode() + values.tobytes())
    scores = by_records[question.records], by_records[question.leak], counts, chance
    return BoardEntry(name, referenced, question, *scores, digest.hexdigest())


LOG, CHAIN = "log", "chain"
SIDE = "beside_a_healthy_record"


def entry_log(file: Path, digest: str, entries: Sequence[BoardEntry]) -> list[dict[str, Any]]:
    """Return the log of a board, from its file of numbers, with the entries that it does not hold yet.

    Parameters
    ----------
    file : Path
        Numbers of the board, which need not be there.
    digest : str
        Of the benchmark: what the first line hashes.
    entries : sequence of BoardEntry

    Raises
    ------
    DatasetError
        If a line is not the one that was written.
    """
    log, chain = [], digest
    for number, line in enumerate(_kept_log(file)):
        chain = _chained(chain, line)
        if line.get(CHAIN) != chain:
            raise DatasetError(
                f"{file}: line {number + 1} of its log is not what was written there, or of another benchmark; lay the "
                "file back, or name a new folder with out, where counting begins anew"
            )
        log.append(line)
    known = {(line[SIDE], line["answers"]) for line in log}
    for entry in entries:
        if (entry.referenced, entry.answers) not in known:
            line = {"name": entry.name, SIDE: entry.referenced, "answers": entry.answers}
            chain = _chained(chain, line)
            log.append({**line, CHAIN: chain})
    return log


def _kept_log(file: Path) -> list[dict[str, Any]]:
    """Return the lines of the log of a board's file; of a missing file or one without a log none."""
    if not file.is_file():
        return []
    try:
        kept = json.loads(file.read_text(encoding="utf-8"))
        lines = kept.get(LOG, [])
        if not isinstance(lines, list) or not all(isinstance(line, dict) for line in lines):
            raise TypeError("its log is no list of objects")
    except (ValueError, TypeError, AttributeError) as error:
        raise DatasetError(
            f"{file}: is no file of a board ({error}); lay the right one back, or name a new folder with out, where "
            "counting begins anew"
        ) from error
    return lines


def _chained(before: str, line: Mapping[str, Any]) -> str:
    said = json.dumps({name: value for name, value in line.items() if name != CHAIN}, sort_keys=True)
    return hashlib.sha256(f"{before}/{said}".encode()).hexdigest()


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
    question = question_of(benchmark.learn().config)
    tables = {side: _ordered(entries, parts_of(benchmark.parts, referenced=side), side) for side in question.tracks}
    numbers = [row for ordered in tables.values() for row in _numbers(ordered, benchmark)]
    log = entry_log(folder / NUMBERS, benchmark.digest, [entry for ordered in tables.values() for entry in ordered])
    counts = {side: sum(line[SIDE] == side for line in log) for side in tables}
    limits = {
        question.tracks[side]: {"entries": counts[side], "best_by_chance": best_by_chance(counts[side], spread[side])}
        for side, ordered in tables.items()
        if ordered and spread[side] > 0.0
    }
    facts = {
        "digest": benchmark.digest,
        "simulation_version": benchmark.simulation_version,
        "counted": limits,
        "entries": numbers,
        LOG: log,
    }
    write_file(folder / NUMBERS, json_text(facts))
    title = f"Leaderboard of {benchmark.title}, {benchmark.tier}"
    parts: list[Block] = [Heading(title, 1), *summary_blocks(_sentences(benchmark, tables, limits, log))]
    for referenced, ordered in tables.items():
        if ordered:
            parts += [
                Heading(question.tracks[referenced]),
                _figure(ordered),
                *_table(ordered, parts_of(benchmark.parts, referenced=referenced)),
            ]
    path = folder / BOARD
    write_page(path, Page(title, parts))
    return path


def _ordered(entries: Sequence[BoardEntry], parts: Sequence[str], referenced: bool) -> list[BoardEntry]:
    """Return the entries of a track, the best mean first; those that lack a part last."""
    track = [entry for entry in entries if entry.referenced == referenced and entry.every]
    return sorted(track, key=lambda entry: (len(entry.every) < len(parts), -_goodness(entry), entry.name))


def _goodness(entry: BoardEntry) -> float:
    """Return the mean score, of a score that falls with its sign turned: more is better."""
    return float(entry.samples(MEAN)[0]) * (-1.0 if entry.question.measure.falls else 1.0)


def _sentences(
    benchmark: Benchmark,
    tables: Mapping[bool, list[BoardEntry]],
    limits: Mapping[str, Mapping[str, Any]],
    log: Sequence[Mapping[str, Any]],
) -> list[str]:
    question = question_of(benchmark.learn().config)
    sham = [(entry, part) for ordered in tables.values() for entry in ordered for part in entry.leak]
    outside = [(entry, part) for entry, part in sham if not _holds_chance(entry, part)]
    sentences = [
        *(_lead(question.tracks[side], ordered) for side, ordered in tables.items() if ordered),
        *(
            BOARD_WORDS.by_chance(track, counted["entries"], counted["best_by_chance"])
            for track, counted in limits.items()
        ),
        BOARD_WORDS.sham(len(sham), outside) if question.leak else "",
        BOARD_WORDS.scores(question, benchmark),
        BOARD_WORDS.judged(log),
    ]
    return [sentence for sentence in sentences if sentence]


def _lead(track: str, ordered: Sequence[BoardEntry]) -> str:
    """Return who leads, and whether the gearboxes tell the second from it."""
    first, *others = ordered
    second = next((entry for entry in others[:1] if len(entry.every) == len(first.every)), None)
    return BOARD_WORDS.lead(track, first, second, paired(first, second, MEAN) if second else None)


def _holds_chance(entry: BoardEntry, part: str) -> bool:
    limits = area_interval(entry.leak[part], entry.gearboxes[part])
    return not (limits.low > 0.5 or limits.high < 0.5)


def _figure(ordered: Sequence[BoardEntry]) -> FigureGrid:
    """Return the means as a figure; empty without matplotlib."""
    if missing_packages("matplotlib"):
        return FigureGrid(())
    whole = [entry for entry in ordered if len(entry.every) == len(ordered[0].every)]
    task, measure = ordered[0].question.task.name, ordered[0].question.measure
    chance = float(np.mean(list(ordered[0].chance.values())))
    mean = "mean of the parts"
    rows = [ScoreRow(task, measure.name, mean, one.name, one.score(MEAN), chance, None, measure.falls) for one in whole]
    caption = f"Mean {ordered[0].question.score_name} with 95 % limits; dotted: chance."
    return FigureGrid([FigureBlock(png_bytes(score_figure(rows)), caption)])


def _table(ordered: Sequence[BoardEntry], parts: Sequence[str]) -> list[Block]:
    columns = [MEAN, *parts]
    leader = ordered[0]
    rows, apart = [], []
    for place, entry in enumerate(ordered, start=1):
        known = (*entry.every, *((MEAN,) if len(entry.every) == len(parts) else ()))
        shown = [cell(entry.score(part)) if part in known else Cell("–") for part in columns]
        rows.append([Cell(f"{place}. {entry.name}", value=float(place)), *shown])
        pairs = [_behind(leader, entry, part) if part in known else Cell("–") for part in columns]
        apart.append([Cell(entry.name), *pairs])
    behind = f"Entry minus the first, {leader.name}, paired on the same resampled gearboxes."
    return [
        TableBlock(["Entry", *columns], rows, caption=_caption(leader.question), sortable=True),
        TableBlock(["Entry", *columns], apart[1:], caption=behind, sortable=True),
        Paragraph("A difference whose limits exclude 0 is one that these gearboxes can tell."),
    ]


def _caption(question: Question) -> str:
    return f"{capitalised(question.measure.name)} of {question.records}."


def _behind(leader: BoardEntry, entry: BoardEntry, part: str) -> Cell:
    if part not in (MEAN, *leader.every):
        return Cell("–")
    return cell(paired(leader, entry, part), "+.2f")


def paired(first: BoardEntry, second: BoardEntry, part: str) -> Interval:
    """Return the second minus the first, on the same resampled gearboxes."""
    return interval(second.samples(part) - first.samples(part), first.count(part))


def _numbers(ordered: Sequence[BoardEntry], benchmark: Benchmark) -> list[dict[str, Any]]:
    """Return the numbers of a track; the mean only of entries that have all parts."""
    return [
        {
            "name": entry.name,
            SIDE: entry.referenced,
            entry.question.score_key: {part: entry.score(part) for part in _parts(entry, benchmark)},
            "sham": {part: area_interval(samples, entry.gearboxes[part]) for part, samples in entry.leak.items()},
            "minus_first": {
                part: paired(ordered[0], entry, part)
                for part in _parts(entry, benchmark)
                if part in _parts(ordered[0], benchmark)
            },
        }
        for entry in ordered
    ]


def _parts(entry: BoardEntry, benchmark: Benchmark) -> tuple[str, ...]:
    asked = parts_of(benchmark.parts, referenced=entry.referenced)
    return (*((MEAN,) if len(entry.every) == len(asked) else ()), *entry.every)
