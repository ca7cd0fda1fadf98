"""Which state a state has grown from, and what growth cannot be."""

from __future__ import annotations

from pathlib import Path

import pytest

from siggen.checks.loading import load_config
from siggen.config import Config, parse
from siggen.errors import ConfigError
from tests.config.minimal import by_name, minimal

LAYERS = {"kind": "layered", "layers": 1, "pits_per_layer": 4}
CLUSTER = {"kind": "clustered", "count": 9, "spread_profile_mm": 0.3}
SIZE = {"semi_axis_face_mm": 0.3, "semi_axis_profile_mm": 0.2, "depth_mm": 0.2}


def state(name: str, damage: dict | None = None, **keys) -> dict:
    return {"name": name, "damage": {**damage, **SIZE} if damage else None, **keys}


def parsed(*states: dict):
    return parse(minimal(states=by_name(states)))


def grown(*states: dict) -> list[int | None]:
    config = parsed(*states).config
    assert isinstance(config, Config)
    return [config.grown_from(i) for i in range(len(states))]


def test_a_state_takes_over_the_keys_of_the_one_it_grows_from() -> None:
    more = {"name": "moderate", "grows": "slight", "damage": {"pits_per_layer": 8}}
    most = {"name": "severe", "grows": "moderate", "damage": {"layers": 3}}
    states = [state("healthy"), state("slight", LAYERS), more, most]
    assert grown(*states) == [None, None, 1, 2]
    severe = parsed(*states).sections["states"]["severe"]
    assert (severe.damages[0].layers, severe.damages[0].pits_per_layer, severe.severity) == (3, 8, "severe")
    assert grown(*reversed(states)) == [1, 2, None, None]  # whatever their order


def test_a_state_without_grows_begins_anew_and_one_that_is_like_another_does_not_grow() -> None:
    again = {"name": "elsewhere", "like": "slight", "severity": "slight", "damage": {"gear": "gear"}}
    assert grown(state("slight", LAYERS), again, state("worse", CLUSTER)) == [None, None, None]
    (damage,) = parsed(state("slight", LAYERS), again).sections["states"]["elsewhere"].damages
    assert (damage.kind, damage.gear) == ("layered", "gear")


def test_a_sham_takes_over_damage_and_no_labels() -> None:
    severe = state("severe", LAYERS, severity="large", fault="pitting")
    sham = parsed(severe, {"name": "sham", "like": "severe", "acts": False}).sections["states"]["sham"]
    assert (sham.sham, sham.fault, sham.severity) == (True, "healthy", "healthy")


def test_a_kind_of_its_own_and_null_replace_the_damage_that_is_taken_over() -> None:
    states = parsed(
        state("slight", LAYERS),
        {"name": "other", "grows": "slight", "damage": {"kind": "crack", "depth_share": 0.2}},
        {"name": "oil", "like": "slight", "fault": "lubrication", "damage": None, "changes": {"housing.wall_mm": 6}},
    ).sections["states"]  # fmt: skip
    assert states["other"].damages[0].kind == "crack"
    assert not states["oil"].damages


def test_a_change_that_is_taken_over_belongs_to_the_state_that_says_it() -> None:
    first = {
        "fault": "lubrication",
        "changes": {"dynamics.backlash_um": [60, 70], "dynamics.motor_inertia_kg_m2": 5e-3},
    }
    second = {"grows": "first", "changes": {"dynamics.backlash_um": {"add": 9}}}
    config = parse(minimal(states={"second": {"severity": "worse", **second}, "first": first})).config
    assert config is not None
    assert [(index, one.text) for index, one in config.changes_of(0)] == [
        (0, "dynamics.backlash_um plus 9"), (1, "dynamics.motor_inertia_kg_m2 = 0.005"),
    ]  # fmt: skip
    assert parse(config.canonical()).config == config


def test_a_circle_is_told_once_and_what_grows_from_it_is_left_alone() -> None:
    circle = [{"name": "a", "grows": "b"}, {"name": "b", "like": "c"}, {"name": "c", "grows": "a"}]
    (problem,) = parsed(state("slight", LAYERS), {"name": "d", "grows": "a"}, *circle).problems
    assert problem.path == "states.a.grows"
    assert problem.received == "a circle: a from b from c from a"


def test_what_is_wrong_with_a_state_is_not_told_again_of_those_that_take_it_over() -> None:
    others = {"name": "worse", "grows": "slight"}, {"name": "sham", "like": "worse", "acts": False}
    (problem,) = parsed(state("slight", {**LAYERS, "layers": 0}), *others).problems
    assert problem.path == "states.slight.damage.layers"


