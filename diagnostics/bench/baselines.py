"""Baselines of a benchmark: what anybody's detector is compared with, each learned on the part to learn from alone.

The stack weighs others by logistic regression on what they say of gearboxes that they have not seen (nested folds); so
nothing is chosen on a test part. Source: stacked generalisation (Wolpert 1992), standard literature.

Everything comes from the one table of each set. What depends on a set, such as levels of convolutions, depends on the
records to learn from alone: a test record is judged by itself, whatever stands beside it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pyarrow as pa

from diagnostics.audit.averaged_lines import band_bank, kurtogram_maximum, line_array, residual_lines
from diagnostics.audit.detectability import ADDED, LEVELS, PLAIN
from diagnostics.audit.signal_attackers import convolution_features, level_waves, over_channels
from diagnostics.base.extras import missing_packages
from diagnostics.base.process_pool import process_pool
from diagnostics.base.seeding import Purpose, generator
from diagnostics.base.single_thread import single_thread
from diagnostics.bench.conditions import is_alone
from diagnostics.indicators.classifier_table import check_table, classifier_table, feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.table import record_table
from diagnostics.judging.evaluation import Design, Entry, pooled_scores
from diagnostics.judging.learners import BestColumn, Odds
from diagnostics.records.state_classes import HEALTHY, SHAM
from diagnostics.scoring.benchmark import Benchmark
from diagnostics.scoring.detect import DAMAGE
from diagnostics.scoring.prediction_file import CLASSIFIER, RECORD
from diagnostics.training.average_rows import AveragedRecords, padded_lines
from diagnostics.training.feature_classifier import DEFAULT_STRENGTH
from diagnostics.training.referenced import log_values
from diagnostics.training.splits import SpecimenSplit

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
    """

    matrix: FeatureMatrix
    lines: np.ndarray
    reference: np.ndarray
    asked: np.ndarray
    alone: np.ndarray
    learn: int
    channels: tuple[str, ...]
    teeth: str


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
    referenced : bool
    """

    matrix: FeatureMatrix
    learn: int
    damaged: np.ndarray
    kurtogram: np.ndarray
    bands: np.ndarray
    convolutions: np.ndarray
    averages: AveragedRecords
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
    labels = {name: np.concatenate([one.labels[name] for one in matrices]) for name in matrices[0].labels}
    matrix = replace(matrices[0], values=np.concatenate([one.values for one in matrices]), labels=labels)
    waveforms = [row for table in tables for row in table.complex_rows("waveform")]
    count = len(matrices[0].values)
    orders = max(lines.size for row in waveforms[:count] for lines in row)
    asked = (np.arange(len(matrix.values)) < count) | (labels["split"] == "test")
    lines = line_array(waveforms)[..., : max(orders, 1)]
    ways = [True, *map(is_alone, benchmark.parts)]
    alone = np.repeat(ways, [len(one.values) for one in matrices])
    return BenchRecords(matrix, lines, _references(labels), asked, alone, count, first.channels, first.teeth[0])


def _references(labels: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return the row of the first healthy record of each one's gearbox and operating point; -1 for itself."""
    first: dict[tuple[int, int], int] = {}
    places = list(zip(labels["specimen_id"].tolist(), labels["operating_point_id"].tolist(), strict=True))
    for row in np.flatnonzero((labels["fault"] == HEALTHY) & (labels["state"] != SHAM)).tolist():
        first.setdefault(places[row], row)
    found = np.array([first.get(place, -1) for place in places], dtype=np.int64)
    return np.where(found == np.arange(found.size), -1, found)


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
        referenced=referenced,
    )


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
    found = [
        Entry(CHANCE, AsItIs, lots, every),
        Entry(RMS, logistic, named("rms"), every),
        Entry(KURTOGRAM, AsItIs, seen.kurtogram, every),
        Entry(SIX, logistic, named(*LEVELS, *PLAIN, *ADDED), every),
        Entry(BAND, partial(BestColumn, [str(k) for k in range(bands.shape[1])]), bands, every),
        Entry(BOOSTING, lambda: Odds(BoostingBaseline(seed, DEFAULT_TREES)), seen.matrix.values, every),
        Entry(CONVOLUTIONS, ridge, convolutions, every),
        Entry(NETWORK, partial(StoppedNetwork, seen.averages, stops, seed), np.arange(every.size), every),
    ]
    return found[:-1] if missing_packages("torch", "safetensors") else found


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
    own = (replace(entry, X=entry.X[: seen.learn]) for entry in known)
    unseen = np.stack([pooled_scores(entry, seen.damaged, seen.gearbox, fold)[0] for entry in own], axis=1)
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
