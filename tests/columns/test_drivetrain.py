"""A set says what turns in its gearboxes, in the user's names: orders follow without knowing how it was configured."""

from __future__ import annotations

from dataclasses import asdict
from fractions import Fraction
from pathlib import Path

import siggen
from siggen import load_config
from siggen.columns.drivetrain import GearTrain
from siggen.columns.record import listed_columns, record_schema
from siggen.sets.drawn import set_columns
from tests.config.idler import idler
from tests.config.planets import planets
from tests.config.staged import staged
from tests.dataset.fake_set import copy_fake_set, fake_config


def ratios(train: GearTrain) -> tuple[dict[str, Fraction], dict[str, Fraction]]:
    """Return turns of shafts and orders of meshes by name."""
    turns = {shaft.name: Fraction(*shaft.turns) for shaft in train.shafts if shaft.turns}
    return turns, {mesh.name: Fraction(*mesh.order) for mesh in train.meshes if mesh.order}


def test_both_gears_of_a_mesh_pass_as_many_teeth_per_turn_of_the_input() -> None:
    """Of a planetary set against the carrier: planets pass it z_ring times per turn of the carrier. Source: Willis."""
    for raw in (staged(), idler()):
        train = set_columns(load_config(raw)).drivetrain
        turns, orders = ratios(train)
        for mesh in train.meshes:
            for gear in (train.gear(mesh.driver), train.gear(mesh.driven)):
                assert orders[mesh.name] == (gear.teeth or 0) * turns[gear.shaft]
    train = set_columns(load_config(planets())).drivetrain
    turns, orders = ratios(train)
    sun, planet, ring = train.gears
    assert {sun.name, planet.name, ring.name} == {"sun", "planet", "ring"}
    assert (sun.shaft, planet.shaft, ring.shaft) == ("sun", "carrier", "")
    assert len(planet.places) > 2
    assert orders[""] == orders["ring"] == (ring.teeth or 0) * turns["carrier"]


def test_every_gear_has_the_column_with_its_teeth_in_the_names_of_the_user() -> None:
    for raw in (staged(), idler(), planets()):
        columns = set_columns(load_config(raw))
        listed = {one.get("of") for one in listed_columns(record_schema(columns)) if one.get("quantity") == "teeth"}
        assert listed == {gear.name for gear in columns.drivetrain.gears}
    gears = set_columns(load_config(idler())).drivetrain.gears
    assert {gear.name: gear.shaft for gear in gears if "." in gear.name} == {
        "first.b": "middle",
        "second.b": "middle",
    }


def test_gears_that_differ_within_a_set_have_no_teeth_and_no_turns_in_the_manifest() -> None:
    train = set_columns(load_config("families", ["gears.pairs.count=3"])).drivetrain
    assert {gear.teeth for gear in train.gears} == {None}
    assert [shaft.turns for shaft in train.shafts] == [None, None]


def test_a_finished_set_gives_its_drivetrain_and_the_columns_about_its_parts(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    dataset = siggen.open(tmp_path)
    assert asdict(dataset.drivetrain) == asdict(set_columns(fake_config()).drivetrain)
    assert dataset.columns_of("teeth") == {"pinion": "teeth_pinion", "gear": "teeth_gear"}
    assert dataset.columns_of("shaft_hz")["gear"] == "gear_shaft_hz"
