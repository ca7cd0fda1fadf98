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

from diagnostics.audit.averaged_lines import Bank, band_bank, kurtogram_maximum, line_array, residual_lines
from diagnostics.audit.detectability import ADDED, LEVELS, PLAIN
from diagnostics.audit.signal_attackers import convolution_features, level_waves, over_channels
from diagnostics.base.extras import missing_packages
from diagnostics.base.process_pool import process_pool
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.base.seeding import Purpose, generator
from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.classifier_table import check_table, classifier_table, feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.table import record_table
from diagnostics.judging.evaluation import Design, Entry, pooled_scores
from diagnostics.judging.learners import BestColumn, Odds
from diagnostics.records.state_classes import HEALTHY, SHAM
from diagnostics.scoring.benchmark import LEARN, Benchmark
from diagnostics.scoring.detect import DAMAGE
from diagnostics.scoring.prediction_file import CLASSIFIER, RECORD
from diagnostics.training.average_rows import AveragedRecords, padded_lines
from diagnostics.training.feature_classifier import DEFAULT_STRENGTH
from diagnostics.training.referenced import log_values
from diagnostics.training.splits import SpecimenSplit
from siggen.dataset.reading import Dataset

CHUNK = 400
"""Records whose bands are taken at once."""


@dataclass(frozen=True, slots=True)
class PartRecords:
    """Records of one set: indicators with labels, averaged lines, row of each one's reference or -1, label of teeth."""

    matrix: FeatureMatrix
    waveforms: list[list[np.ndarray]]
    reference: np.ndarray
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


def benchmark_records(benchmark: Benchmark, workers: int, stage: Stage) -> tuple[PartRecords, ...]:
    """Return the records of all sets, those to learn from first; indicators from some processes."""
    sets = [(LEARN, benchmark.learn()), *((name, benchmark.part(name)) for name in benchmark.parts)]
    return tuple(_part(name, dataset, workers, stage) for name, dataset in sets)


def _part(name: str, dataset: Dataset, workers: int, stage: Stage) -> PartRecords:
    with stage(f"indicators, {name}", dataset.inventory.rows) as advance:
        table = record_table(dataset, workers=workers, advance=advance)
    if name == LEARN:
        check_table(table, dataset)  # test records are answered whatever they are
    matrix = feature_matrix(classifier_table(table))
    return PartRecords(matrix, table.complex_rows("waveform"), _references(matrix), table.channels, table.teeth[0])


def _references(matrix: FeatureMatrix) -> np.ndarray:
    """Return the row of the first healthy record of each one's gearbox and operating point; -1 for itself."""
    labels = matrix.labels
    first: dict[tuple[int, int], int] = {}
    places = list(zip(labels["specimen_id"].tolist(), labels["operating_point_id"].tolist(), strict=True))
    for row in np.flatnonzero((labels["fault"] == HEALTHY) & (labels["state"] != SHAM)).tolist():
        first.setdefault(places[row], row)
    found = np.array([first.get(place, -1) for place in places], dtype=np.int64)
    return np.where(found == np.arange(found.size), -1, found)


def seen_records(parts: tuple[PartRecords, ...], *, referenced: bool) -> SeenRecords:
    """Return what baselines see; records without a reference are left out if asked for.

    Parameters
    ----------
    parts : tuple of PartRecords
        As of `benchmark_records`.
    referenced : bool
        Whether every record stands beside a healthy one of its gearbox.
    """
    kept = [_kept(part, place, referenced) for place, part in enumerate(parts)]
    learn = int(kept[0].sum())
    labels = {
        name: np.concatenate([part.matrix.labels[name][rows] for part, rows in zip(parts, kept, strict=True)])
        for name in parts[0].matrix.labels
    }
    values = [_values(part, referenced)[rows] for part, rows in zip(parts, kept, strict=True)]
    matrix = replace(parts[0].matrix, values=np.concatenate(values), labels=labels)
    lines, beside = _lines(parts, kept, referenced)
    teeth = labels[parts[0].teeth]
    residual = residual_lines(lines, teeth)
    known = None if beside is None else residual_lines(beside, teeth)
    difference = residual if known is None else residual - known
    averages = AveragedRecords(
        padded_lines([list(row) for row in lines.astype(np.complex64)]),
        teeth,
        parts[0].channels,
        None if beside is None else padded_lines([list(row) for row in beside.astype(np.complex64)]),
    )
    highest, bands = _in_chunks(difference, known)
    return SeenRecords(
        matrix=matrix,
        learn=learn,
        damaged=np.asarray(labels["fault"][:learn] != HEALTHY),
        kurtogram=highest,
        bands=bands,
        convolutions=convolution_features(level_waves(difference, known), learn),
        averages=averages,
        referenced=referenced,
    )


