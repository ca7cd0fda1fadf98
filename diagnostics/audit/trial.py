"""One trial of an attacker: which records it learns from, and which it then has to tell apart.

All permutations of the states are one trial: ranks, products and their decompositions do not depend on the states, so
that hundreds of permutations cost little more than one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Trial:
    """Healthy records and those of one state, some of them to learn from.

    Attributes
    ----------
    rows : (n,) int
        Records of the set.
    positive : (turns, n) bool
        Which of them are damaged, one row for each way of stating it; in every row both classes stand on both sides.
    specimen : (n,) int
        Their gearboxes.
    train : (n,) bool
        Which of them may be learnt from; whole gearboxes.
    deal, fold : int
        Which trial of how many this is.
    """

    rows: np.ndarray
    positive: np.ndarray
    specimen: np.ndarray
    train: np.ndarray
    deal: int
    fold: int


@dataclass(frozen=True, slots=True)
class Verdicts:
    """What an attacker says of the records that it has not learnt from.

    Attributes
    ----------
    score : (turns, n not learnt from) float64
    basis : str
        What the scores of the first row rest on, such as a band; empty where all counts.
    """

    score: np.ndarray
    basis: str = ""


@dataclass(frozen=True, slots=True)
class Attacker:
    """A way of telling states.

    Attributes
    ----------
    name : str
        What it is called in tables.
    attack : callable
        Verdicts of a trial.
    usable : (records,) bool
        Records that it can be asked about.
    tried : int
        Columns or features that it chooses from or weighs.
    deals : int
        Deals of the gearboxes into folds that it can afford.
    permutable : bool
        Whether it is cheap enough for permuted states.
    """

    name: str
    attack: Callable[[Trial], Verdicts]
    usable: np.ndarray
    tried: int
    deals: int
    permutable: bool = True
