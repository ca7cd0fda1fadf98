"""What a change makes impossible is told by state and key of the change, not where the healthy gearbox stands."""

from __future__ import annotations

from typing import Any

import pytest

from siggen.checks.loading import load_config
from siggen.errors import ConfigError
from tests.config.minimal import by_name, minimal

DAMAGED = {"name": "severe", "damage": {"kind": "spall", "face_length_mm": 8, "profile_length_mm": 1, "depth_mm": 0.3}}


def refused(changes: dict[str, Any], **more: Any) -> str:
    changed = {"name": "changed", "fault": "own", "severity": "moderate", "changes": changes}
    with pytest.raises(ConfigError) as found:
        load_config(minimal(states=by_name([{"name": "healthy"}, DAMAGED, changed])) | more)
    return str(found.value)


def test_physics_is_checked_for_the_changed_gearbox() -> None:
    said = refused({"dynamics.mesh.pit_edge_radius_mm": {"times": 10}})
    assert "states.changed.changes.dynamics.mesh.pit_edge_radius_mm: received 1" in said
    assert "a seventh of the flanks' relative radius" in said


def test_what_grows_is_checked_with_all_that_it_holds() -> None:
    first = {
        "name": "first",
        "fault": "own",
        "severity": "slight",
        "changes": {"dynamics.mesh.pit_edge_radius_mm": 0.5},
    }
    second = {**first, "name": "second", "grows": "first", "changes": {"dynamics.backlash_um": {"add": -90}}}
    with pytest.raises(ConfigError, match=r"states\.second\.changes\.dynamics\.backlash_um: received -10"):
        load_config(minimal(states=by_name([{"name": "healthy"}, DAMAGED, first, second])))


def test_gears_that_are_drawn_for_each_state_cannot_be_the_healthy_ones() -> None:
    said = refused({"dynamics.backlash_um": 90}, manufacture={"accuracy_class": 5, "draw": "state"})
    assert "states.changed.changes: " in said
    assert "draw: specimen" in said


@pytest.mark.parametrize("gear", ["either", "foo"])
@pytest.mark.parametrize("place", [0, 1])
def test_a_listed_pit_on_no_single_gear_is_told_with_its_entry(gear: str, place: int) -> None:
    pit = {"face_mm": 3.0, "semi_axis_face_mm": 0.5, "semi_axis_profile_mm": 0.4, "depth_mm": 0.1}
    pits = [{**pit, "gear": "pinion"}, {**pit, "gear": "pinion"}]
    pits[place]["gear"] = gear
    with pytest.raises(
        ConfigError, match=rf"states\.listed\.damage\.pits\.{place}\.gear: received '{gear}'; allowed: "
    ):
        load_config({"extends": "quickstart", "states": {"listed": {"damage": {"kind": "list", "pits": pits}}}})