def _kept(part: PartRecords, place: int, referenced: bool) -> np.ndarray:
    """Return the records to learn from, or to be asked about: of test parts those of the split test."""
    asked = np.ones(part.reference.size, dtype=bool) if place == 0 else part.matrix.labels["split"] == "test"
    return np.asarray(asked & (part.reference >= 0) if referenced else asked)


def _values(part: PartRecords, referenced: bool) -> np.ndarray:
    values = part.matrix.values
    if not referenced:
        return values
    logarithms = log_values(values)
    return np.asarray(logarithms - logarithms[part.reference])


def _lines(
    parts: tuple[PartRecords, ...], kept: list[np.ndarray], referenced: bool
) -> tuple[np.ndarray, np.ndarray | None]:
    """Return averaged lines of all records and of their references, with the orders that those to learn from have."""
    every = [line_array(part.waveforms) for part in parts]
    orders = every[0].shape[-1]
    same = [_cut(one, orders) for one in every]
    lines = np.concatenate([one[rows] for one, rows in zip(same, kept, strict=True)])
    if not referenced:
        return lines, None
    beside = [one[part.reference[rows]] for one, part, rows in zip(same, parts, kept, strict=True)]
    return lines, np.concatenate(beside)


def _cut(lines: np.ndarray, orders: int) -> np.ndarray:
    missing = max(orders - lines.shape[-1], 0)
    return np.pad(lines[..., :orders], ((0, 0), (0, 0), (0, missing)))


def _in_chunks(difference: np.ndarray, known: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
    """Return the kurtogram and the columns of all bands, a few hundred records at once: each asks for megabytes."""
    highest, bands = [], []
    for start in range(0, len(difference), CHUNK):
        rows = slice(start, start + CHUNK)
        highest.append(np.nanmean(kurtogram_maximum(difference[rows]), axis=1))
        bank: Bank = band_bank(difference[rows], None if known is None else known[rows])
        bands.append(over_channels(bank)[0])
    return np.concatenate(highest), np.concatenate(bands)


def only(seen: SeenRecords, columns: tuple[str, ...]) -> FeatureMatrix:
    """Return the indicators whose names begin with some words, of every channel."""
    names = [name for name in seen.matrix.names if name.partition("__")[0] in columns]
    return replace(seen.matrix.columns(names))


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

    bands, convolutions = (np.where(np.isfinite(x), x, 0.0) for x in (seen.bands, seen.convolutions))
    lots = generator(seed, Purpose.PERMUTATION, CHANCE_OWNER).uniform(size=every.size)
    found = [
        Entry(CHANCE, AsItIs, lots, every),
        Entry(RMS, logistic, only(seen, ("rms",)).values, every),
        Entry(KURTOGRAM, AsItIs, seen.kurtogram, every),
        Entry(SIX, logistic, only(seen, (*LEVELS, *PLAIN, *ADDED)).values, every),
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


def damage_predictions(benchmark: Benchmark, seed: int, workers: int, stage: Stage) -> Iterator[pa.Table]:
    """Yield the rows of every baseline, alone and beside a healthy record; with two processes both at once."""
    parts = benchmark_records(benchmark, workers, stage)
    if workers == 1:
        for referenced in TRACKS:
            yield from _predictions(parts, seed, stage, referenced)
        return
    at_once = partial(_track, parts, seed)
    with (
        stage("baselines, tracks", len(TRACKS)) as advance,
        process_pool(len(TRACKS)) as pool,
    ):
        for tables in pool.map(at_once, TRACKS):
            yield from tables
            advance()


@single_thread()
def _track(parts: tuple[PartRecords, ...], seed: int, referenced: bool) -> list[pa.Table]:
    return list(_predictions(parts, seed, silent_stage, referenced))


def _predictions(parts: tuple[PartRecords, ...], seed: int, stage: Stage, referenced: bool) -> Iterator[pa.Table]:
    seen = seen_records(parts, referenced=referenced)
    if not seen.tests().size or np.unique(seen.damaged).size < 2:
        return
    known = entries(seen, seed)
    scores = {}
    with stage(f"baselines{BESIDE if referenced else ''}", len(known) + 1) as advance:
        for entry in known:
            learnt = entry.make().fit(entry.X[: seen.learn], seen.damaged, seen.gearbox)
            scores[entry.name] = learnt.score(entry.X)
            advance()
        scores[STACK] = stacked(seen, [entry for entry in known if entry.name in STACKED], scores, seed)
        advance()
    for name, score in scores.items():
        yield _rows(f"{name}{BESIDE if referenced else ''}", seen.tests(), score[seen.learn :], referenced)


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
