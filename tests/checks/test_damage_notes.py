"""What is said about idealised spalls."""

from __future__ import annotations

from typing import Any

import pytest

from siggen.checks.notes import damage_notes
from tests.damage.test_damage import PIT, config_with

BOX: dict[str, Any] = {"kind": "spall", "face_length_mm": 20.0, "profile_length_mm": 1.0, "depth_mm": 0.2}
PART = {**BOX, "face_length_mm": 8.0}
SKEWED: dict[str, Any] = {"kind": "irregular", "face_share": 1.0, "profile_length_mm": 1.0}
STRAIGHT = {**SKEWED, "waviness": 0.0, "skew_mm_per_10mm": 0.0}
CLUSTER = {"kind": "clustered", "count": 3, "spread_profile_mm": 0.3, **PIT}


@pytest.mark.parametrize("damages", [[BOX], [CLUSTER, BOX], [PART, BOX], [STRAIGHT]])
def test_parallel_edges_through_the_face_are_called_idealised(damages: list[dict[str, Any]]) -> None:
    (note,) = damage_notes(config_with(*damages).possible)
    assert "edges are exactly parallel to the axis" in note


@pytest.mark.parametrize("damages", [[], [CLUSTER], [PART], [SKEWED], [BOX, SKEWED]])
def test_nothing_is_said_where_land_is_left_or_edges_are_skewed(damages: list[dict[str, Any]]) -> None:
    assert not [*damage_notes(config_with(*damages).possible)]
