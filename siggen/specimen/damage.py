"""The damage of one specimen in one state: configuration and draws in, its parts out.

A state holds the damage of the milder state that it grew from and adds its own up to the count that it names. A spall
that grows from a spall has the draws of the first one: its centre stays and its sizes keep their rank. What a grown
spall hides is no damage of its own any more. Nor is what lies wholly on metal that a chip took, before it or after it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from siggen.config import Config
from siggen.faults.fault import Fault
from siggen.faults.growth import Growth
from siggen.gears.damage.flank_loss import takes_from_flanks, with_outlines
from siggen.gears.damage.part import Part, Parts
from siggen.gears.damage.tooth_damage import goes_through
from siggen.gears.damage.wear import LoadAtRest
from siggen.gears.geometry.gear_pair import GearPair
from siggen.planning.gearbox import gearbox_config
from siggen.planning.specimen import draw_specimen
from siggen.planning.stages import first_mesh
from siggen.specimen.worn_loads import load_at_rest


def state_damage(config: Config, specimen_id: int, pair: GearPair, state_id: int) -> Parts:
    """Return all parts of a specimen's damage in a state, those of the milder state first.

    Parameters
    ----------
    config : Config
    specimen_id, state_id : int
    pair : GearPair, the drawn gears of this specimen

    Raises
    ------
    ValueError
        If a height in the configuration lies below the base circle of the drawn gear.
    """
    return grown_damage(config, specimen_id, pair, state_id, partial(state_damage, config, specimen_id, pair))


def grown_damage(
    config: Config, specimen_id: int, pair: GearPair, state_id: int, milder_damage: Callable[[int], Parts]
) -> Parts:
    """Return `state_damage`, with that of the milder state from `milder_damage`, which takes its number."""
    config = first_mesh(gearbox_config(config, specimen_id))
    state = config.states[state_id]
    milder, older = tuple(_milder(config, state_id)), config.grown_from(state_id)
    before = () if older is None else milder_damage(older)
    loads = partial(_load_at_rest, config, specimen_id, pair)
    growth = Growth(config.seed, specimen_id, state_id, pair, milder, before, loads)
    parts = before
    for section in sorted(state.damages, key=_rank):  # whatever order they were written in
        parts = _united(parts, section.drawn(growth), pair)
    return tuple(one.sham() for one in parts) if state.sham else parts


def _load_at_rest(config: Config, specimen_id: int, pair: GearPair, force_n: float) -> LoadAtRest:
    """Return how the gears of a specimen share a force; what is drawn for it waits until a kind of damage asks."""
    specimen = draw_specimen(config, specimen_id)
    return load_at_rest(specimen.law, pair, specimen.meshes[0].options, force_n)


def _rank(section: Fault) -> str:
    return section.model_dump_json()


def _milder(config: Config, state_id: int) -> Iterator[tuple[int, object]]:
    """Yield the states that a state has grown from with their sections of damage, the nearest first."""
    older = config.grown_from(state_id)
    while older is not None:
        yield from ((older, section) for section in config.states[older].damages)
        older = config.grown_from(older)


def _united(before: Parts, new: Parts, pair: GearPair) -> Parts:
    """Return old parts that nothing hides, and new ones on metal that is there still; orders of sections agree."""
    left = tuple(old for old in before if old in new or not any(_hides(one, old, pair) for one in new))
    gone = [old for old in left if any(goes_through(shown) for shown in with_outlines((old,), pair))]
    return (
        *left,
        *(one for one in new if one not in before and not any(_hides(lost, one, pair) for lost in gone)),
    )


def _hides(one: Part, other: Part, pair: GearPair) -> bool:
    """Return whether a part hides another one, by itself or by what shows of both on the flanks of a pair."""
    if one.hides(other):
        return True
    if not (takes_from_flanks(one) or takes_from_flanks(other)):
        return False
    below = with_outlines((other,), pair)
    return bool(below) and all(any(shown.hides(it) for shown in with_outlines((one,), pair)) for it in below)
