"""Irregular spalls of a state: growth, draws, the limit case, messages, and rows of the damage table."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from siggen.damage.heights import clipped_arc_m
from siggen.damage.irregular import IrregularSpall
from siggen.errors import ConfigError
from tests.damage.test_damage import PIT, config_with, damage_of
from tests.simulated import damage_rows

SPALL: dict[str, Any] = {"kind": "irregular", "profile_length_mm": 0.6, "face_share": 0.25}
GROWN = [
    SPALL,
    {**SPALL, "profile_length_mm": 1.0, "face_share": 0.6},
    {**SPALL, "profile_length_mm": 1.6, "face_share": 1.0},
]
STRAIGHT = {"waviness": 0.0, "skew_mm_per_10mm": 0.0}


def holds(severe: IrregularSpall, mild: IrregularSpall) -> bool:
    """Whether the outline of one lies within the other, at all stations and between."""
    (face, low, high), (wide, lowest, highest) = np.array(mild.stations_m).T, np.array(severe.stations_m).T
    places = np.union1d(
        np.union1d(face, wide[(wide >= face[0]) & (wide <= face[-1])]), np.linspace(face[0], face[-1], 401)
    )
    below = np.interp(places, wide, lowest) <= np.interp(places, face, low) + 1e-15
    above = np.interp(places, wide, highest) >= np.interp(places, face, high) - 1e-15
    return bool(wide[0] <= face[0] and wide[-1] >= face[-1] and np.all(below & above))


@given(
    seed=st.integers(0, 2**31),
    lengths=st.lists(st.floats(0.5, 1.6), min_size=3, max_size=3).map(sorted),
    shares=st.lists(st.floats(0.1, 1.0), min_size=3, max_size=3),
    waviness=st.lists(st.floats(0.0, 0.12), min_size=3, max_size=3),
    gear=st.sampled_from(["pinion", "gear"]),
)
@settings(max_examples=40, deadline=None)
def test_a_more_severe_state_holds_the_milder_one_whatever_is_drawn(
    seed: int, lengths: list[float], shares: list[float], waviness: list[float], gear: str
) -> None:
    drawn = {"skew_mm_per_10mm": [-0.1, 0.1]}
    damages = [
        {"kind": "irregular", "gear": gear, "profile_length_mm": a, "face_share": b, "waviness": c, **drawn}
        for a, b, c in zip(lengths, shares, waviness, strict=True)
    ]
    # a spall smaller than the milder one, and alike in all else, is refused (tests/config/test_growth.py)
    sizes = list(zip(lengths, waviness, shares, strict=True))
    assume(not any(mild[:2] == more[:2] and more[2] < mild[2] for mild, more in combinations(sizes, 2)))
    config = config_with(*damages, seed=seed)
    for specimen_id in range(2):
        found = [damage_of(config, state, specimen_id) for state in (3, 1, 2)]
        severe, slight, moderate = (one for (one,) in found)
        assert isinstance(severe, IrregularSpall)
        assert isinstance(moderate, IrregularSpall)
        assert isinstance(slight, IrregularSpall)
        assert holds(severe, moderate)
        assert holds(moderate, slight)
        assert severe.depth_m >= moderate.depth_m >= slight.depth_m


def test_teeth_and_gearboxes_have_outlines_of_their_own() -> None:
    config = config_with({**SPALL, "teeth": 2, "face_share": 1.0})
    shapes = {one.outline for specimen in range(3) for one in damage_of(config, 1, specimen)}
    assert len(shapes) == 6


def test_skews_are_millimetres_of_arc_over_ten_of_face() -> None:
    damage = {**SPALL, **STRAIGHT, "face_share": 1.0, "skew_mm_per_10mm": 0.2}
    config = config_with(damage)
    (one,) = damage_of(config, 1)
    pair = config.gearbox(0).pair
    first, last = one.stations_m[0], one.stations_m[-1]
    assert clipped_arc_m(pair.pinion, (first[1], last[1])) == pytest.approx(0.4e-3, rel=1e-9)
    # Edges of one skew stay as far apart as they are in the middle.
    assert one.profile_arc_m(pair.pinion) == pytest.approx(0.6e-3, rel=1e-9)


def test_it_takes_the_place_of_the_milder_one_and_leaves_pits_beside_it() -> None:
    cluster = {"kind": "clustered", "count": 4, "spread_profile_mm": 0.5, **PIT}
    config = config_with(cluster, *GROWN[1:])
    assert [one.kind for one in damage_of(config, 3)].count("spall") == 1
    assert [state.fault for state in config.config.states] == ["healthy", "pitting", "spalling", "spalling"]


def test_rows_hold_the_outline_the_edges_and_the_depth_of_every_strip() -> None:
    config = config_with({"kind": "clustered", "count": 2, "spread_profile_mm": 0.3, **PIT}, GROWN[1])
    rows = [row for record in range(3) for row in damage_rows(config, record) if row["record_id"] == 2]
    (spall,) = (row for row in rows if row["kind"] == "spall")
    (one,) = (one for one in damage_of(config, 2) if one.kind == "spall")
    assert isinstance(one, IrregularSpall)
    assert np.array(spall["polygon_face_mm"])[: len(one.stations_m)] == pytest.approx(
        1e3 * np.array(one.stations_m)[:, 0]
    )
    assert len(spall["polygon_face_mm"]) == 2 * len(one.stations_m)
    assert spall["strip_depth_mm"] == pytest.approx(1e3 * np.array(one.strip_depths_m))
    assert 0.02 <= spall["edge_radius_mm"] <= 0.2
    for row in rows:
        if row["kind"] == "pit":
            assert (row["edge_radius_mm"], row["strip_depth_mm"]) == (0.1, [])


@pytest.mark.parametrize(
    ("changes", "key", "said"),
    [
        ({"profile_length_mm": 9.0}, "profile_length_mm", "with skew and waves the edges reach from"),
        ({"profile_length_mm": 0.0}, "profile_length_mm", "allowed: a number above 0"),
        ({"face_share": 1.05}, "face_share", "allowed: a number above 0 and of at most 1"),
        ({"face_centre_mm": 1.0}, "face_share", "5 mm about 1 mm"),
        (
            {"skew_mm_per_10mm": [-2.0, 2.0]},
            "skew_mm_per_10mm",
            "the edges of 0.6 mm cross; allowed: a range of less than",
        ),
        ({"waviness": 0.3}, "waviness", "allowed: a number from 0 to 0.2"),
        ({"depth_mm": 4.0}, "depth_mm", "allowed: below the half tooth thickness there"),
        ({"centre_height_mm": 12.0}, "centre_height_mm", "a middle"),
        ({"edge_radius_mm": -0.1}, "edge_radius_mm", "received -0.1"),
        ({"teeth": [18]}, "teeth", "tooth 18"),
        ({"kind": "iregular"}, "kind", "allowed: one of layered, clustered, spall, list, irregular"),
    ],
)
def test_impossible_spalls_are_refused_by_key_value_and_range(changes: dict[str, Any], key: str, said: str) -> None:
    with pytest.raises(ConfigError) as refused:
        config_with({**SPALL, **changes})
    assert f"states.slight.damage.{key}: received" in str(refused.value)
    assert said in str(refused.value)


def test_a_depth_that_follows_from_the_lengths_is_blamed_on_them() -> None:
    config = config_with({**SPALL, **STRAIGHT, "face_share": 1.0})
    damage, pair = config.config.states[1].damage, config.gearbox(0).pair
    assert damage is not None
    (problem,) = damage.place_problems(replace(pair, face_width_m=20.0))
    assert problem.path == "profile_length_mm"
    assert "follows from profile and face length" in problem.received
    assert problem.allowed.startswith("depth allowed: below the half tooth thickness")


def test_through_the_face_needs_a_contact_that_can_lose_its_length() -> None:
    with pytest.raises(ConfigError, match="spalls of pinion tooth 0 that take the whole contact length"):
        config_with({**SPALL, "face_share": 1.0, "profile_length_mm": 1.0}, law="linear")
