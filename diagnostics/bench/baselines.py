"""Baselines of a benchmark: what anybody's detector is compared with, each learned on the part to learn from alone.

The stack weighs others by logistic regression on what they say of gearboxes that they have not seen (nested folds); so
nothing is chosen on a test part. Source: stacked generalisation (Wolpert 1992), standard literature.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import pyarrow as pa

from diagnostics.audit.detectability import ADDED, LEVELS, PLAIN
from diagnostics.base.extras import missing_packages
from diagnostics.base.process_pool import process_pool
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.base.seeding import Purpose, generator
from diagnostics.base.single_thread import single_thread
from diagnostics.bench.seen_records import PartRecords, SeenRecords, benchmark_records, only, seen_records
from diagnostics.judging.evaluation import Design, Entry, pooled_scores
from diagnostics.judging.learners import BestColumn, Odds
from diagnostics.scoring.benchmark import Benchmark
from diagnostics.scoring.detect import DAMAGE
from diagnostics.scoring.prediction_file import CLASSIFIER, RECORD
from diagnostics.training.average_rows import AveragedRecords
from diagnostics.training.feature_classifier import DEFAULT_STRENGTH
from diagnostics.training.splits import SpecimenSplit

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


class RidgeOfRecords:
    """Ridge regression whose penalty is chosen by leaving one record out, as MiniRocket does."""

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> RidgeOfRecords:  # noqa: ARG002
        """Fit to X (n, columns)."""
        from sklearn.linear_model import RidgeClassifierCV
        from sklearn.pipeline import make_pipeline
        from sklearn.preprocessing import StandardScaler

        model = make_pipeline(StandardScaler(), RidgeClassifierCV(np.logspace(-1, 5, 10), class_weight="balanced"))
        self.model = model.fit(X, y)
        return self

    def score(self, X: np.ndarray) -> np.ndarray:
        """Return the distance from the plane between both classes."""
        return np.asarray(self.model.decision_function(X))


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
    from diagnostics.training.classifiers import DEFAULT_TREES, BoostingBaseline, LogisticBaseline

    every = np.ones(len(seen.kurtogram), dtype=bool)
    gearbox = np.unique(seen.gearbox, return_inverse=True)[1]
    stops = gearbox % LEFT_OUT == LEFT_OUT - 1

    def logistic() -> Odds:
        return Odds(LogisticBaseline((DEFAULT_STRENGTH,), take_logarithms=not seen.referenced))

    bands, convolutions = (np.where(np.isfinite(x), x, 0.0) for x in (seen.bands, seen.convolutions))
    lots = generator(seed, Purpose.PERMUTATION, CHANCE_OWNER).uniform(size=every.size)
    found = [
        Entry(CHANCE, AsItIs, lots, every),
        Entry(RMS, logistic, only(seen, ("rms",)).values, every),
        Entry(KURTOGRAM, AsItIs, seen.kurtogram, every),
        Entry(SIX, logistic, only(seen, (*LEVELS, *PLAIN, *ADDED)).values, every),
        Entry(BAND, partial(BestColumn, [str(k) for k in range(bands.shape[1])]), bands, every),
        Entry(BOOSTING, lambda: Odds(BoostingBaseline(seed, DEFAULT_TREES)), seen.matrix.values, every),
        Entry(CONVOLUTIONS, RidgeOfRecords, convolutions, every),
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
