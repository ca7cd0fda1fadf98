"""What anybody gets of the labels of a benchmark: `python docs/scripts/sealed_labels.py FOLDER`, with its labels.

First: numbers of what is published, in families, as attackers of damage and of shams. Of each family the attacker
whose mean AUC over the parts lies farthest from 0.5, and the share of 2,000 permutations of the labels that reach as
much. Labels are permuted within gearboxes, of parts with one record of a gearbox within the part.

Second: what other asked records tell of one. A logistic regression learns five indicators on the part to learn from.
Its score is taken as it is, and less the mean of other records: of the same gearbox, or of the three of the part that
are nearest in speed and torque. Mean of AUC over the parts, with its standard error.

Third, of the folder's baselines: correlation of the scores of two of them, within gearbox-free classes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyarrow.parquet as pq

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))  # the attackers are those of the tests

import diagnostics  # noqa: E402
from diagnostics.base.single_thread import single_thread  # noqa: E402
from diagnostics.bench.question import is_alone  # noqa: E402
from diagnostics.records.state_classes import HEALTHY, SHAM  # noqa: E402
from diagnostics.scoring.benchmark import BASELINES, Benchmark, labelled, labels_of  # noqa: E402
from diagnostics.scoring.prediction_file import PREDICTIONS_FILE  # noqa: E402
from diagnostics.statistics.evaluation import column_auc, weighted_auc  # noqa: E402
from tests.diagnostics.bench.attackers import SIGNAL, attackers, permuted_within  # noqa: E402

PERMUTATIONS = 2000
INDICATORS = ("rms", "kurtosis", "fm4", "na4", "m6a")
FAMILIES: Mapping[str, Callable[[str], bool]] = {
    "order and ids": lambda name: not name.startswith((SIGNAL, "column", "last bits", "length")),
    "conditions, texts": lambda name: name.startswith(("column", "last bits", "length")),
    "tacho": lambda name: name.startswith(SIGNAL) and "pulse" in name,
    "sizes in bytes": lambda name: name.startswith(f"{SIGNAL}bytes"),
    "noise": lambda name: name.startswith((f"{SIGNAL}noise", f"{SIGNAL}zeros", f"{SIGNAL}values twice")),
    "all other of signals": lambda name: name.startswith(SIGNAL),
}
"""The first that takes an attacker's name has it."""


class Part(NamedTuple):
    """Asked records of a part: gearbox, state and fault (n,), what attackers make of each, and conditions (n, 2)."""

    gearbox: np.ndarray
    state: np.ndarray
    fault: np.ndarray
    values: Mapping[str, np.ndarray]
    conditions: np.ndarray
    record: np.ndarray


def asked(benchmark: Benchmark, name: str) -> Part:
    """Return the asked records of a part, with their labels."""
    dataset = labelled(benchmark.part(name), labels_of(benchmark, None), name)
    records, values = attackers(benchmark.path / "test" / name)
    rows = {row["record_id"]: row for row in dataset.labels("test").to_pylist()}
    own = [rows[record] for record in records.tolist()]
    columns = (np.array([row[key] for row in own]) for key in ("specimen_id", "state", "fault"))
    return Part(*columns, values, np.array([[row["speed_hz"], row["torque_nm"]] for row in own]), records)


def strongest(parts: list[Part], names: list[str], damaged: bool) -> tuple[str, float, float]:
    """Return the strongest attacker by its mean over parts, that mean, and the share of permutations that reach it."""
    areas = np.zeros((PERMUTATIONS + 1, len(names)))
    for part in parts:
        rows = np.ones(part.state.size, bool) if damaged else part.fault == HEALTHY
        positive = (part.fault != HEALTHY if damaged else part.state == SHAM)[rows]
        lone = np.unique(part.gearbox).size == part.gearbox.size
        gearbox, rng = np.zeros(positive.size) if lone else part.gearbox[rows], np.random.default_rng(0)
        mixed = np.stack([positive, *(permuted_within(positive, gearbox, rng) for _ in range(PERMUTATIONS))])
        areas += column_auc(np.stack([part.values[name][rows] for name in names], axis=1), mixed) / len(parts)
    best = np.abs(areas - 0.5).max(axis=1)
    first = int(np.abs(areas[0] - 0.5).argmax())
    return names[first], float(areas[0, first]), float(np.mean(best >= best[0] - 1e-12))


def print_attackers(parts: Mapping[str, Part]) -> None:
    """Print the table of attackers."""
    print(
        "| attackers | how many | parts | damage: strongest, AUC, p | sham: strongest, AUC, p |\n|---|---|---|---|---|"
    )
    for alone in (False, True):
        own = [part for name, part in parts.items() if is_alone(name) == alone]
        common = [name for name in own[0].values if all(name in part.values for part in own)]
        for family in FAMILIES:
            names = [name for name in common if next(key for key, take in FAMILIES.items() if take(name)) == family]
            cells = []
            for damaged in (True, False):
                told = [part for part in own if (part.state == SHAM).any() or damaged]
                if alone and not damaged:  # three shams of eighteen healthy ones at most
                    told = []
                cells.append("{}, {:.2f}, {:.3f}".format(*strongest(told, names, damaged)) if told else "-")
            side = "`NAME_alone`" if alone else "`NAME`"
            print(f"| {family} | {len(names)} | {side} | {' | '.join(cells)} |", flush=True)


