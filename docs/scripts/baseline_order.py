"""How many test gearboxes rank the baselines of siggen-bench: `baseline_order.py BENCH [sealed.json]`.

Takes a benchmark with its baselines and prints Markdown, for every test part alone and beside a healthy record, without
the baseline `chance`: Kendall's tau of the order by AUC, between disjoint draws of gearboxes and of each with all, mean
over DEALS deals. Then, of baselines that look at other columns and lie 0.05 or more apart over all, in which share of
draws paired 95 % limits leave zero out.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path

import numpy as np
from scipy.stats import kendalltau

from diagnostics.bench.baselines import BESIDE, CHANCE, STACK, STACKED
from diagnostics.scoring.benchmark import BASELINES, open_benchmark
from diagnostics.scoring.benchmark_scores import JudgedPart, judged_parts, part_columns
from diagnostics.scoring.detect import DETECT, EVERY
from diagnostics.scoring.prediction_file import PREDICTIONS_FILE, prediction_table
from diagnostics.scoring.sealed_labels import labels_of
from diagnostics.statistics.evaluation import bootstrap_weights, interval

DRAWS, DEALS, RESAMPLES = (12, 18, 24, 36, 60, 90), 20, 400
APART, SEED = 0.05, 0
LIKE = (frozenset({"RMS alone", "six columns", "gradient boosting"}), frozenset({"kurtogram", "best band"}))
"""Baselines that look at the same columns; the stack weighs those that it is made of."""

Areas = dict[str, np.ndarray]
"""AUC of each baseline: the value, then those of resampled gearboxes."""


class Judged:
    """Answers of the baselines of a track on a part, and the areas that they reach on some gearboxes."""

    def __init__(self, part: JudgedPart, answers: dict[str, np.ndarray]) -> None:
        self.truth, self.answers = part.truth, answers
        self.gearboxes = np.unique(part.truth.specimen)

    def areas(self, drawn: np.ndarray, resamples: int) -> Areas:
        """Return the areas of all baselines on the drawn gearboxes, on the same resamples."""
        rows = np.isin(self.truth.specimen, drawn) & DETECT.parts(self.truth)[EVERY]
        truth, (measure,) = self.truth.rows(rows), DETECT.measures
        weights = bootstrap_weights(truth.specimen, SEED, resamples)
        return {name: measure.samples(said[rows], truth, weights) for name, said in self.answers.items()}


def tracks(bench: Path, sealed: Path | None) -> Iterator[tuple[str, Judged]]:
    """Yield title and answers of every part, alone and beside a healthy record."""
    benchmark = open_benchmark(bench)
    parts = judged_parts(benchmark, labels_of(benchmark, sealed))
    file = bench / BASELINES / PREDICTIONS_FILE
    columns = part_columns(benchmark, parts, prediction_table(file), file, file.stem)
    for beside in (False, True):
        for part in parts:
            own = {
                name.removesuffix(BESIDE): found
                for name, found in columns[part.name].items()
                if name.endswith(BESIDE) == beside
            }
            answers = {name: DETECT.answers(found, part.truth) for name, found in own.items() if name != CHANCE}
            yield f"{part.name}, {'beside a healthy record' if beside else 'alone'}", Judged(part, answers)


def tau(first: Areas, second: Areas) -> float:
    """Return Kendall's tau of two orders by AUC."""
    return float(kendalltau([first[name][0] for name in first], [second[name][0] for name in first]).statistic)


def unlike(areas: Areas) -> Iterator[tuple[str, str, float]]:
    """Yield the better and the worse of two baselines that look at other columns, and by how much they differ."""
    for pair in combinations(areas, 2):
        stacked = STACK in pair and not set(pair).isdisjoint(STACKED)
        if not stacked and not any(group.issuperset(pair) for group in LIKE):
            worse, better = sorted(pair, key=lambda name: areas[name][0])
            yield better, worse, float((areas[better] - areas[worse])[0])


def row(judged: Judged, whole: Areas, size: int) -> str:
    """Return the line of draws of so many gearboxes."""
    between, with_all, near, far = [], [], [], []
    for deal in range(DEALS):
        mixed = np.random.default_rng(deal).permutation(judged.gearboxes)
        count = mixed.size // size
        draws = [judged.areas(drawn, RESAMPLES) for drawn in np.split(mixed[: count * size], count)]
        between += [tau(first, second) for first, second in combinations(draws, 2)]
        with_all += [tau(draw, whole) for draw in draws]
        for better, worse, apart in unlike(whole):
            told = [interval(draw[better] - draw[worse], size).low > 0.0 for draw in draws]
            (near if apart < 2 * APART else far).extend(told if apart >= APART else [])
    shares = (f"{np.mean(told):.0%}" if told else "none" for told in (near, far))
    return f"| {size} | {np.mean(between):.2f} | {np.mean(with_all):.2f} | {' | '.join(shares)} |"


def main(bench: Path, sealed: Path | None) -> None:
    """Print a table of every part and track."""
    for title, judged in tracks(bench, sealed):
        whole = judged.areas(judged.gearboxes, RESAMPLES)
        print(f"\n{title}: ", end="")
        print(", ".join(f"{name} {whole[name][0]:.3f}" for name in sorted(whole, key=lambda name: -whole[name][0])))
        apart = [found for found in unlike(whole) if found[2] >= APART]
        print(f"{len(apart)} unlike pairs, of them {sum(one[2] < 2 * APART for one in apart)} 0.05 to 0.10 apart\n")
        print("| gearboxes | tau between draws | tau with all | told, 0.05 to 0.10 apart | told, 0.10 and more |")
        print("|---" * 5 + "|")
        for size in (size for size in DRAWS if 2 * size <= judged.gearboxes.size):
            print(row(judged, whole, size), flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None)
