"""The damage of one specimen in one state: configuration and draws in, a tuple of pits and spalls out.

A state holds the damage of the milder state that it grew from and adds its own up to the count that it names. What a
state adds is drawn by generators of its own, so the damage of a state does not depend on which others are simulated.
Where a layout lies is drawn once, for the state in which it began. A spall that grows from a spall has the draws of the
first one: its centre stays and its sizes keep their rank. What a grown spall hides is no damage of its own any more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from siggen.config import (
    ClusteredPits,
    Config,
    LayeredPits,
    ListedPit,
    ListedPits,
    Number,
    Spalls,
    at,
    draw,
)
from siggen.gears.damage.flank_damage import Damage, Pit, Spall, flank_heights, hides_damage
from siggen.gears.damage.layouts import clustered_centres, layered_centres
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.seeding import Stage, generator, named_generator, named_uniforms
from siggen.specimen.gears import pit_height_m
from siggen.specimen.spalls import spall_on_tooth

MM = 1e-3


def state_damage(config: Config, specimen_id: int, pair: GearPair, state_id: int) -> Damage:
    """Return all pits and spalls of a specimen in a state, those of the milder state first.

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
    damage_model = config.states[state_id].damage
    if damage_model is None:
        return ()
    milder = config.grown_from(state_id)
    before = () if milder is None else state_damage(config, specimen_id, pair, milder)
    growth = Growth(config, specimen_id, pair, state_id)
    if isinstance(damage_model, ListedPits):
        return _united(before, _listed(damage_model, growth))
    if isinstance(damage_model, Spalls):
        return _united(before, _spalls(damage_model, growth))
    return _united(before, tuple(_grown(damage_model, growth, before)))


@dataclass(frozen=True, slots=True)
class Growth:
    """A state of one specimen, and where its draws come from.

    What places a layout belongs to the state in which the damage of that gear began, so that it does not wander while
    it grows; what a state adds belongs to that state.
    """

    config: Config
    specimen_id: int
    pair: GearPair
    state_id: int

    def place(self, gear: str, kind: type) -> Callable[[str], float]:
        """Return path -> uniform of the first state of this growth that has such damage on the gear."""
        first, state_id = self.state_id, self.config.grown_from(self.state_id)
        while state_id is not None:
            older = self.config.states[state_id].damage
            if isinstance(older, kind) and getattr(older, "gear", None) == gear:
                first = state_id
            state_id = self.config.grown_from(state_id)
        return named_uniforms(self.config.seed, Stage.DAMAGE, self.specimen_id, first)

    def rng(self, name: str) -> np.random.Generator:
        """Return the generator of one thing that this state adds."""
        return named_generator(self.config.seed, Stage.DAMAGE, self.specimen_id, self.state_id, name=name)

    def teeth(self, model: LayeredPits | ClusteredPits | Spalls) -> tuple[int, ...]:
        """Return the teeth that a damage model hits."""
        return damaged_teeth(self.config, self.specimen_id, self.pair.member(model.gear), model)


def damaged_teeth(
    config: Config, specimen_id: int, gear: SpurGear, damage_model: LayeredPits | ClusteredPits | Spalls
) -> tuple[int, ...]:
    """Return the teeth that are hit: the listed ones, or neighbours from a tooth drawn once per specimen and gear."""
    if isinstance(damage_model.teeth, tuple):
        return damage_model.teeth
    draws = generator(config.seed, Stage.DAMAGED_TEETH, specimen_id).random(2)
    first = int(draws[("pinion", "gear").index(damage_model.gear)] * gear.teeth)
    return tuple((first + i) % gear.teeth for i in range(damage_model.teeth))


def _united(before: Damage, new: Damage) -> Damage:
    spalls = [one for one in new if isinstance(one, Spall)]
    left = (pit for pit in before if pit in new or not any(hides_damage(spall, pit) for spall in spalls))
    return (*left, *(pit for pit in new if pit not in before))


def _spalls(model: Spalls, growth: Growth) -> Damage:
    """Return a spall on each damaged tooth, with the draws of the first spall that it has grown from."""
    uniform = growth.place(model.gear, Spalls)
    return tuple(
        spall_on_tooth(growth.pair, draw(model, uniform, f"spall.{model.gear}.{tooth}"), model.height_reading, tooth)
        for tooth in growth.teeth(model)
    )


def _grown(model: LayeredPits | ClusteredPits, growth: Growth, before: Damage) -> Iterator[Pit]:
    """Yield the pits that this state adds, tooth by tooth."""
    for tooth in growth.teeth(model):
        if isinstance(model, LayeredPits):
            centres = _layered(model, growth, tooth)
        else:
            present = sum(pit.gear == model.gear and pit.tooth == tooth for pit in before)
            centres = _clustered(model, growth, tooth, max(model.count - present, 0))
        for index, (height, face) in enumerate(centres):
            rng = growth.rng(f"{model.gear}.{tooth}.pit{index}")
            yield _pit(model, growth.pair, tooth, height, face, rng)


