"""The network that comes along against logistic regression: `python docs/scripts/network_scores.py SET_OR_BENCHMARK`.

Of a set every gearbox is scored by what has learnt on the others (five folds); of a benchmark test parts are scored by
what has learnt on the part to learn from, and labels are those of `labels_of`. Prints Markdown: AUC of damage of the
network without training, of a regression on what it says, of logistic regression and gradient boosting on all
indicators, and differences of the second from both, paired on the same gearboxes; limits of 95 % over gearboxes. Of a
set also by state. Another network: `--network runs/pretrained/network.safetensors`.

`--from-nothing 3` prints another table of a set: the regression, against the same network that begins with random
weights of three seeds and learns on the gearboxes of the same folds alone, in the loop of `docs/scripts/pretrain.py`. A
fifth of those gearboxes, held back, tells how many passes it takes: twice as many until that is no gain. Then it learns
on all. Scores are ranked within a fold, since each has networks of its own. `--passes 16` takes so many instead.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.stats import rankdata

import diagnostics
import siggen
from diagnostics.base.single_thread import single_thread
from diagnostics.bench.leaderboard import benchmark_records
from diagnostics.judging.alarms import HEADS_STRENGTH
from diagnostics.judging.evaluation import Design
from diagnostics.judging.learners import Odds
from diagnostics.records.state_classes import HEALTHY
from diagnostics.scoring.benchmark import is_benchmark, labelled, labels_of
from diagnostics.statistics.evaluation import bootstrap_weights, interval, weighted_auc
from diagnostics.training.classifiers import DEFAULT_TREES, BoostingBaseline, LogisticBaseline
from diagnostics.training.feature_classifier import DEFAULT_STRENGTH
from diagnostics.training.gear_rows import ALONE
from diagnostics.training.gearbox_network import GearboxNetwork, load_gearbox_network
from diagnostics.training.pretraining import LABELS, KeptRecords, PretrainingSettings, taught
from diagnostics.training.referenced import healthy_references, log_mean, log_values
from diagnostics.training.shipped_network import gear_averages, heads, shipped_network

SIDES = ("alone", "beside")
FEWEST_PASSES = 8
"""Of a network that begins from nothing."""


class Judged(NamedTuple):
    """Records that are scored: damage (n,), gearbox (n,), and the scores (n,) of four detectors."""

    part: str
    side: str
    damaged: np.ndarray
    gearbox: np.ndarray
    scores: tuple[np.ndarray, ...]


def learnt(
    values: np.ndarray, said: np.ndarray, damaged: np.ndarray, gearbox: np.ndarray, asked: np.ndarray, *, beside: bool
) -> tuple[np.ndarray, ...]:
    """Return the scores of the asked records (n,) bool by what learns on those given by `damaged` among the others."""
    own = Odds(LogisticBaseline((HEADS_STRENGTH,), take_logarithms=False))
    on_indicators = Odds(LogisticBaseline((DEFAULT_STRENGTH,), take_logarithms=not beside))
    boosted = Odds(BoostingBaseline(0, DEFAULT_TREES))
    known = ~asked
    found = [
        model.fit(X[known], damaged[known], gearbox[known]).score(X[asked])
        for model, X in ((own, said), (on_indicators, values), (boosted, values))
    ]
    return said[asked, 0], *found


def of_set(path: Path, seed: int, network: GearboxNetwork) -> Iterator[Judged]:
    """Yield what is judged of a set, alone and beside."""
    dataset = siggen.open(path)
    table, lines = diagnostics.table(dataset), gear_averages(dataset, 2)
    damaged, gearbox = table.labels["fault"] != HEALTHY, table.groups
    references, logs = healthy_references(table.labels), log_values(table.values)
    for side in SIDES:
        beside = side == "beside"
        said = heads(lines, lines, references, network) if beside else heads(lines, network=network)
        values = np.stack(
            [logs[k] - log_mean(table.values[known]) if known.size else logs[k] for k, known in enumerate(references)]
        )
        seen = np.array([known.size > 0 for known in references]) if beside else np.ones(len(said), dtype=bool)
        values, said, ill, owner = (values if beside else table.values)[seen], said[seen], damaged[seen], gearbox[seen]
        values = values[:, np.isfinite(values).any(axis=0)]
        fold, scores = Design(folds=5, owner=2000).dealt(owner, seed)[0], np.zeros((4, ill.size))
        for held in np.unique(fold):
            asked = fold == held
            scores[:, asked] = learnt(values, said, ill, owner, asked, beside=beside)
        state = table.labels["state"][seen]
        yield Judged(path.name, side, ill, owner, tuple(scores))
        for name in dict.fromkeys(state[ill].tolist()):
            own = ~ill | (state == name)
            yield Judged(name, side, ill[own], owner[own], tuple(scores[:, own]))


class FromNothing:
    """Networks that begin with random weights and learn on some gearboxes of a set alone."""

    def __init__(self, dataset: siggen.Dataset) -> None:
        columns = dataset.labels(columns=LABELS)
        labels = {name: np.array(columns[name].to_pylist()) for name in LABELS}
        self.kept = KeptRecords(gear_averages(dataset), labels)
        self.owner, self.kinds = labels["specimen_id"], self.kept.kinds(np.arange(len(columns)))
        self.rows, self.truths = self.kept.rows(), self.kept.truths(self.kinds)
        self.damaged, self.references = self.truths.damaged > 0.0, healthy_references(labels)
        self.seen = {"alone": self.owner >= 0, "beside": np.array([known.size > 0 for known in self.references])}

    def said(self, network: GearboxNetwork, side: str) -> np.ndarray:
        """Return what a network says of all records, (records, numbers)."""
        lines = self.kept.averages
        return heads(lines, lines, self.references, network) if side == "beside" else heads(lines, network=network)

    def learnt(self, learn: np.ndarray, asked: np.ndarray, passes: int, seed: int) -> dict[str, np.ndarray]:
        """Return the log odds of damage (records,) of those asked, on each side, learnt from others; else NaN."""
        chosen, rows = PretrainingSettings(passes=passes, seed=seed), self.rows[asked]
        network, found = taught(self.rows, self.truths, self.kinds, learn, chosen), dict[str, np.ndarray]()
        for side in reversed(SIDES):
            found[side] = np.full(self.owner.size, np.nan)
            found[side][asked] = network.tell(rows).damage
            rows[..., ALONE:, :] = 0.0
        return found

    def passes(self, learn: np.ndarray, seed: int) -> int:
        """Return after how many passes it is best on a fifth of the gearboxes: twice as many until that is no gain."""
        part = Design(folds=5, owner=2001).dealt(self.owner[learn], seed)[0]
        held, best, passes = learn[part == 0], -np.inf, FEWEST_PASSES
        while True:
            found = self.learnt(learn[part > 0], held, passes, seed)
            own = {side: held[self.seen[side][held]] for side in SIDES}
            gained = np.mean([self.area(found[side], own[side], np.ones((1, own[side].size))) for side in SIDES])
            if gained <= best:
                return passes // 2
            best, passes = gained, 2 * passes

    def area(self, score: np.ndarray, places: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Return the AUC (b,) of damage of some records."""
        return weighted_auc(score[places], self.damaged[places], weights, self.owner[places])


