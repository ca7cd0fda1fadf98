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


def test_states_grow_from_the_nearest_earlier_one_with_damage():
    more, most = {**LAYERS, "pits_per_layer": 8}, {**LAYERS, "pits_per_layer": 8, "layers": 3}
    states = [state("healthy"), state("slight", LAYERS), state("moderate", more), state("severe", most)]
    assert grown(*states) == [None, None, 1, 2]


def test_a_healthy_state_between_is_passed_over():
    assert grown(state("slight", LAYERS), state("healthy"), state("severe", CLUSTER)) == [None, None, 0]


def test_a_state_may_start_from_an_intact_gear_or_from_a_named_one():
    states = [
        state("slight", LAYERS),
        state("moderate", CLUSTER, grows_from="none"),
        state("severe", {**LAYERS, "layers": 3}, grows_from="slight"),
    ]
    assert grown(*states) == [None, None, 0]


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
    (problem,) = parsed(state("severe", LAYERS), state("slight", CLUSTER)).problems
    assert problem.path == "states.slight.grows_from"
    assert "severe (severe), for a slight state" in problem.received
    assert parsed(state("severe", LAYERS), state("slight", CLUSTER, grows_from="none")).problems == ()


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
    (problem,) = parsed(state("slight", milder), state("severe", damage)).problems
    assert problem.path == f"states.severe.damage.{key}"
    assert "no pits beyond those of slight" in problem.received
    assert parsed(state("slight", milder), state("severe", damage, grows_from="none")).problems == ()


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
    def planned(change: dict, **keys: str) -> Config:
        severe = {"damage": {**milder, **change}, **keys}
        states = f"states:\n  others: null\n  healthy: {{}}\n  slight: {{damage: {milder}}}\n  severe: {severe}\n"
        file = tmp_path / "mine.yaml"
        file.write_text(f"extends: quickstart\nname: mine\n{states}")
        return load_config(file)

    with pytest.raises(
        ConfigError, match=rf"states\.severe\.damage\.{key}: received no spalls beyond .*slight.*\(line 7\)"
    ):
        planned(smaller)
    planned(smaller, grows_from="none")
    planned({})  # as large
    planned(larger)


@pytest.mark.parametrize(
    "damage", [{**CLUSTER, "count": 10}, {**CLUSTER, "teeth": 2}, {**CLUSTER, "gear": "gear"}, LAYERS]
)
def test_pits_elsewhere_or_more_of_them_are_growth(damage):
    assert parsed(state("slight", CLUSTER), state("severe", damage)).problems == ()
