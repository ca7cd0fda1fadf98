"""Housings that cannot hold their gears are refused by key and line; those that are let through can be built."""

from __future__ import annotations

from dataclasses import replace

import pytest

from siggen.checks.housing_problems import housing_problems
from siggen.checks.loading import load_config
from siggen.config import inherited, parse_yaml
from siggen.drivetrain.box import layout
from siggen.errors import ConfigError
from siggen.gearbox.housing import plate_numbers, specimen_layout
from siggen.gearbox.teeth import gear_pair
from siggen.rig.rig_answers import rig_of
from siggen.rig.rig_text import rig_text
from tests.config.minimal import minimal

SHAFTS = {"driver": {"diameter_mm": 30, "bearing_span_mm": 120}, "driven": {"diameter_mm": 35, "bearing_span_mm": 120}}


def refusals(**changes: object) -> dict[str, str]:
    with pytest.raises(ConfigError) as refused:
        load_config(minimal(**changes))
    return {problem.path: f"{problem.received}; {problem.allowed}" for problem in refused.value.problems}


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        # 97.5 mm between the shafts, tips at 30 and 73.5 mm
        ({"housing__length_mm": 200.0}, "housing.length_mm", "the gears, and bearings in the walls"),
        ({"housing__height_mm": 150.0}, "housing.height_mm", "the larger gear"),
        ({"housing__width_mm": 23.0}, "housing.width_mm", "at least 24 mm: the gears' faces"),
        ({"housing__length_mm": [200, 400]}, "housing.length_mm", "200; allowed"),
        ({"housing__wall_mm": 50.0}, "housing.wall_mm", "a quarter of the least inner length"),
        ({"housing__wall_mm": 11.0, "housing__width_mm": 40.0}, "housing.wall_mm", "at most 10 mm"),
        (
            {"dynamics__shafts": {"driver": {"diameter_mm": 44}, "driven": {"diameter_mm": 125}}},
            "dynamics.shafts.driven.diameter_mm",
            "both bearings fit into one wall",
        ),
    ],
)
def test_what_does_not_fit_is_refused_by_key(changes: dict[str, object], key: str, words: str) -> None:
    found = refusals(**changes)
    assert list(found) == [key]
    assert words in found[key]


@pytest.mark.parametrize("shafts", [None, SHAFTS])
@pytest.mark.parametrize("material", ["any", "grey_iron"])
def test_the_least_lengths_that_are_let_through_can_be_built(shafts: object, material: str) -> None:
    """Of 30 gearboxes each, whatever bearings and walls they draw; a box that cannot be is refused by its own check."""
    config = load_config(minimal(dynamics__shafts=shafts, housing__material=material))
    least = {}
    for key in ("length_mm", "height_mm", "width_mm"):
        section = config.config.housing.model_copy(update={key: 1.0})
        (problem,) = housing_problems(config.with_sections(housing=section).possible)
        least[key] = 1.0005 * float(problem.allowed.split("at least ")[1].split(" mm")[0])  # told with four digits
    smallest = load_config(config.canonical() | {"housing": {**config.canonical()["housing"], **least}})
    for specimen_id in range(30):
        specimen = smallest.gearbox(specimen_id)
        box = layout(specimen.housing.contents, specimen.housing.proportions, specimen.housing.material)
        inner = (
            1e3 * (box.size_m[0] - box.thickness.ends_m),
            1e3 * (box.size_m[1] - 0.5 * (box.thickness.lid_m + box.thickness.floor_m)),
            1e3 * (box.size_m[2] - box.thickness.walls_m),
        )
        assert inner == pytest.approx(tuple(least.values()), rel=1e-9)
        assert min(seat.boss_radius_m / seat.bore_radius_m for seat in box.seats.values()) >= 1.19


@pytest.mark.parametrize(("teeth", "module_mm"), [("17,17", "0.8"), ("20,20", "1"), ("23,23", "1.5")])
def test_small_equal_gears_turn_in_bearings_larger_than_they_are(teeth: str, module_mm: str) -> None:
    """Gears of 14 mm on shafts of 9 mm, as `siggen init` proposes them, under a lid over which nobody gave a height."""
    rig, _ = rig_of({"teeth": teeth, "module": module_mm, "speed": "1450rpm"})
    config = load_config({**inherited(parse_yaml(rig_text(rig, "rig"), "rig"))})
    pair = gear_pair(config.config.gears)
    for specimen_id in range(config.specimens):
        specimen = config.gearbox(specimen_id)
        box = layout(specimen.housing.contents, specimen.housing.proportions, specimen.housing.material)
        assert all(seat.boss_radius_m > seat.bore_radius_m for seat in box.seats.values())
        assert min(seat.y_m for seat in box.seats.values()) > pair.gear.tip_radius_m


def test_a_length_below_the_least_cannot_be_built() -> None:
    """The check is not stricter than need be: with the bearing and the wall that it counts with, 10 mm less fail."""
    config = load_config(minimal(housing__length_mm=234.0))
    thick = plate_numbers(config.config.housing, lambda _: 0.5).model_copy(
        update={"bearing": 2.2, "material": "steel", "wall": 1.0}
    )
    contents, proportions, stuff = specimen_layout(thick, None, gear_pair(config.config.gears))
    layout(contents, proportions, stuff)
    with pytest.raises(ValueError, match="boss"):
        layout(contents, replace(proportions, end_m=proportions.end_m - 0.01), stuff)


def test_only_plates_of_the_model_with_a_casing_are_looked_at() -> None:
    rigid = {"kind": "rigid"}
    assert load_config(minimal(housing=rigid, dynamics__shafts=SHAFTS)).config.housing.kind == "rigid"
    load_config(minimal(dynamics__model="8dof"))


def test_a_housing_that_is_wrong_itself_says_nothing_of_the_sensors_on_it() -> None:
    with pytest.raises(ConfigError) as refused:
        load_config("configs/quickstart.yaml", ["housing.wall_mm=0"])
    assert [problem.path for problem in refused.value.problems] == ["housing.wall_mm"]
