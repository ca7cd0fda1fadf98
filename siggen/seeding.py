"""Random generators keyed by what a draw belongs to; the only place that makes one."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from enum import IntEnum
from functools import lru_cache

import numpy as np


class Stream(IntEnum):
    """Consumers of randomness. Integers are part of every data set's identity: never renumber."""

    SPLIT = 1
    """Of a block of 20 specimens: train, validation, test."""
    GEARS = 2
    """Of a specimen: sections `gears`, `stiffness`, `machine`."""
    SUPPORTS = 3
    """Of a specimen: section `dynamics`."""
    SENSOR = 4
    """Of a specimen: section `sensors`."""
    OPERATING_POINT = 5
    """Of a specimen and operating point: speed, torque."""
    DAMAGED_TEETH = 6
    """Of a specimen."""
    DAMAGE = 7
    """Of a specimen and the number of a state: what this state adds to the damage of the milder one."""
    START = 8
    """Of a specimen, number of a state, operating point and repeat: start angle."""
    NOISE = 9
    """Of the same: floor, hum and tones of sensors, with a background their levels per gearbox."""
    MANUFACTURE = 10
    """Of a specimen and the number of a state, 0 if all states share their gears: errors of the teeth."""
    PATH = 11
    """Of a specimen: modes and shapes of the housing, other machines."""
    DRIVE = 12
    """As START: course of speed and torque, cage slip."""
    FORCE_NOISE = 13
    """As START: noise of bearing forces."""
    BEARING_TONES = 14
    """Of a specimen."""
    BACKGROUND = 15
    """Of a specimen: numbers, phases and levels of its background."""
    BACKGROUND_NOISE = 16
    """As START: noise and bursts."""
    PAIRS = 17
    """Of a pair, by the seed of `gears.pairs`: teeth, module and face width of a pair given as ranges."""
    PAIR_ORDER = 18
    """Of a block of as many specimens as pairs: which gearbox has which pair."""
    LIFE = 19
    """Of a specimen: everything of its life."""
    STREAM_ORDER = 20
    """Of the gearboxes that a stream mixes: the order of their records."""


OWNER_KEYS: dict[Stream, int] = {
    Stream.SPLIT: 1,
    Stream.GEARS: 1,
    Stream.SUPPORTS: 1,
    Stream.SENSOR: 1,
    Stream.OPERATING_POINT: 2,
    Stream.DAMAGED_TEETH: 1,
    Stream.DAMAGE: 2,
    Stream.START: 4,
    Stream.NOISE: 4,
    Stream.MANUFACTURE: 2,
    Stream.DRIVE: 4,
    Stream.BEARING_TONES: 1,
    Stream.PATH: 1,
    Stream.FORCE_NOISE: 4,
    Stream.BACKGROUND: 1,
    Stream.BACKGROUND_NOISE: 4,
    Stream.PAIRS: 1,
    Stream.PAIR_ORDER: 1,
    Stream.LIFE: 1,
    Stream.STREAM_ORDER: 1,
}
"""Number of owner keys per stage; fixed, since (1,) and (1, 0) are different streams."""


def generator(seed: int, stage: Stream, *owner: int) -> np.random.Generator:
    """Return the generator of one stage and owner; the same arguments always give the same stream.

    Raises
    ------
    ValueError
        If the number of owner keys is not the one fixed for the stage.
    """
    _check_owner(stage, owner)
    return _philox(seed, int(stage), *owner)


def named_generator(seed: int, stage: Stream, *owner: int, name: str) -> np.random.Generator:
    """Return the generator of one named thing of an owner, such as a channel; other names never shift its stream.

    Raises
    ------
    ValueError
        If the number of owner keys is not the one fixed for the stage.
    """
    _check_owner(stage, owner)
    return _philox(seed, int(stage), *owner, _key(name))


def named_uniforms(seed: int, stage: Stream, *owner: int) -> Callable[[str], float]:
    """Return a function from names (paths of configuration keys) to uniforms in [0, 1) that belong to one owner.

    A name's uniform depends on nothing but seed, stage, owner and the name itself, so keys may be added anywhere later.
    """
    _check_owner(stage, owner)
    return lambda name: _uniform(seed, int(stage), owner, name)


@lru_cache(maxsize=4096)
def _uniform(seed: int, stage: int, owner: tuple[int, ...], name: str) -> float:
    """Return the first uniform of a stream; making the stream costs a hundred times more than drawing from it."""
    return float(_philox(seed, stage, *owner, _key(name)).random())


def _key(name: str) -> int:
    """Return 64 bits of the name, the highest one set: always two words, so that no name can look like an index."""
    return int.from_bytes(hashlib.sha256(name.encode()).digest()[:8]) | 1 << 63


def _check_owner(stage: Stream, owner: tuple[int, ...]) -> None:
    if len(owner) != OWNER_KEYS[stage]:
        raise ValueError(f"stage {stage.name} takes {OWNER_KEYS[stage]} owner keys, received {owner}")


def _philox(seed: int, *key: int) -> np.random.Generator:
    return np.random.Generator(np.random.Philox(np.random.SeedSequence(seed, spawn_key=key)))
