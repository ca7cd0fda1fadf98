"""Random generators of the diagnostics, keyed by what a draw is for; the only place here that makes one."""

from __future__ import annotations

from enum import IntEnum

import numpy as np


class Purpose(IntEnum):
    """What a draw is for; the integers keep streams apart, so never renumber."""

    BOOTSTRAP = 1
    PERMUTATION = 2
    HALVES = 4
    LOADER = 5
    AUGMENTATION = 6
    FOLDS = 7
    CALIBRATION = 9
    AVERAGES = 10
    PATHS = 11
    LIFE_NETWORK = 12
    REPLAY = 13
    PRETRAINING = 14


def generator(seed: int, purpose: Purpose, owner: int = 0, *part: int) -> np.random.Generator:
    """Return the generator of one purpose, owner (repeat, epoch ...) and part; equal arguments give equal streams."""
    sequence = np.random.SeedSequence(seed, spawn_key=(int(purpose), owner, *part))
    return np.random.Generator(np.random.Philox(sequence))
