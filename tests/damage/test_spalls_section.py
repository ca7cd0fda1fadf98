"""Spalls of a state: from the configuration to the flank, growth, messages, and rows of the damage table."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from siggen.damage.flank_damage import damage_problems
from siggen.damage.flank_place import axial_heights_m
from siggen.damage.heights import profile_arc_m
from siggen.errors import ConfigError
from siggen.mesh.sections import contact_length_loss
from tests.damage.test_damage import config_with, damage_of
from tests.simulated import damage_rows

BOX: dict[str, Any] = {"kind": "spall", "face_length_mm": 6.0, "profile_length_mm": 1.0, "depth_mm": 0.1}
DRAWN = [0.5, 1.5]


def test_a_spall_has_its_length_on_the_flank_about_the_pitch_point() -> None:
    config = config_with(BOX)
    (spall,) = damage_of(config, 1)
    pair = config.gearbox(0).pair
    assert profile_arc_m(pair.pinion, spall.outline) == pytest.approx(1e-3, rel=1e-9)
    assert spall.outline.face_range_m == pytest.approx((7e-3, 13e-3), rel=1e-12)
    assert config.config.states[1].fault == "spalling"
    assert not damage_problems(pair, (spall,))


def test_a_flank_goes_on_below_the_base_circle_along_its_tangent() -> None:
    """The involute leaves the base circle radially, so heights above and below grow by the cosine of its half angle."""
    gear = config_with(BOX).gearbox(0).pair.pinion
    step = 1e-11  # the involute turns by 3e-5 on the way
    above, below = axial_heights_m(gear, np.array([step, -step]), "arc") / np.array([step, -step])
    assert below == pytest.approx(above, rel=1e-4)
    assert below == pytest.approx(math.cos(gear.base_half_angle_rad), rel=1e-9)


def test_a_longer_spall_over_the_same_centre_takes_the_place_of_the_shorter_one() -> None:
    config = config_with(BOX, {**BOX, "profile_length_mm": 1.6, "depth_mm": 0.2})
    slight, moderate = damage_of(config, 1), damage_of(config, 2)
    assert len(slight) == len(moderate) == 1
    (low, high), (lowest, highest) = slight[0].outline.height_range_m, moderate[0].outline.height_range_m
    assert lowest < low < high < highest


@pytest.mark.parametrize(
    "ladder",
    [
        [{**BOX, "face_centre_mm": [5.0, 15.0], "profile_length_mm": DRAWN}] * 2,
        [
            BOX,
            {**BOX, "depth_mm": 0.05, "face_length_mm": 8.0},
            {**BOX, "teeth": 2, "profile_length_mm": 2.0},
        ],
        [
            {
                "kind": "clustered",
                "count": 8,
                "spread_profile_mm": 0.3,
                "semi_axis_face_mm": 0.4,
                "semi_axis_profile_mm": 0.3,
                "depth_mm": 0.2,
            },
            {**BOX, "profile_length_mm": 2.0, "depth_mm": 0.3},
        ],
    ],
    ids=["drawn", "shapes", "pits"],
)
def test_a_more_severe_state_contains_the_region_of_the_milder_one(ladder: list[dict[str, Any]]) -> None:
    config = config_with(*ladder)
    heights = np.linspace(0.05e-3, 4.7e-3, 200)
    for state in range(1, len(ladder)):
        milder, harder = damage_of(config, state), damage_of(config, state + 1)
        for tooth in {p.tooth for p in milder}:
            one, both = (
                contact_length_loss([p for p in damage if p.tooth == tooth], 20e-3, heights)
                for damage in (harder, (*harder, *milder))
            )
            assert one == pytest.approx(both, abs=1e-17)


@pytest.mark.parametrize(
    ("base", "bad", "key", "received", "allowed"),
    [
        (BOX, {"face_length_mm": 0.0}, "face_length_mm", "0.0", "above 0"),
        (BOX, {"profile_length_mm": -1.0}, "profile_length_mm", "-1.0", "above 0"),
        (BOX, {"depth_mm": float("nan")}, "depth_mm", "nan", "above 0"),
        (BOX, {"centre_height_mm": 9.0}, "centre_height_mm", "9 mm", "4.74319 mm"),
        (BOX, {"face_centre_mm": 20.5}, "face_centre_mm", "20.5 mm", "0 to 20 mm"),
        (BOX, {"depth_mm": 4.0}, "depth_mm", "4 mm", "half tooth thickness"),
        (BOX, {"depth_mm": None}, "depth_mm", "null", "above 0"),
        (BOX, {"depth_law": "flat"}, "depth_law", "the text 'flat'", "known keys: gear"),
        (BOX, {"teeth": [18]}, "teeth", "tooth 18", "0 to 17"),
    ],
    ids=str,
)
def test_mistakes_are_named_with_their_key(
    base: dict[str, Any], bad: dict[str, Any], key: str, received: str, allowed: str
) -> None:
    places = {"states.slight.damage": {**base, **bad}}
    for path, damage in places.items():
        with pytest.raises(ConfigError) as refused:
            config_with(damage)
        lines = [line for line in str(refused.value).splitlines() if f"{path}.{key}:" in line]
        assert len(lines) == 1, str(refused.value)
        assert received in lines[0]
        assert allowed in lines[0]


def test_a_spall_over_the_whole_face_is_refused() -> None:
    with pytest.raises(ConfigError, match="spalls of pinion tooth 0 that take the whole contact length"):
        config_with({**BOX, "face_length_mm": 20.0}, law="linear")


def test_an_empty_list_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"damage\.pits: received no pits and no outlines"):
        config_with({"kind": "list"})


def test_rows_of_the_damage_table_tell_kind_shape_and_corners() -> None:
    pit = {"face_mm": 4.0, "semi_axis_face_mm": 0.3, "semi_axis_profile_mm": 0.2, "depth_mm": 0.3}
    config = config_with({"kind": "list", "pits": [pit]}, BOX)
    rows = damage_rows(config, 2)
    found = [(row["kind"], row["shape"]) for row in rows]
    assert found == [("pit", "ellipse"), ("spall", "rectangle")]
    assert rows[1]["polygon_face_mm"] == pytest.approx([7.0, 13.0, 13.0, 7.0])
    assert rows[1]["semi_axis_face_mm"] == pytest.approx(3.0)
    assert [len(row["polygon_face_mm"]) for row in rows] == [0, 4]  # type: ignore[arg-type]
