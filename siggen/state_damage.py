"""The damage of one specimen in one state: configuration and draws in, a tuple of pits and spalls out.

A state holds the damage of the milder state that it grew from and adds its own up to the count that it names. What a
state adds is drawn by a generator of its own, so the damage of a state does not depend on which others are simulated.
A spall that grows from a spall is drawn by the generator of the first one: its centre stays and its sizes keep their
rank. What a grown spall hides is no damage of its own any more.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeGuard

import numpy as np

from siggen.config import (
    ClusteredPits,
    Config,
    DamageModel,
    LayeredPits,
    ListedPit,
    ListedPits,
    Number,
    Spalls,
    at,
    draw,
)
from siggen.gears.damage import Damage, Pit, Spall, flank_heights, hides_damage
from siggen.gears.geometry import GearPair
from siggen.gears.layouts import clustered_centres, layered_centres
from siggen.gears.spur_gear import SpurGear
from siggen.seeding import Stage, generator
from siggen.spall_physics import spall_on_tooth
from siggen.specimen_physics import pit_height_m

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
    rng = generator(config.seed, Stage.DAMAGE, specimen_id, state_id)
    if isinstance(damage_model, ListedPits):
        return _united(before, _listed(damage_model, pair, rng))
    if isinstance(damage_model, Spalls):
        return _united(before, _spalls(config, specimen_id, pair, damage_model, state_id))
    return _united(before, tuple(_grown(config, specimen_id, pair, damage_model, milder, before, rng)))


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


def _spalls(config: Config, specimen_id: int, pair: GearPair, model: Spalls, state_id: int) -> Damage:
    """Return a spall on each damaged tooth, with the draws of the first spall that it has grown from."""
    first, milder = state_id, config.grown_from(state_id)
    while milder is not None:
        older = config.states[milder].damage
        if isinstance(older, Spalls) and older.gear == model.gear:
            first = milder
        milder = config.grown_from(milder)
    rng = generator(config.seed, Stage.DAMAGE, specimen_id, first)
    teeth = damaged_teeth(config, specimen_id, pair.member(model.gear), model)
    return tuple(spall_on_tooth(pair, draw(model, rng), model.height_reading, tooth) for tooth in teeth)


def _grown(
    config: Config,
    specimen_id: int,
    pair: GearPair,
    model: LayeredPits | ClusteredPits,
    milder: int | None,
    before: Damage,
    rng: np.random.Generator,
) -> Iterator[Pit]:
    """Yield the pits that this state adds, tooth by tooth."""
    gear = pair.member(model.gear)
    for tooth in damaged_teeth(config, specimen_id, gear, model):
        if isinstance(model, LayeredPits):
            taken = _taken_slots(config, specimen_id, gear, model.gear, milder, tooth)
            centres = _layered(model, pair, taken, rng)
        else:
            present = sum(pit.gear == model.gear and pit.tooth == tooth for pit in before)
            centres = _clustered(model, pair, max(model.count - present, 0), rng)
        for height, face in centres:
            yield _pit(model, pair, tooth, height, face, rng)


def _taken_slots(
    config: Config, specimen_id: int, gear: SpurGear, which: str, state_id: int | None, tooth: int
) -> set[tuple[int, int]]:
    """Return the places (layer, column) of a tooth that the milder states' layers have taken."""
    taken: set[tuple[int, int]] = set()
    while state_id is not None:
        model = config.states[state_id].damage
        if _layers_on(model, which) and tooth in damaged_teeth(config, specimen_id, gear, model):
            taken |= {(i, j) for i in range(model.layers) for j in range(model.pits_per_layer)}
        state_id = config.grown_from(state_id)
    return taken


def _layers_on(model: DamageModel | None, which: str) -> TypeGuard[LayeredPits]:
    return isinstance(model, LayeredPits) and model.gear == which


def _layered(
    model: LayeredPits, pair: GearPair, taken: set[tuple[int, int]], rng: np.random.Generator
) -> list[tuple[float, float]]:
    """Return the centres [m] of the free places of the layers; columns of a layer count from its middle outwards."""
    first = _height(model.first_height_mm, model.height_reading, pair, model.gear, rng)
    middle = _face_centre(model.face_centre_mm, pair, rng)
    spacing_face, spacing_height, jitter = (
        MM * at(n, rng.random()) for n in (model.spacing_face_mm, model.spacing_profile_mm, model.jitter_mm)
    )
    # An even number of columns is centred between two of them; states of equal parity nest exactly.
    even = model.pits_per_layer % 2 == 0
    heights, faces = layered_centres(
        model.layers, model.pits_per_layer, spacing_face, spacing_height, first, middle, between=even
    )
    moved = jitter * (2.0 * rng.random((2, heights.size)) - 1.0)
    slots = [(i, j) for i in range(model.layers) for j in range(model.pits_per_layer)]
    return [
        (float(h), float(w))
        for slot, h, w in zip(slots, heights + moved[0], faces + moved[1], strict=True)
        if slot not in taken
    ]


def _clustered(model: ClusteredPits, pair: GearPair, count: int, rng: np.random.Generator) -> list[tuple[float, float]]:
    """Return centres [m] scattered around a height, over the face or around its middle."""
    height = _height(model.centre_height_mm, model.height_reading, pair, model.gear, rng)
    spread = MM * at(model.spread_profile_mm, rng.random())
    spread_face = None if model.spread_face_mm is None else MM * at(model.spread_face_mm, rng.random())
    if count == 0:
        return []
    low, high = flank_heights(pair.member(model.gear))
    heights, faces = clustered_centres(
        rng,
        count,
        height,
        spread,
        0.0,
        pair.face_width_m,
        height_low_m=low,
        height_high_m=high,
        face_spread_m=spread_face,
    )
    return list(zip(heights.tolist(), faces.tolist(), strict=True))


def _listed(model: ListedPits, pair: GearPair, rng: np.random.Generator) -> Damage:
    pits = tuple(
        _pit(
            pit,
            pair,
            pit.tooth,
            _height(pit.height_mm, model.height_reading, pair, pit.gear, rng),
            MM * at(pit.face_mm, rng.random()),
            rng,
        )
        for pit in model.pits
    )
    reading = model.height_reading
    return (*pits, *(spall_on_tooth(pair, draw(spall, rng), reading, spall.tooth) for spall in model.spalls))


def _height(height_mm: Number | str, reading: str, pair: GearPair, which: str, rng: np.random.Generator) -> float:
    """Return the axial height [m] of a drawn height; a uniform is taken even for 'pitch'."""
    u = rng.random()
    return pit_height_m(pair, which, height_mm if isinstance(height_mm, str) else at(height_mm, u), reading)


def _face_centre(face_mm: Number | None, pair: GearPair, rng: np.random.Generator) -> float:
    u = rng.random()  # taken even for the default, so that later draws stay in place
    return 0.5 * pair.face_width_m if face_mm is None else MM * at(face_mm, u)


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