def test_states_without_a_healthy_one_are_allowed():
    assert grown(state("slight", LAYERS)) == [None]


def test_labels_follow_from_the_name_and_the_damage():
    config = parsed(state("healthy"), state("moderate", LAYERS), state("worn", CLUSTER, severity="severe")).config
    assert [s.fault for s in config.states] == ["healthy", "pitting", "pitting"]
    assert [s.severity for s in config.states] == ["healthy", "moderate", "severe"]


@pytest.mark.parametrize(("severity", "meant"), [("slihgt", "slight"), ("sever", "severe"), ("moderat", "moderate")])
def test_a_severity_that_is_a_slip_of_the_pen_is_asked_for(severity: str, meant: str) -> None:
    (problem,) = parsed(state("healthy"), state("worn", LAYERS, severity=severity)).problems
    assert problem.path == "states.worn.severity"
    assert problem.allowed.startswith(f"did you mean '{meant}'?")


@pytest.mark.parametrize("severity", ["mild", "slight_2", "severe2", "size_1", "very_severe"])
def test_a_severity_may_have_any_other_name(severity: str) -> None:
    assert not parsed(state("healthy"), state("worn", LAYERS, severity=severity)).problems


def test_a_milder_state_cannot_grow_from_a_more_severe_one():
    (problem,) = parsed(state("severe", LAYERS), state("slight", CLUSTER, grows="severe")).problems
    assert problem.path == "states.slight.grows"
    assert "'severe' (severe), for a slight state" in problem.received
    assert parsed(state("severe", LAYERS), state("slight", CLUSTER)).problems == ()


@pytest.mark.parametrize(
    ("milder", "damage", "key"),
    [
        (CLUSTER, CLUSTER, "count"),
        (CLUSTER, {**CLUSTER, "count": 8, "spread_profile_mm": 1.0}, "count"),
        (LAYERS, LAYERS, "layers"),
        ({**LAYERS, "layers": 2}, {**LAYERS, "pits_per_layer": 3}, "layers"),
    ],
)
def test_a_state_must_add_pits_to_the_one_it_grows_from(milder, damage, key):
    (problem,) = parsed(state("slight", milder), state("severe", damage, grows="slight")).problems
    assert problem.path == f"states.severe.damage.{key}"
    assert "no pits beyond those of slight" in problem.received
    assert parsed(state("slight", milder), state("severe", damage)).problems == ()


SPALL = {"kind": "spall", "face_length_mm": 8, "profile_length_mm": 1.2, "depth_mm": 0.2}
IRREGULAR = {"kind": "irregular", "profile_length_mm": [0.8, 1.4], "face_share": 0.6}


@pytest.mark.parametrize(
    ("milder", "smaller", "larger", "key"),
    [
        (SPALL, {"face_length_mm": 4, "profile_length_mm": 0.6}, {"depth_mm": 0.3}, "face_length_mm"),
        (IRREGULAR, {"face_share": 0.2}, {"face_share": 0.2, "depth_mm": 0.3}, "face_share"),
        (
            IRREGULAR,
            {"profile_length_mm": [0.7, 1.2]},
            {"profile_length_mm": [0.7, 1.6]},
            "profile_length_mm",
        ),
    ],
)
def test_a_spall_smaller_than_the_milder_one_is_no_growth(
    milder: dict, smaller: dict, larger: dict, key: str, tmp_path: Path
) -> None:
    def planned(change: dict, takes: str = "grows") -> Config:
        severe = {takes: "slight", "damage": change}
        states = f"states:\n  others: null\n  healthy: {{}}\n  slight: {{damage: {milder}}}\n  severe: {severe}\n"
        file = tmp_path / "mine.yaml"
        file.write_text(f"extends: quickstart\nname: mine\n{states}")
        return load_config(file).config

    with pytest.raises(
        ConfigError, match=rf"states\.severe\.damage\.{key}: received no spalls beyond .*slight.*\(line 7\)"
    ):
        planned(smaller)
    planned(smaller, "like")
    planned({})  # as large
    planned(larger)


@pytest.mark.parametrize(
    "damage", [{**CLUSTER, "count": 10}, {**CLUSTER, "teeth": 2}, {**CLUSTER, "gear": "gear"}, LAYERS]
)
def test_pits_elsewhere_or_more_of_them_are_growth(damage):
    assert parsed(state("slight", CLUSTER), state("severe", damage, grows="slight")).problems == ()
