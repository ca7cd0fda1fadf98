"""Stack and kurtogram on a benchmark: `python docs/scripts/stacked_baselines.py BENCH [sealed.json]`.

AUC of the kurtogram and of the stack on every test part of a benchmark that has its baselines, and their difference on
the same resampled gearboxes; alone, and beside a healthy record.
"""

from __future__ import annotations

import sys
from pathlib import Path

from diagnostics.bench.baselines import BESIDE, KURTOGRAM, STACK
from diagnostics.bench.leaderboard import MEAN, Entry, board_entries, paired
from diagnostics.scoring.benchmark import open_benchmark
from diagnostics.scoring.sealed_labels import labels_of
from diagnostics.statistics.evaluation import Interval


def shown(found: Interval, form: str = ".2f") -> str:
    """Return a value with its limits."""
    return f"{found.value:{form}} ({found.low:{form}} to {found.high:{form}})"


def row(part: str, pairs: list[tuple[Entry, Entry]]) -> str:
    """Return the line of a part: of every track kurtogram, stack, and the stack minus the kurtogram."""
    cells = [
        text
        for first, second in pairs
        for text in (shown(first.score(part)), shown(second.score(part)), shown(paired(first, second, part), "+.2f"))
    ]
    return f"| {part} | {' | '.join(cells)} |"


def main() -> None:
    """Print the table."""
    benchmark = open_benchmark(Path(sys.argv[1]))
    labels = labels_of(benchmark, Path(sys.argv[2]) if len(sys.argv) > 2 else None)
    entries = {entry.name: entry for entry in board_entries(benchmark, labels, None, 0)}
    pairs = [(entries[f"{KURTOGRAM}{track}"], entries[f"{STACK}{track}"]) for track in ("", BESIDE)]
    print(benchmark)
    print("| part | kurtogram | stack | difference | kurtogram, beside | stack, beside | difference |")
    print("|---|---|---|---|---|---|---|")
    for part in (MEAN, *benchmark.parts):
        print(row(part, pairs))


if __name__ == "__main__":
    main()