def area(score: np.ndarray, part: Part) -> float:
    """Return the AUC between records of different gearboxes."""
    return float(weighted_auc(score, part.fault != HEALTHY, np.ones((1, score.size)), part.gearbox)[0])


def print_centred(benchmark: Benchmark, parts: Mapping[str, Part]) -> None:
    """Print what the mean of other records is worth."""
    learn = diagnostics.table(benchmark.learn())
    names = [name for name in learn.names if name.partition("__")[0] in INDICATORS]
    known = learn.columns(names)
    model = diagnostics.LogisticBaseline(strengths=(0.01,))
    model.fit(known.values, np.where(known.labels["fault"] == HEALTHY, "0", "1"), known.groups)
    found: dict[tuple[bool, str], list[float]] = {}
    for name, part in parts.items():
        table = diagnostics.table(benchmark.part(name)).split("test").columns(names)
        row = {record: place for place, record in enumerate(table.labels["record_id"].tolist())}
        probability = model.predict_proba(table.values)[[row[one] for one in part.record.tolist()], 1]
        score = np.log(probability) - np.log1p(-probability)
        same = part.gearbox[:, None] == part.gearbox
        apart = np.abs(np.log(part.conditions)[:, None] - np.log(part.conditions)).sum(axis=2)
        near = np.argsort(np.where(same, np.inf, apart), axis=1)[:, :3]
        scores = {"as it is": score, "less the nearest in speed and torque": score - score[near].mean(axis=1)}
        if not is_alone(name):
            scores["less the mean of its gearbox"] = score - same @ score / same.sum(axis=1)
        for what, own in scores.items():
            found.setdefault((is_alone(name), what), []).append(area(own, part))
    print("\n| parts | score | mean AUC | standard error |\n|---|---|---|---|")
    for (alone, what), areas in sorted(found.items()):
        error = np.std(areas, ddof=1) / len(areas) ** 0.5
        print(f"| {'`NAME_alone`' if alone else '`NAME`'} | {what} | {np.mean(areas):.2f} | {error:.2f} |")


def print_correlations(benchmark: Benchmark, parts: Mapping[str, Part]) -> None:
    """Print how alike baselines are, and how alike the records of one gearbox are to them."""
    table = pq.read_table(benchmark.path / BASELINES / PREDICTIONS_FILE).to_pylist()
    entries: dict[tuple[bool, str], dict[int, float]] = {}
    for row in table:
        entries.setdefault((row["reference"], row["classifier"]), {})[row["record_id"]] = row["damage"]
    print("\n| track | pairs of baselines | correlation: quartiles | share of gearboxes in the variance: quartiles |")
    print("|---|---|---|---|")
    for referenced in (False, True):
        own = [part for name, part in parts.items() if is_alone(name) != referenced]
        scores = [
            np.concatenate([_within_classes(part, says) for part in own])
            for (side, name), says in entries.items()
            if side == referenced and not name.startswith("chance")
        ]
        alike = [np.corrcoef(a, b)[0, 1] for a, b in combinations(scores, 2)]
        gearbox = np.concatenate([part.gearbox for part in own])
        shares = [_share(score, gearbox) for score in scores] if referenced else [np.nan]
        said = (", ".join(f"{value:.2f}" for value in np.quantile(one, [0.25, 0.5, 0.75])) for one in (alike, shares))
        print(f"| {'beside' if referenced else 'alone'} | {len(alike)} | {' | '.join(said)} |")


def _within_classes(part: Part, says: Mapping[int, float]) -> np.ndarray:
    """Return normal ranks of what a baseline says, less the mean of the damaged or the healthy records."""
    from scipy.stats import norm, rankdata

    score = np.array([says[record] for record in part.record.tolist()])
    score = norm.ppf((rankdata(score) - 0.5) / score.size)
    damaged = part.fault != HEALTHY
    return np.asarray(score - np.where(damaged, score[damaged].mean(), score[~damaged].mean()))


def _share(score: np.ndarray, gearbox: np.ndarray) -> float:
    """Return the share of gearboxes in the variance of a score: covariance of two records of one gearbox."""
    same = (gearbox[:, None] == gearbox) & ~np.eye(gearbox.size, dtype=bool)
    return float((score @ same @ score) / same.sum() / np.var(score))


@single_thread()
def main(folder: str) -> None:
    """Print all tables."""
    benchmark = diagnostics.open_benchmark(folder)
    parts = {name: asked(benchmark, name) for name in benchmark.parts}
    print_attackers(parts)
    print_centred(benchmark, parts)
    if (benchmark.path / BASELINES).is_dir():
        print_correlations(benchmark, parts)


if __name__ == "__main__":
    main(sys.argv[1])