def from_nothing(path: Path, seed: int, network: GearboxNetwork, begun: int, known_passes: int | None) -> None:
    """Print a table: a regression on what the network says against `begun` networks from nothing, by fold."""
    asked = FromNothing(siggen.open(path))
    fold = Design(folds=5, owner=2000).dealt(asked.owner, seed)[0]
    ranks = {side: np.zeros((1 + begun, fold.size)) for side in SIDES}
    said = {side: asked.said(network, side) for side in SIDES}
    for number in np.unique(fold):
        learn, judged = np.flatnonzero(fold != number), np.flatnonzero(fold == number)
        passes = known_passes or asked.passes(learn, seed)
        print(f"fold {number + 1}: {passes} passes", flush=True)
        found = [asked.learnt(learn, judged, passes, seed + each) for each in range(begun)]
        for side in SIDES:
            places, known = (one[asked.seen[side][one]] for one in (judged, learn))
            own = Odds(LogisticBaseline((HEADS_STRENGTH,), take_logarithms=False))
            own.fit(said[side][known], asked.damaged[known], asked.owner[known])
            scores = own.score(said[side][places]), *(each[side][places] for each in found)
            ranks[side][:, places] = [rankdata(score) / score.size for score in scores]
    print("\n| seen | gearboxes | regression on the network | from nothing | by seeds | difference |")
    print("|---" * 6 + "|")
    for side in SIDES:
        places = np.flatnonzero(asked.seen[side])
        weights = bootstrap_weights(asked.owner[places], seed)
        area, *others = (asked.area(rank, places, weights) for rank in ranks[side])
        mean, count = np.mean(others, axis=0), np.unique(asked.owner).size
        cells = [limits(one, count) for one in (area, mean, area - mean)]
        values = [float(each[0]) for each in others]
        spread = f"{min(values):.3f} to {max(values):.3f}"
        print(f"| {side} | {count} | {cells[0]} | {cells[1]} | {spread} | {cells[2]} |", flush=True)


