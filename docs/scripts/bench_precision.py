"""What parts of siggen-bench tell apart, by their gearboxes: `python docs/scripts/bench_precision.py`.

Scores are drawn: normal, damaged records higher by what gives an AUC; records of one gearbox share a part of the
variance, two entries a correlation. The limits are those of `score` and of the board, means over DRAWS draws. Prints
for each kind of part half the width of the interval of an AUC, and the difference of two entries that their paired
interval tells from 0 in four of five cases: half its width, times 1 + 0.84 / 1.96.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.stats import norm

from diagnostics.base.single_thread import single_thread
from diagnostics.bench.making import TIERS
from diagnostics.statistics.evaluation import area, bootstrap_weights, interval, weighted_auc

AREAS = (0.6, 0.75, 0.9)
SHARED, ALIKE = 0.3, 0.6
"""Share of gearboxes in the variance of a score, and correlation of two entries: both assumed."""
DRAWS, POWER = 40, 1.0 + 0.84 / 1.96
EXTRA = 60
"""Gearboxes of no tier, between `small` and `full`."""


class Kind(NamedTuple):
    """A kind of part: what it is called, and which of the asked records of a gearbox have damage."""

    parts: str
    damaged: tuple[bool, ...]


KINDS = (Kind("`NAME_alone`", ()), Kind("`NAME`, beside", (True,) * 5 + (False,) * 2))
"""Of parts that are judged alone a gearbox has one record, with damage or without in turn."""


def half_widths(kind: Kind, gearboxes: int, auc: float) -> tuple[float, float]:
    """Return half the width of the interval of an AUC, and of that of a difference."""
    rng, asked = np.random.default_rng(0), max(len(kind.damaged), 1)
    specimen = np.repeat(np.arange(gearboxes), asked)
    damaged = np.array((kind.damaged or (True, False)) * gearboxes)[: specimen.size]
    weights, widths = bootstrap_weights(specimen, 0), []
    for _ in range(DRAWS):
        common, *own = (_noise(rng, specimen) for _ in range(3))
        entries = [ALIKE**0.5 * common + (1.0 - ALIKE) ** 0.5 * one + 2**0.5 * norm.ppf(auc) * damaged for one in own]
        found = area(entries[0], damaged, weights, specimen)
        first, second = (weighted_auc(one, damaged, weights, specimen) for one in entries)
        apart = interval(second - first, gearboxes)
        widths.append((found.high - found.low, apart.high - apart.low))
    return tuple(0.5 * np.mean(widths, axis=0))


def _noise(rng: np.random.Generator, specimen: np.ndarray) -> np.ndarray:
    """Return noise of variance 1 that records of a gearbox share in part."""
    shared = rng.normal(size=specimen[-1] + 1)[specimen]
    return np.asarray(SHARED**0.5 * shared + (1.0 - SHARED) ** 0.5 * rng.normal(size=specimen.size))


@single_thread()
def main() -> None:
    """Print the table."""
    sizes = {size.test: f"`{tier}`" for tier, size in TIERS.items()} | {EXTRA: "-"}
    print(f"| part | gearboxes | tier | {' | '.join(f'AUC {auc:g}' for auc in AREAS)} |\n{'|---' * (3 + len(AREAS))}|")
    for kind in KINDS:
        for gearboxes in sorted(sizes):
            found = (half_widths(kind, gearboxes, auc) for auc in AREAS)
            cells = " | ".join(f"±{own:.2f}, {POWER * apart:.2f}" for own, apart in found)
            print(f"| {kind.parts} | {gearboxes} | {sizes[gearboxes]} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
