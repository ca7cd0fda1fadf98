"""Damage of a state: growth, keyed draws, places on the flank."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.damage.flank_damage import damage_problems
from siggen.damage.heights import flank_heights
from siggen.damage.part import Damage
from siggen.gearbox.design import SetDesign
from siggen.record.teeth import all_teeth
from tests.config.minimal import by_name

PIT = {"semi_axis_face_mm": 0.3, "semi_axis_profile_mm": 0.2, "depth_mm": 0.3}
DRAWN_PIT = {
    "semi_axis_face_mm": [0.2, 0.5],
    "semi_axis_profile_mm": [0.1, 0.3],
    "depth_mm": [0.1, 0.4],
}


def config_with(*damages: Mapping[str, Any], seed: int = 5, law: str = "pairs") -> SetDesign:
    """Return a configuration whose states have these damages, each grown from the one before."""
    chain = (("slight", None), ("moderate", "slight"), ("severe", "moderate"))
    grown = ({"name": n, "grows": m, "damage": dict(d)} for (n, m), d in zip(chain, damages, strict=False))
    states = [{"name": "healthy"}, *grown]
    return load_config(
        {
            "name": "test",
            "seed": seed,
            "specimens": 4,
            "gears": {
                "module_mm": 3.0,
                "face_width_mm": 20.0,
                "pinion": {"teeth": 18, "bore_radius_mm": 10.0},
                "gear": {"teeth": 47, "bore_radius_mm": 15.0},
            },
            "dynamics": {"mesh": {"law": law}},
            "operating_points": [{"speed_hz": 30.0, "torque_nm": 60.0}],
            "states": by_name(states),
            "sensors": {"bearing": {}},
        }
    )


def damage_of(config: SetDesign, state_id: int, specimen_id: int = 0) -> Damage:
    return all_teeth(config.gearbox(specimen_id))[0].damage(state_id)


def test_healthy_state_has_no_damage() -> None:
    assert damage_of(config_with({"kind": "clustered", "count": 3, "spread_profile_mm": 0.3, **PIT}), 0) == ()


@pytest.mark.parametrize(
    "ladder",
    [
        [{"kind": "clustered", "count": n, "spread_profile_mm": 0.3, **DRAWN_PIT} for n in (4, 9, 20)],
        [
            {"kind": "layered", "layers": layers, "pits_per_layer": n, **DRAWN_PIT}
            for layers, n in ((1, 4), (1, 8), (3, 8))
        ],
        [
            {"kind": "layered", "layers": 2, "pits_per_layer": 3, **DRAWN_PIT},
            {"kind": "clustered", "count": 10, "spread_profile_mm": 0.2, "teeth": 2, **DRAWN_PIT},
        ],
    ],
    ids=["clustered", "layered", "mixed"],
)
def test_a_more_severe_state_contains_the_damage_of_the_milder_one(ladder: list[dict[str, Any]]) -> None:
    config = config_with(*ladder)
    damages = [damage_of(config, i) for i in range(1, len(ladder) + 1)]
    for milder, harder in itertools.pairwise(damages):
        assert set(milder) < set(harder)


def test_layers_fill_the_lattice_without_gaps_or_doubles() -> None:
    config = config_with(
        *({"kind": "layered", "layers": layers, "pits_per_layer": n, **PIT} for layers, n in ((2, 2), (2, 4), (3, 6)))
    )
    severe = damage_of(config, 3)
    places = {(round(p.height_m, 9), round(p.face_m, 9)) for p in severe}
    heights, faces = {h for h, _ in places}, {w for _, w in places}
    assert len(severe) == len(places) == 18
    assert places == {(h, w) for h in heights for w in faces}


def test_the_damaged_tooth_differs_between_specimens_and_stays_in_all_states() -> None:
    config = config_with(*({"kind": "clustered", "count": n, "spread_profile_mm": 0.3, **PIT} for n in (4, 9)))
    teeth = [{p.tooth for p in damage_of(config, state, specimen)} for specimen in range(4) for state in (1, 2)]
    assert all(a == b for a, b in zip(teeth[::2], teeth[1::2], strict=True))
    assert len(set.union(*teeth)) > 1


def test_drawn_centres_lie_on_the_flank_however_wide_the_scatter() -> None:
    config = config_with({"kind": "clustered", "count": 200, "spread_profile_mm": 3.0, **PIT})
    pair = config.gearbox(0).pair
    low, high = flank_heights(pair.pinion)
    damage = damage_of(config, 1)
    assert all(low <= p.height_m <= high and 0 <= p.face_m <= pair.face_width_m for p in damage)


def test_listed_pits_appear_as_they_are_listed() -> None:
    pits = [
        {"gear": "pinion", "tooth": 3, "height_mm": 1.5, "face_mm": 4.0, **PIT},
        {"gear": "gear", "tooth": 40, "height_mm": 2.5, "face_mm": 12.0, **PIT},
    ]
    config = config_with({"kind": "list", "pits": pits})
    damage = damage_of(config, 1)
    assert [(p.gear, p.tooth) for p in damage] == [("pinion", 3), ("gear", 40)]
    assert [p.height_m for p in damage] == pytest.approx([1.5e-3, 2.5e-3], rel=1e-15)
    assert not damage_problems(config.gearbox(0).pair, damage)


def test_growing_damage_stays_where_it_began_when_its_place_is_drawn() -> None:
    place = [1.0, 4.0]
    model = {"kind": "clustered", "spread_profile_mm": 0.01, "centre_height_mm": place, **PIT}
    config = config_with(*({**model, "count": n} for n in (4, 9, 20)))
    heights = [np.array([p.height_m for p in damage_of(config, i)]) for i in (1, 2, 3)]
    # 20 pits with a standard deviation of 0.01 mm: further than 5 of them from the first ones only if the place moved
    assert np.abs(heights[2] - heights[0].mean()).max() < 0.05e-3
    assert abs(np.mean([p.height_m for p in damage_of(config, 1, specimen_id=1)]) - heights[0].mean()) > 0.05e-3


def test_growing_layers_keep_their_lattice_even_from_odd_to_even_columns() -> None:
    place = [1.0, 4.0]
    model = {"kind": "layered", "layers": 1, "first_height_mm": place, "spacing_face_mm": 1.0, **PIT}
    severe = damage_of(config_with(*({**model, "pits_per_layer": n} for n in (3, 4, 7))), 3)
    assert len({round(p.height_m, 9) for p in severe}) == 1
    # seven neighbours one spacing apart: no gap and no half step where the number of columns was even in between
    assert np.diff(sorted(p.face_m for p in severe)) == pytest.approx([1e-3] * 6, rel=1e-9)
