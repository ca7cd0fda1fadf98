"""The configuration of one gearbox: what is drawn as a whole (gear pair, damaged gear, teeth, oil) put in its place.

All that follows reads it as if a user had written a file for this one gearbox. So nothing behind it knows of sets with
many pairs, and a configuration without such draws stays as it is.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from siggen.config import Config
from siggen.planning.drawn_parts import with_drawn_parts
from siggen.planning.lived import Lived, lived, lived_states
from siggen.rig.carried_over import carried_over
from siggen.seeding import Stage, generator


def gearbox_config(config: Config, specimen_id: int) -> Config:
    """Return the configuration of one gearbox; depends on configuration and index alone, and is itself its own."""
    return _drawn(config, specimen_id) if config.life is None else _inspected(config, specimen_id)


def _drawn(config: Config, specimen_id: int) -> Config:
    index = pair_of(config, specimen_id)
    return with_drawn_parts(config if index is None else pair_config(config, index), specimen_id)


@lru_cache(maxsize=16)
def _inspected(config: Config, specimen_id: int) -> Config:
    """Return the configuration of a gearbox whose inspections are states, as if a user had listed all outlines."""
    assert config.life is not None
    states = lived_states(config.life, gearbox_life(config, specimen_id))
    return _drawn(config, specimen_id).model_copy(update={"life": None, "states": states})


@lru_cache(maxsize=1024)
def gearbox_life(config: Config, specimen_id: int) -> Lived:
    """Return the life of a gearbox of a set with a section `life`."""
    return lived(_drawn(config, specimen_id), config.gears, specimen_id)


def inspection_count(config: Config, specimen_id: int) -> int:
    """Return how many states a gearbox has: all, or with `life` as many inspections as it lives to see."""
    return config.state_count if config.life is None else len(gearbox_life(config, specimen_id).ages_h)


@lru_cache(maxsize=64)
def pair_config(config: Config, index: int) -> Config:
    """Return the configuration of the gearboxes with one of the pairs of `gears.pairs`."""
    sections: dict[str, Any] = {name: getattr(config, name) for name in type(config).model_fields}
    return config.model_copy(update=carried_over(sections, config.gears.pairs[index]))


def pair_configs(config: Config) -> Iterator[Config]:
    """Yield the configuration of each pair of a set; the configuration itself where it has one pair."""
    if not config.gears.pairs:
        yield config
    yield from (pair_config(config, index) for index in range(len(config.gears.pairs)))


def pair_of(config: Config, specimen_id: int) -> int | None:
    """Return the index in `gears.pairs` of a gearbox's pair, or None without pairs.

    Every pair occurs once in every block of as many gearboxes, in an order that is drawn for the block.
    """
    count = len(config.gears.pairs)
    if not count:
        return None
    block, place = divmod(specimen_id, count)
    return _order(config.seed, count, block)[place]


@lru_cache(maxsize=256)
def _order(seed: int, count: int, block: int) -> tuple[int, ...]:
    return tuple(generator(seed, Stage.PAIR_ORDER, block).permutation(count).tolist())
