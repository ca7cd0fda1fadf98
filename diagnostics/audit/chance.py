"""What the strongest of several attackers reaches by chance: states exchanged among alike records, all as one test.

The best of a dozen attackers lies above 0.5 even where there is nothing to find. So the largest AUC over all of them is
compared with its own law under exchanged states. The test is exact where records of a block are alike but for the
state: then the stated states are one of the ways of stating them, each as likely as the others. Attackers that are too
slow for that are left out of both sides. Source: permutation tests with the maximum statistic, standard literature
(Westfall and Young 1993; Phipson and Smyth 2010 for counting the stated states among the ways).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnostics.audit.held_out import held_out_values
from diagnostics.audit.trial import Attacker
from diagnostics.base.seeding import Purpose, generator

PERMUTATIONS = 499
LEVEL = 0.95
OWNER = 1000
"""Owner of the permutations' generator: other traps have others."""
BLOCK, GEARBOX, GEARBOXES = "block", "gearbox", "gearboxes"
"""What states are exchanged within; the last: whole gearboxes among each other."""


def permuted(positive: np.ndarray, block: np.ndarray, specimen: np.ndarray, seed: int, turns: int) -> np.ndarray:
    """Return states exchanged within blocks, else within gearboxes, else among gearboxes, (turns, n) bool.

    Parameters
    ----------
    positive : (n,) bool
        Damaged records.
    block : (n,) int
        Records of one block are alike but for the state. Where no block has both states, gearboxes are the blocks.
    specimen : (n,) int
        Gearboxes; where none has both states, they are exchanged as a whole.
    seed, turns : int
        Which permutations, and how many.
    """
    rng, unit = generator(seed, Purpose.PERMUTATION, OWNER), exchanged_unit(positive, block, specimen)
    if unit != GEARBOXES:
        groups = block if unit == BLOCK else specimen
        return _exchanged(positive, groups, rng.random((turns, positive.size)))
    _, first, place = np.unique(specimen, return_index=True, return_inverse=True)
    lead = _exchanged(positive[first], np.zeros_like(first), rng.random((turns, first.size)))
    return np.asarray(lead[:, place.ravel()])


def exchanged_unit(positive: np.ndarray, block: np.ndarray, specimen: np.ndarray) -> str:
    """Return within what states are exchanged: `block`, else `gearbox`, or `gearboxes` where these move as a whole.

    Parameters
    ----------
    positive, block, specimen
        As of `permuted`.
    """
    if _is_mixed(positive, block):
        return BLOCK
    return GEARBOX if _is_mixed(positive, specimen) else GEARBOXES


def _is_mixed(positive: np.ndarray, groups: np.ndarray) -> bool:
    """Return whether a group holds both states."""
    _, place = np.unique(groups, return_inverse=True)
    share = np.bincount(place.ravel(), positive) / np.bincount(place.ravel())
    return bool(((share > 0.0) & (share < 1.0)).any())


def _exchanged(positive: np.ndarray, groups: np.ndarray, keys: np.ndarray) -> np.ndarray:
    """Return states sorted within groups by random keys, (turns, n)."""
    found = np.empty(keys.shape, dtype=bool)
    found[:, np.argsort(groups, kind="stable")] = [positive[np.lexsort((turn, groups))] for turn in keys]
    return found


def bank_maxima(
    attackers: Sequence[Attacker], rows: np.ndarray, states: np.ndarray, specimen: np.ndarray, folds: np.ndarray
) -> np.ndarray:
    """Return the largest AUC over the attackers for every way of stating the damaged records, (turns,).

    Parameters
    ----------
    attackers : sequence of Attacker
        Every one is asked about the rows that it can use.
    rows : (n,) int
        Records of the set.
    states : (turns, n) bool
        As of `permuted`.
    specimen : (n,) int
    folds : (deals, n) int
        As of `diagnostics.audit.held_out.dealt_folds`.

    Returns
    -------
    (turns,) float64
        NaN where none could be asked.
    """
    areas = [np.full(len(states), np.nan)]
    for attacker in attackers:
        kept = attacker.usable[rows]
        if kept.any():
            areas.append(held_out_values(attacker, rows[kept], states[:, kept], specimen[kept], folds[:, kept]))
    return np.asarray(np.fmax.reduce(areas))
