"""What the strongest of several attackers reaches by chance: states permuted within gearboxes, the bank as one test.

The best of a dozen attackers lies above 0.5 even where there is nothing to find. So the largest AUC over all of them is
compared with its own law under permuted states. Attackers that are too slow for that are left out of both sides.
Source: maximum statistic of permutation tests, standard literature (Westfall and Young 1993).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from diagnostics.attacks.held_out import held_out_value
from diagnostics.attacks.trial import Attacker
from diagnostics.base.seeding import Purpose, generator

PERMUTATIONS = 100
LEVEL = 0.95


def permuted(positive: np.ndarray, specimen: np.ndarray, seed: int, turn: int) -> np.ndarray:
    """Return states permuted within gearboxes that have both, else among gearboxes, (n,) bool."""
    rng = generator(seed, Purpose.PERMUTATION, 1000, turn)
    found = positive.copy()
    unique = np.unique(specimen)
    mixed = [np.flatnonzero(specimen == owner) for owner in unique]
    if any(np.unique(positive[rows]).size == 2 for rows in mixed):
        for rows in mixed:
            found[rows] = positive[rng.permutation(rows)]
        return found
    lead = np.array([positive[rows[0]] for rows in mixed])[rng.permutation(unique.size)]
    return np.asarray(lead[np.searchsorted(unique, specimen)])


def chance_maximum(
    attackers: Sequence[Attacker], rows: np.ndarray, positive: np.ndarray, specimen: np.ndarray, folds: np.ndarray,
    seed: int, turn: int,
) -> float:  # fmt: skip
    """Return the largest AUC over the attackers for one permutation of the states; NaN where none could be asked.

    Parameters
    ----------
    attackers : sequence of Attacker
        Those that are not permutable are left out.
    rows, positive, specimen, folds
        As of `diagnostics.attacks.held_out.trials`; every attacker is asked about the rows that it can use.
    seed, turn : int
        Which permutation.
    """
    states = permuted(positive, specimen, seed, turn)
    areas = [math.nan]
    for attacker in attackers:
        if attacker.permutable:
            kept = attacker.usable[rows]
            areas.append(held_out_value(attacker, rows[kept], states[kept], specimen[kept], folds[:, kept]))
    defined = [area for area in areas if math.isfinite(area)]
    return max(defined, default=math.nan)
