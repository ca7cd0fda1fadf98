"""Edges of damage that the contact across the face does not hold for are refused before anything is simulated."""

from __future__ import annotations

from typing import Any

import pytest

from siggen.checks.loading import load_config
from siggen.errors import ConfigError
from siggen.mesh.contact_edges import edge_terms
from tests.config.minimal import by_name, minimal

PITS = {"name": "slight", **minimal()["states"]["slight"]}


def spalls(radius: object) -> list[dict[str, Any]]:
    damage = {"kind": "irregular", "profile_length_mm": 0.6, "face_share": 0.5, "edge_radius_mm": radius}
    return [{"name": "healthy"}, {"name": "slight", "damage": damage}]


def test_edges_rounder_than_a_seventh_of_the_relative_radius_are_refused() -> None:
    drawn = [0.1, 0.99]
    with pytest.raises(ConfigError) as refused:
        load_config(minimal(states=by_name(spalls(drawn)), dynamics__mesh__pit_edge_radius_mm=0.99))
    (found,) = refused.value.problems  # pit_edge_radius_mm is of no damage here
    assert found.path == "states.slight.damage.edge_radius_mm"
    assert found.allowed.startswith("allowed: at most 0.95")
    with pytest.raises(ConfigError, match=r"dynamics.mesh.pit_edge_radius_mm: received 0.99; allowed: at most 0.95"):
        load_config(minimal(states=by_name([{"name": "healthy"}, PITS]), dynamics__mesh__pit_edge_radius_mm=0.99))
    load_config(minimal(states=by_name(spalls(0.9))))


def test_beyond_that_share_the_sink_of_the_law_falls_below_none_at_the_edge() -> None:
    radius, load = 6.676e-3, 7e-7
    width = (2.0 * radius * load) ** 0.5
    for rounding, sound in ((radius / 7.2, True), (radius / 6.0, False)):
        sinks = [edge_terms(0.01 * i * width, 0.0, radius, rounding, load).factor for i in range(70, 100)]
        assert (min(sinks) >= 0.0) is sound
