"""Baselines of a benchmark: what anybody's detector is compared with, each learned on the part to learn from alone.

One detector is a function: records, and which of those to learn from it may see, to a score of every record. The stack
weighs others by logistic regression on what they say of gearboxes that they have not seen (nested folds); so nothing
is chosen on a test part. Source: stacked generalisation (Wolpert 1992), standard literature.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
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
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.scoring.benchmark import Benchmark
from diagnostics.scoring.detect import DAMAGE
from diagnostics.scoring.prediction_file import CLASSIFIER, RECORD
from diagnostics.statistics.evaluation import column_auc
from diagnostics.training.detectors import Scorer, boosting_scorer, logistic_scorer
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

Detector = Callable[[SeenRecords, np.ndarray], np.ndarray]
"""Records, and which of those to learn from may be seen (learn,) bool; returns a score of every record (records,)."""


def detectors(seed: int) -> dict[str, Detector]:
    """Return the detectors without the stack; the network only with PyTorch."""
    found: dict[str, Detector] = {
        CHANCE: lambda seen, _: generator(seed, Purpose.PERMUTATION, CHANCE_OWNER).uniform(size=len(seen.kurtogram)),
        RMS: lambda seen, used: _scored(_logistic(seen), only(seen, ("rms",)), seen, used),
        KURTOGRAM: lambda seen, _: seen.kurtogram,
        SIX: lambda seen, used: _scored(_logistic(seen), only(seen, (*LEVELS, *PLAIN, *ADDED)), seen, used),
        BAND: _best_band,
        BOOSTING: lambda seen, used: _scored(_boosting(seed), seen.matrix, seen, used),
        CONVOLUTIONS: _ridge,
    }
    return found if missing_packages("torch") else {**found, NETWORK: lambda seen, used: _network(seen, used, seed)}


def _logistic(seen: SeenRecords) -> Scorer:
    return lambda matrix, damaged: logistic_scorer(matrix, damaged, take_logarithms=not seen.referenced)


def _boosting(seed: int) -> Scorer:
    return lambda matrix, damaged: boosting_scorer(matrix, damaged, seed=seed)


def _scored(scorer: Scorer, matrix: FeatureMatrix, seen: SeenRecords, used: np.ndarray) -> np.ndarray:
    own = np.zeros(len(matrix.values), dtype=bool)
    own[: seen.learn] = used
    return scorer(matrix.rows(own), seen.damaged[used])(matrix)


def _best_band(seen: SeenRecords, used: np.ndarray) -> np.ndarray:
    """Take the column of all bands, and its direction, that is best on the records to learn from."""
    values = np.where(np.isfinite(seen.bands), seen.bands, 0.0)
    area = column_auc(values[: seen.learn][used], seen.damaged[used])
    best = int(np.argmax(np.abs(area - 0.5)))
    return np.asarray(values[:, best] * (1.0 if area[best] >= 0.5 else -1.0))


def _ridge(seen: SeenRecords, used: np.ndarray) -> np.ndarray:
    """Weigh random convolutions by ridge regression; its penalty by leaving one record out, as MiniRocket does."""
    from sklearn.linear_model import RidgeClassifierCV
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    values = np.where(np.isfinite(seen.convolutions), seen.convolutions, 0.0)
    model = make_pipeline(StandardScaler(), RidgeClassifierCV(np.logspace(-1, 5, 10), class_weight="balanced"))
    return np.asarray(model.fit(values[: seen.learn][used], seen.damaged[used]).decision_function(values))


def _network(seen: SeenRecords, used: np.ndarray, seed: int) -> np.ndarray:
    """Train the 1-D network; every fifth gearbox says when to stop. The score is the logarithm of the odds."""
    from diagnostics.training.cnn import network_probability, train_network

    _, gearbox = np.unique(seen.gearbox, return_inverse=True)
    known, stops, nobody = (np.zeros(len(seen.kurtogram), dtype=bool) for _ in range(3))
    known[: seen.learn], stops[: seen.learn] = used, used & (gearbox % LEFT_OUT == LEFT_OUT - 1)
    target = np.zeros(known.size, dtype=np.int64)
    target[: seen.learn] = seen.damaged
    split = SpecimenSplit(known & ~stops, stops, nobody, ("healthy", "damaged"))
    trained = train_network(seen.averages, target, split, seed)
    probability = np.clip(network_probability(trained.network, seen.averages)[:, 1], 1e-12, 1.0 - 1e-12)
    return np.asarray(np.log(probability) - np.log1p(-probability))


def stacked(
    seen: SeenRecords, known: Mapping[str, Detector], every: Mapping[str, np.ndarray], seed: int, stage: Stage
) -> np.ndarray:
    """Return the scores of the stack.

    Parameters
    ----------
    seen : SeenRecords
    known : mapping of str to Detector
        Those to be weighed.
    every : mapping of str to (records,) float64
        Their scores after learning from all records to learn from.
    seed : int
        Deals gearboxes into folds.
    stage : Stage
    """
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    unique, place = np.unique(seen.gearbox, return_inverse=True)
    fold = generator(seed, Purpose.FOLDS, CHANCE_OWNER).permutation(unique.size)[place] % min(FOLDS, unique.size)
    unseen = np.zeros((seen.learn, len(known)))
    with stage("stack", int(fold.max()) + 1) as advance:
        for held in np.unique(fold).tolist():
            own = fold == held
            for column, detector in enumerate(known.values()):
                unseen[own, column] = detector(seen, ~own)[: seen.learn][own]
            advance()
    model = make_pipeline(StandardScaler(), LogisticRegression(class_weight="balanced", max_iter=1000))
    model.fit(unseen, seen.damaged)
    return np.asarray(model.decision_function(np.stack([every[name] for name in known], axis=1)))


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
    known = detectors(seed)
    scores = {}
    with stage(f"baselines{BESIDE if referenced else ''}", len(known)) as advance:
        for name, detector in known.items():
            scores[name] = detector(seen, np.ones(seen.learn, dtype=bool))
            advance()
    weighed = {name: known[name] for name in STACKED if name in known}
    scores[STACK] = stacked(seen, weighed, scores, seed, stage)
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
