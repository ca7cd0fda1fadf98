"""Further meshes: what each sees of teeth, loads, damage and random numbers."""

from __future__ import annotations

from math import gcd

import pytest

from siggen.config import parse
from siggen.gearbox.design import SetDesign
from siggen.gearbox.specimen import OperatingPoint
from siggen.record.teeth import all_teeth
from tests.config.minimal import by_name
from tests.config.staged import SPALL, staged


def config_of(**changes: object) -> SetDesign:
    parsed = parse(staged(**changes))
    assert parsed.config is not None, parsed.problems
    return SetDesign(parsed.config)


def test_speed_falls_and_torque_rises_by_the_teeth_of_the_meshes_in_front() -> None:
    specimen = config_of(operating_points=[{"speed_hz": 30.0, "torque_nm": 400.0}]).gearbox(0)
    point = OperatingPoint(30.0, 40.0).turned(float(specimen.shaft_turns[1]))
    assert point.speed_hz == pytest.approx(30.0 * 18 / 47)
    assert point.torque_nm == pytest.approx(40.0 * 47 / 18)
    first, slow = (mesh.teeth.largest_force_n for mesh in specimen.meshes)
    radii = [mesh.pair.pinion.base_radius_m for mesh in specimen.meshes]
    assert slow / first == pytest.approx(47 / 18 * radii[0] / radii[1])


def test_all_shafts_stand_again_as_they_did_after_the_hunting_turns_and_not_before() -> None:
    found = config_of().gearbox(0).hunting_turns
    ratios = [(18, 47), (18 * 17, 47 * 52)]
    assert all(found * a % b == 0 for a, b in ratios)
    assert found == 47 * 52 // gcd(18 * 17, 47 * 52)


def test_damage_grows_on_both_meshes_whatever_state_adds_to_which() -> None:
    """A state that adds a spall to one mesh keeps that of the milder state on the other one."""
    states = [
        {"name": "healthy"},
        {"name": "slight", "damage": {**SPALL, "gear": "pinion", "teeth": 1}},
        {"name": "moderate", "grows": "slight", "damage": {**SPALL, "gear": "slow_gear", "teeth": 1}},
        {"name": "severe", "grows": "moderate", "damage": {**SPALL, "gear": "slow_gear", "teeth": 2}},
    ]
    config = config_of(states=by_name(states))
    specimen = config.gearbox(0)
    first, behind = all_teeth(specimen)
    assert [len(first.damage(i)) for i in range(4)] == [0, 1, 1, 1]
    assert [len(behind.damage(i)) for i in range(4)] == [0, 0, 1, 2]


def test_a_further_stage_leaves_the_draws_of_the_first_mesh_alone() -> None:
    made = {"manufacture": {"accuracy_class": 6}, "states": {"healthy": {}}}
    both, alone = config_of(**made), config_of(**made, stages=[])
    (one, slow), (other,) = (all_teeth(config.gearbox(0)) for config in (both, alone))
    first, expected, behind = one.errors(0), other.errors(0), slow.errors(0)
    assert first is not None
    assert expected is not None
    assert behind is not None
    assert first.pinion.found.largest == expected.pinion.found.largest
    assert behind.pinion.tolerance_share != first.pinion.tolerance_share
