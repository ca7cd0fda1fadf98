"""Numbers of a gearbox: each has the law of its file, and belongs to its path in the user's words alone."""

from __future__ import annotations

from collections.abc import Callable
from math import log, sqrt
from statistics import NormalDist
from typing import Any

import numpy as np
import pytest

from siggen.config import Config, parse
from siggen.gearbox.draw import draw_specimen
from siggen.gearbox.drivetrain import drawn_dynamics, drawn_gears
from siggen.gearbox.specimen import Specimen
from tests.config.mill import MACHINE, mill, with_machine
from tests.config.staged import SPALL

GEARBOXES = 2000
LAWS: dict[str, Any] = {
    "uniform": [0.2, 0.6],
    "log": {"log": [1e7, 1e9]},
    "normal": {"normal": [20.0, 2.0], "within": [15.0, 25.0]},
    "one_of": {"one_of": [8.0, 9.0, 9.0, 12.0]},
}


def loaded(raw: dict[str, Any]) -> Config:
    parsed = parse(raw)
    assert parsed.config is not None, parsed.problems
    return parsed.config


@pytest.fixture(scope="module")
def drawn() -> dict[str, np.ndarray]:
    """What 2000 gearboxes of a machine draw of each law (n,)."""
    middle = {"bearing": {"stiffness_n_per_m": LAWS["log"]}, "span_mm": 120.0}
    machine = with_machine("gears", "eva", profile_shift=LAWS["uniform"], bore_radius_mm=LAWS["one_of"])
    machine = {**machine, "shafts": {**machine["shafts"], "middle": middle}}
    machine["meshes"] = with_machine("meshes", "slow", pressure_angle_deg=LAWS["normal"])["meshes"]
    config = loaded(mill(machine=machine))
    found: dict[str, list[float]] = {name: [] for name in (*LAWS, "vertical")}
    for number in range(GEARBOXES):
        _, (slow,), rotors = drawn_gears(config, number)
        bearing = drawn_dynamics(config, number, rotors).gear.bearing.stiffness_n_per_m
        found["uniform"].append(slow.gears.pinion.profile_shift)
        found["one_of"].append(slow.gears.pinion.bore_radius_mm)
        found["normal"].append(slow.gears.pressure_angle_deg)
        found["log"].append(bearing.each[0])
        found["vertical"].append(bearing.each[1])
    return {name: np.array(values) for name, values in found.items()}


def of_normal(value: float) -> float:
    standard = NormalDist(20.0, 2.0)
    return (standard.cdf(value) - standard.cdf(15.0)) / (standard.cdf(25.0) - standard.cdf(15.0))


SHARES: dict[str, Callable[[float], float]] = {
    "uniform": lambda value: (value - 0.2) / 0.4,
    "log": lambda value: log(value / 1e7) / log(100.0),
    "vertical": lambda value: log(value / 1e7) / log(100.0),
    "normal": of_normal,
}


@pytest.mark.parametrize("law", SHARES)
def test_numbers_have_the_law_that_the_file_gives(law: str, drawn: dict[str, np.ndarray]) -> None:
    """Kolmogorov-Smirnov: beyond 1.63/√n in one of a hundred."""
    shares = np.sort([SHARES[law](value) for value in drawn[law]])
    steps = np.arange(GEARBOXES + 1) / GEARBOXES
    distance = max(np.max(steps[1:] - shares), np.max(shares - steps[:-1]))
    assert distance < 1.63 / sqrt(GEARBOXES)


def test_a_list_gives_each_of_its_numbers_as_often_as_it_names_it(drawn: dict[str, np.ndarray]) -> None:
    """Chi square of three classes: beyond 9.21 in one of a hundred."""
    counts = np.array([np.sum(drawn["one_of"] == value) for value in (8.0, 9.0, 12.0)])
    expected = GEARBOXES * np.array([0.25, 0.5, 0.25])
    assert np.sum((counts - expected) ** 2 / expected) < 9.21


