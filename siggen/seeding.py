"""Random generators keyed by what a draw belongs to; the only place that makes one."""

from __future__ import annotations

from enum import IntEnum

import numpy as np


class Stage(IntEnum):
    """Consumers of randomness. Integers are part of every data set's identity: never renumber."""

    SPLIT = 1
    GEARS = 2
    SUPPORTS = 3
    SENSOR = 4
    OPERATING_POINT = 5
    DAMAGED_TEETH = 6
    DAMAGE = 7
    START = 8
    NOISE = 9


OWNER_KEYS: dict[Stage, int] = {
    Stage.SPLIT: 1,
    Stage.GEARS: 1,
    Stage.SUPPORTS: 1,
    Stage.SENSOR: 1,
    Stage.OPERATING_POINT: 2,
    Stage.DAMAGED_TEETH: 1,
    Stage.DAMAGE: 2,
    Stage.START: 4,
    Stage.NOISE: 4,
}
"""Number of owner keys per stage; fixed, since (1,) and (1, 0) are different streams."""


def generator(seed: int, stage: Stage, *owner: int) -> np.random.Generator:
    """Return the generator of one stage and owner; the same arguments always give the same stream.

    Raises
    ------
    ValueError
        If the number of owner keys is not the one fixed for the stage.
    """
    if len(owner) != OWNER_KEYS[stage]:
        raise ValueError(f"stage {stage.name} takes {OWNER_KEYS[stage]} owner keys, received {owner}")
    sequence = np.random.SeedSequence(seed, spawn_key=(int(stage), *owner))
    return np.random.Generator(np.random.Philox(sequence))
