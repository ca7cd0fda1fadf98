"""Layers and clusters of pits: drawn pits of a state, and what cannot be."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from siggen.config import ClusteredPits, LayeredPits
from siggen.errors import Problem
from siggen.gears.damage.heights import flank_heights
from siggen.gears.damage.layouts import clustered_centres, layered_centres
from siggen.gears.damage.pit import Pit
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import at, bounds
from siggen.specimen.damage_kind import DamageKind, heights_m
from siggen.specimen.growth import MM, Growth
from siggen.specimen.single_pits import PitPlace, drawn_height_m, drawn_pit, largest_pit, pit_place_problems


def _layered_pits(model: LayeredPits, growth: Growth) -> Damage:
    """Return the pits that a state adds to its layers, tooth by tooth."""
    return tuple(
        pit for tooth in growth.teeth(model) for pit in _pits(model, growth, tooth, _layered(model, growth, tooth))
    )


def _clustered_pits(model: ClusteredPits, growth: Growth) -> Damage:
    """Return the pits that a state adds to its cluster, tooth by tooth."""
    found: list[Pit] = []
    for tooth in growth.teeth(model):
        present = sum(pit.gear == model.gear and pit.tooth == tooth for pit in growth.before)
        found += _pits(model, growth, tooth, _clustered(model, growth, tooth, max(model.count - present, 0)))
    return tuple(found)


def _pits(
    model: LayeredPits | ClusteredPits, growth: Growth, tooth: int, centres: list[tuple[float, float]]
) -> Iterator[Pit]:
    for index, (height, face) in enumerate(centres):
        rng = growth.rng(f"{model.gear}.{tooth}.pit{index}")
        yield drawn_pit(model, growth.pair, tooth, height, face, rng)


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
    first = drawn_height_m(model.first_height_mm, model.height_reading, pair, model.gear, uniform("first_height_mm"))
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
        drawn_height_m(model.centre_height_mm, model.height_reading, pair, model.gear, uniform("centre_height_mm")),
        _at(model, "spread_profile_mm", uniform),
        0.0,
        pair.face_width_m,
        height_low_m=low,
        height_high_m=high,
        face_spread_m=None if model.spread_face_mm is None else _at(model, "spread_face_mm", uniform),
    )
    return list(zip(heights.tolist(), faces.tolist(), strict=True))


def _at(model: LayeredPits | ClusteredPits, key: str, uniform: Callable[[str], float]) -> float:
    """Return a length of a layout [m], drawn by the uniform of its key."""
    return MM * at(getattr(model, key), uniform(key))


def _layer_problems(pair: GearPair, damage: LayeredPits) -> Iterator[Problem]:
    for place in _layer_places(pair, damage):
        yield from pit_place_problems(pair, place)


def _layer_places(pair: GearPair, damage: LayeredPits) -> Iterator[PitPlace]:
    """Yield the outermost pits of the first and of the last row, moved outwards as far as jitter may move them."""
    jitter_m = bounds(damage.jitter_mm)[1] / 1e3
    centres_m = (
        [pair.face_width_m / 2] if damage.face_centre_mm is None else [x / 1e3 for x in bounds(damage.face_centre_mm)]
    )
    reach_m = (damage.pits_per_layer - 1) / 2 * bounds(damage.spacing_face_mm)[1] / 1e3 + jitter_m
    climb_m = (damage.layers - 1) * bounds(damage.spacing_profile_mm)[1] / 1e3
    face_key = "spacing_face_mm" if damage.pits_per_layer > 1 else "face_centre_mm"
    for first_m in heights_m(pair, damage.gear, damage.first_height_mm, damage.height_reading):
        for row, height_m in ((1, first_m - jitter_m), (damage.layers, first_m + climb_m + jitter_m)):
            for face_m in (centres_m[0] - reach_m, centres_m[-1] + reach_m):
                remark = f"outermost pit of row {row} of {damage.layers}: "
                yield PitPlace(damage.gear, height_m, face_m, damage, "first_height_mm", face_key, "depth_mm", remark)


def _widest_layers(pair: GearPair, damage: LayeredPits) -> Damage:
    height_m = heights_m(pair, damage.gear, damage.first_height_mm, damage.height_reading)[0]
    return tuple(largest_pit(damage.gear, 0, height_m, face_m, damage) for face_m in _row_faces_m(pair, damage))


def _row_faces_m(pair: GearPair, damage: LayeredPits) -> list[float]:
    centre_m = pair.face_width_m / 2 if damage.face_centre_mm is None else bounds(damage.face_centre_mm)[0] / 1e3
    spacing_m = bounds(damage.spacing_face_mm)[1] / 1e3
    return [centre_m + (i - (damage.pits_per_layer - 1) / 2) * spacing_m for i in range(damage.pits_per_layer)]


def _cluster_problems(pair: GearPair, damage: ClusteredPits) -> Iterator[Problem]:
    middle_m, keys = pair.face_width_m / 2, ("centre_height_mm", "spread_face_mm", "depth_mm")
    for height_m in heights_m(pair, damage.gear, damage.centre_height_mm, damage.height_reading):
        yield from pit_place_problems(pair, PitPlace(damage.gear, height_m, middle_m, damage, *keys))
    for height_m in flank_heights(pair.member(damage.gear)):
        remark = "a pit scattered to the end of the flank: "
        yield from pit_place_problems(pair, PitPlace(damage.gear, height_m, middle_m, damage, *keys, remark))


LAYERED = DamageKind(_layered_pits, _layer_problems, _widest_layers)
CLUSTERED = DamageKind(_clustered_pits, _cluster_problems, lambda *_: ())
"""How much of the width scattered pits take is known only when they are drawn."""