def test_directions_of_one_law_and_neighbours_are_independent(drawn: dict[str, np.ndarray]) -> None:
    ranks = np.array([np.argsort(np.argsort(values)) for name, values in drawn.items() if name != "one_of"])
    between = np.corrcoef(ranks) - np.eye(len(ranks))
    assert np.max(np.abs(between)) < 3.0 / sqrt(GEARBOXES)


RANGE = {"log": [1e8, 2e8]}
ON_BEARINGS = {
    **MACHINE,
    "shafts": {name: {**one, "bearing": {"stiffness_n_per_m": RANGE}} for name, one in MACHINE["shafts"].items()},
}
IN_FRONT = {
    "shafts": {"first": {"bearing": {"stiffness_n_per_m": RANGE}}, **ON_BEARINGS["shafts"], "input": {
        **ON_BEARINGS["shafts"]["input"], "span_mm": 120.0,
    }},
    "gears": {
        **ON_BEARINGS["gears"], "adam": {"teeth": 20, "bore_radius_mm": 12.0, "shaft": "first"},
        "hanna": {"teeth": 41, "bore_radius_mm": 12.0, "shaft": "input"},
    },
    "meshes": {
        "pre": {"driver": "adam", "driven": "hanna", "module_mm": 2.0, "face_width_mm": 20.0}, **ON_BEARINGS["meshes"],
    },
}  # fmt: skip
MORE: dict[str, dict[str, Any]] = {
    "a shaft in front": {"machine": IN_FRONT},
    "another order": {"machine": {part: dict(reversed(ON_BEARINGS[part].items())) for part in ON_BEARINGS}},
    "a key": {"dynamics": {"model": "8dof", "motor_inertia_kg_m2": [3e-3, 5e-3]}},
    "a sensor": {"sensors": {"far": {"place": "output_bearing"}, "bearing": {"place": "input_bearing"}}},
}
RAW: dict[str, Any] = {
    "machine": ON_BEARINGS, "manufacture": {"accuracy_class": 6}, "background": {"bearings": {}},
    "states": {"healthy": {}, "severe": {"damage": {**SPALL, "gear": "eva", "teeth": 1}}},
    "sensors": {"bearing": {"place": "input_bearing", "gain": [0.9, 1.1]}},
}  # fmt: skip


def numbers(specimen: Specimen, config: Config) -> dict[str, Any]:
    """Return what belongs to parts by their name."""
    _, stages, rotors = drawn_gears(config, specimen.specimen_id)
    shafts = {shaft.word: shaft.inner for shaft in config.names.shafts}
    of_shafts: dict[str, Any] = {**rotors, **{stage.name: stage.gear for stage in stages}}
    meshes = dict(zip((mesh.word for mesh in config.names.meshes), specimen.meshes, strict=True))
    errors = {name: meshes[name].teeth.errors(0) for name in ("fast", "slow")}
    return {
        "bearings": {name: of_shafts[shafts[name]].bearing for name in MACHINE["shafts"]},
        "errors": {name: (made.pinion.errors.pitch_m.tolist(), made.shafts_m) for name, made in errors.items() if made},
        "damage": [part.table_row() for part in meshes["slow"].teeth.damage(1, lambda _: None)],  # type: ignore[arg-type]
        "gain": next(channel.gain for channel in specimen.channels if channel.sensor == "bearing"),
        "point": specimen.points,
    }


@pytest.mark.parametrize("what", MORE)
def test_what_a_file_says_more_moves_no_number_of_the_rest(what: str) -> None:
    before, after = loaded(mill(**RAW)), loaded(mill(**{**RAW, **MORE[what]} | ({} if what != "a sensor" else {
        "sensors": {**MORE[what]["sensors"], **RAW["sensors"]}
    })))  # fmt: skip
    for number in range(2):
        assert numbers(draw_specimen(after, number), after) == numbers(draw_specimen(before, number), before)
    first, second = (numbers(draw_specimen(before, number), before) for number in range(2))
    assert all(first[part] != second[part] for part in ("bearings", "errors", "damage", "gain"))