def of_benchmark(path: Path, network: GearboxNetwork) -> Iterator[Judged]:
    """Yield what is judged of every test part, alone and beside."""
    benchmark = diagnostics.open_benchmark(path)
    records, truth = benchmark_records(benchmark, 2), labels_of(benchmark, None)
    count, labels = records.learn, records.matrix.labels
    fault = {
        row["record_id"]: (name, row["fault"])
        for name in benchmark.parts
        for row in labelled(benchmark.part(name), truth, name).labels().to_pylist()
    }
    told = [fault[number] for number in labels["record_id"][count:].tolist()]
    damaged = np.array([*(labels["fault"][:count] != HEALTHY), *(own != HEALTHY for _, own in told)])
    part = np.array([*[""] * count, *(name for name, _ in told)])
    logs, lines = log_values(records.matrix.values), records.gears
    assert lines is not None
    for side in SIDES:
        beside = side == "beside"
        kept = np.flatnonzero(records.asked & (records.reference >= 0 if beside else records.alone))
        own, reference = lines.chosen(kept), records.reference[kept]
        said = heads(own, lines, reference[:, None], network) if beside else heads(own, network=network)
        values = logs[kept] - logs[reference] if beside else records.matrix.values[kept]
        asked = kept >= count
        scores = learnt(values, said, damaged[kept], labels["specimen_id"][kept], asked, beside=beside)
        for name in benchmark.parts:
            rows = part[kept][asked] == name
            if rows.any():
                yield Judged(
                    name, side, damaged[kept][asked][rows], labels["specimen_id"][kept][asked][rows],
                    tuple(score[rows] for score in scores),
                )  # fmt: skip


def areas(judged: Judged, seed: int) -> tuple[np.ndarray, ...]:
    """Return the resampled AUC of the four detectors."""
    weights = bootstrap_weights(judged.gearbox, seed)
    return tuple(weighted_auc(score, judged.damaged, weights, judged.gearbox) for score in judged.scores)


def limits(samples: np.ndarray, gearboxes: int) -> str:
    """Return a value with its limits."""
    one = interval(samples, gearboxes)
    return f"{one.value:.3f} ({one.low:.3f} to {one.high:.3f})"


def row(name: str, side: str, gearboxes: int, found: tuple[np.ndarray, ...]) -> str:
    """Return a line of the table."""
    differences = (found[1] - found[2], found[1] - found[3])
    said = " | ".join(limits(one, gearboxes) for one in (*found, *differences))
    return f"| {name} | {side} | {gearboxes} | {said} |"


@single_thread()
def main() -> None:
    """Print the table."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("path", type=Path)
    asked.add_argument("--network", type=Path)
    asked.add_argument("--seed", type=int, default=0)
    asked.add_argument("--from-nothing", type=int, metavar="SEEDS", help="of a set only")
    asked.add_argument("--passes", type=int, help="of those, where another set has told")
    given = asked.parse_args()
    network = load_gearbox_network(given.network)[0] if given.network else shipped_network()[0]
    if given.from_nothing:
        from_nothing(given.path, given.seed, network, given.from_nothing, given.passes)
        return
    print(
        "| part | seen | gearboxes | network | regression on it | logistic | boosting | over logistic | over boosting |"
    )
    print("|---" * 9 + "|")
    if not is_benchmark(given.path):
        for judged in of_set(given.path, given.seed, network):
            found = areas(judged, given.seed)
            print(row(judged.part, judged.side, np.unique(judged.gearbox).size, found), flush=True)
        return
    parts = [(judged, areas(judged, k)) for k, judged in enumerate(of_benchmark(given.path, network))]
    for judged, found in parts:
        print(row(judged.part, judged.side, np.unique(judged.gearbox).size, found), flush=True)
    for side in SIDES:  # gearboxes of different parts are independent
        own = [(np.unique(judged.gearbox).size, found) for judged, found in parts if judged.side == side]
        means = tuple(np.mean([found[k] for _, found in own], axis=0) for k in range(4))
        print(row("mean of parts", side, sum(count for count, _ in own), means))


if __name__ == "__main__":  # workers import the script
    main()
