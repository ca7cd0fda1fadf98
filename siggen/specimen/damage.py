"""The damage of one specimen in one state: configuration and draws in, a tuple of damages of single teeth out.

A state holds the damage of the milder state that it grew from and adds its own up to the count that it names. A spall
that grows from a spall has the draws of the first one: its centre stays and its sizes keep their rank. What a grown
spall hides is no damage of its own any more.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from siggen.config import ClusteredPits, Config, DamageModel, LayeredPits, ListedPits, Spalls
from siggen.config.irregular import IrregularSpalls
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.planning.gearbox import gearbox_config
from siggen.specimen.damage_kind import DamageKind
from siggen.specimen.growth import Growth
from siggen.specimen.irregular import IRREGULAR
from siggen.specimen.listed import LISTED
from siggen.specimen.pits import CLUSTERED, LAYERED
from siggen.specimen.spalls import SPALLS

KINDS: dict[type, DamageKind] = {
    LayeredPits: LAYERED,
    ClusteredPits: CLUSTERED,
    Spalls: SPALLS,
    ListedPits: LISTED,
    IrregularSpalls: IRREGULAR,
}
"""Section of the configuration -> how it is drawn and checked; the one list of kinds behind `siggen.config.damage`."""


def kind_of(model: DamageModel) -> DamageKind:
    """Return the kind of a section of damage."""
    return KINDS[type(model)]


def state_damage(config: Config, specimen_id: int, pair: GearPair, state_id: int) -> Damage:
    """Return all damage of a specimen in a state, those of the milder state first.

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
    config: Config, specimen_id: int, pair: GearPair, state_id: int, milder_damage: Callable[[int], Damage]
) -> Damage:
    """Return `state_damage`, with that of the milder state from `milder_damage`, which takes its number."""
    config = gearbox_config(config, specimen_id)
    damage_model = config.states[state_id].damage
    if damage_model is None:
        return ()
    milder = config.grown_from(state_id)
    before = () if milder is None else milder_damage(milder)
    growth = Growth(config, specimen_id, pair, state_id, before)
    return _united(before, kind_of(damage_model).draw(damage_model, growth))


def _united(before: Damage, new: Damage) -> Damage:
    left = (old for old in before if old in new or not any(one.hides(old) for one in new))
    return (*left, *(one for one in new if one not in before))
