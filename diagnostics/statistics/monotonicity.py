"""Whether an indicator rises from state to state: mean sign of its steps over the severity ladder.

Each ladder is one specimen at one operating point and repeat, its records in order of damaged area. 1: every step up;
-1: every step down; 0: as often up as down. Source: Coble & Hines 2009 (there its magnitude), standard literature.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np


def ladder_steps(ladders: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows before and after each step of all ladders, (k,) int each.

    Parameters
    ----------
    ladders : sequence of (m,) int
        Rows of each ladder in order of severity.
    """
    pairs = [(int(a), int(b)) for rows in ladders for a, b in pairwise(rows)]
    found = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    return found[:, 0], found[:, 1]


def monotonicity(steps: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the weighted mean sign of the steps, (b,); NaN without weight.

    Parameters
    ----------
    steps : (k,) float64
        Value after minus value before each step, without NaN.
    weights : (b, k) float64
        Weights of the steps, those of their specimens.
    """
    total = weights.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(weights @ np.sign(steps) / total)