def _milder_layers(growth: Growth, gear: str, tooth: int) -> list[LayeredPits]:
    """Return the layers that milder states of this growth have on a tooth, the nearest state first."""
    found = []
    state_id = growth.config.grown_from(growth.state_id)
    while state_id is not None:
        model = growth.config.states[state_id].damage
        if isinstance(model, LayeredPits) and model.gear == gear and tooth in growth.teeth(model):
            found.append(model)
        state_id = growth.config.grown_from(state_id)
    return found


def _layered(model: LayeredPits, growth: Growth, tooth: int) -> list[tuple[float, float]]:
    """Return the centres [m] of the free places of the layers; columns of a layer count from its middle outwards."""
    milder = _milder_layers(growth, model.gear, tooth)
    uniform, pair = growth.place(model.gear, LayeredPits), growth.pair
    first = _height(model.first_height_mm, model.height_reading, pair, model.gear, uniform("first_height_mm"))
    middle = 0.5 * pair.face_width_m if model.face_centre_mm is None else _at(model, "face_centre_mm", uniform)
    # An even number of columns is centred between two of them; what grows keeps the lattice that it began on.
    between = (milder[-1] if milder else model).pits_per_layer % 2 == 0
    heights, faces = layered_centres(
        model.layers,
        model.pits_per_layer,
        _at(model, "spacing_face_mm", uniform),
        _at(model, "spacing_profile_mm", uniform),
        first,
        middle,
        between=between,
    )
    shifts = 2.0 * growth.rng(f"{model.gear}.{tooth}.jitter").random((heights.size, 2)) - 1.0
    moved = np.stack([heights, faces], axis=1) + _at(model, "jitter_mm", uniform) * shifts
    slots = [(i, j) for i in range(model.layers) for j in range(model.pits_per_layer)]
    taken = {(i, j) for m in milder for i in range(m.layers) for j in range(m.pits_per_layer)}
    return [(float(h), float(w)) for slot, (h, w) in zip(slots, moved, strict=True) if slot not in taken]


def _clustered(model: ClusteredPits, growth: Growth, tooth: int, count: int) -> list[tuple[float, float]]:
    """Return centres [m] scattered around a height, over the face or around its middle."""
    if count == 0:
        return []
    uniform, pair = growth.place(model.gear, ClusteredPits), growth.pair
    low, high = flank_heights(pair.member(model.gear))
    heights, faces = clustered_centres(
        growth.rng(f"{model.gear}.{tooth}.centres"),
        count,
        _height(model.centre_height_mm, model.height_reading, pair, model.gear, uniform("centre_height_mm")),
        _at(model, "spread_profile_mm", uniform),
        0.0,
        pair.face_width_m,
        height_low_m=low,
        height_high_m=high,
        face_spread_m=None if model.spread_face_mm is None else _at(model, "spread_face_mm", uniform),
    )
    return list(zip(heights.tolist(), faces.tolist(), strict=True))


def _listed(model: ListedPits, growth: Growth) -> Damage:
    return (*_listed_pits(model, growth), *_listed_spalls(model, growth))


def _listed_pits(model: ListedPits, growth: Growth) -> Iterator[Pit]:
    for index, pit in enumerate(model.pits):
        rng = growth.rng(f"list.pit{index}")
        height = _height(pit.height_mm, model.height_reading, growth.pair, pit.gear, rng.random())
        yield _pit(pit, growth.pair, pit.tooth, height, MM * at(pit.face_mm, rng.random()), rng)


def _listed_spalls(model: ListedPits, growth: Growth) -> Iterator[Spall]:
    uniform = named_uniforms(growth.config.seed, Stage.DAMAGE, growth.specimen_id, growth.state_id)
    for index, spall in enumerate(model.spalls):
        drawn = draw(spall, uniform, f"list.spall{index}")
        yield spall_on_tooth(growth.pair, drawn, model.height_reading, spall.tooth)


def _height(height_mm: Number | str, reading: str, pair: GearPair, which: str, u: float) -> float:
    """Return the axial height [m] of a height as the configuration states it, drawn by the uniform `u`."""
    return pit_height_m(pair, which, height_mm if isinstance(height_mm, str) else at(height_mm, u), reading)


def _at(model: LayeredPits | ClusteredPits, key: str, uniform: Callable[[str], float]) -> float:
    """Return a length of a layout [m], drawn by the uniform of its key."""
    return MM * at(getattr(model, key), uniform(key))


def _pit(
    size: LayeredPits | ClusteredPits | ListedPit,
    pair: GearPair,
    tooth: int,
    height_m: float,
    face_m: float,
    rng: np.random.Generator,
) -> Pit:
    """Return a pit with its own sizes; a centre that a random shift took off the flank is put on its edge."""
    low, high = flank_heights(pair.member(size.gear))
    semi_face, semi_profile, depth = (
        MM * at(n, rng.random()) for n in (size.semi_axis_face_mm, size.semi_axis_profile_mm, size.depth_mm)
    )
    return Pit(
        gear=size.gear,
        tooth=tooth,
        height_m=min(max(height_m, low), high),
        face_m=min(max(face_m, 0.0), pair.face_width_m),
        semi_axis_face_m=semi_face,
        semi_axis_profile_m=semi_profile,
        depth_m=depth,
        floor=size.floor,
    )
