"""Section `manufacture`: what is accepted, what is refused and where; without it nothing changes."""

from __future__ import annotations

import pytest

from siggen.checks.loading import load_config
from siggen.config import Manufacture, parse
from siggen.errors import ConfigError
from siggen.keys.distributions import Uniform
from tests.config.minimal import config, minimal

PAIRS = {"dynamics": {"mesh": {"law": "pairs"}}}


def with_section(**section: object) -> dict[str, object]:
    return minimal(**PAIRS, manufacture=section)


def problem(**section: object) -> str:
    parsed = parse(with_section(**section))
    assert parsed.config is None
    (found,) = parsed.problems
    return str(found)


def test_a_class_is_enough() -> None:
    parsed = parse(with_section(accuracy_class=6)).config
    assert parsed is not None
    assert parsed.manufacture == Manufacture(accuracy_class=6.0)
    assert parsed.manufacture.tolerance_share == Uniform(low=0.3, high=0.5)
    assert parsed.manufacture.gear_class == 6.0
    assert parse(parsed.canonical()).config == parsed


def test_null_is_the_set_without_the_section() -> None:
    assert config(manufacture=None).identity == config().identity


def test_every_key_changes_the_identity() -> None:
    changes: list[dict[str, object]] = [
        {}, {"accuracy_class": 7}, {"accuracy_class_driven": 7}, {"tolerance_share": 0.4},
        {"draw": "state"},
    ]  # fmt: skip
    found = [parse(with_section(**({"accuracy_class": 6} | change))).config for change in changes]
    assert len({one.identity for one in found if one is not None} | {config(**PAIRS).identity}) == len(changes) + 1


@pytest.mark.parametrize("accuracy_class", [0, 12, 5.5, [5, 7]])
def test_classes_that_do_not_exist_are_refused(accuracy_class: object) -> None:
    assert problem(accuracy_class=accuracy_class).startswith("manufacture.accuracy_class: received")
    assert "from 1 to 11" in problem(accuracy_class=accuracy_class)


def test_classes_may_be_a_choice_and_differ_between_the_gears() -> None:
    choice = {"one_of": [5, 6, 7]}
    parsed = parse(with_section(accuracy_class=choice, accuracy_class_driven=8)).config
    assert parsed is not None
    assert parsed.manufacture is not None
    assert parsed.manufacture.gear_class == 8.0
    assert parsed.manufacture.classes_text == "5, 6 or 7, gear 8"
    assert "whole numbers" in problem(accuracy_class={"one_of": [5, 6.5]})


def test_shares_beyond_the_tolerance_and_unknown_keys_are_refused() -> None:
    assert "tolerance_share: received 1.2; allowed: a number from 0 to 1" in problem(
        accuracy_class=6, tolerance_share=1.2
    )
    assert "did you mean 'tolerance_share'" in problem(accuracy_class=6, tolerance_shar=0.2)
    assert "manufacture.accuracy_class: received nothing; this key is needed" in problem(tolerance_share=0.4)


def test_teeth_that_are_all_alike_have_no_errors() -> None:
    parsed = parse(minimal(manufacture={"accuracy_class": 6}, dynamics__mesh__law="linear"))
    (found,) = parsed.problems
    assert str(found).startswith("manufacture: received errors of single teeth; allowed: null with")
    assert "dynamics.mesh.law: pairs" in found.allowed


def test_helix_slopes_count_once() -> None:
    assert "which has the helix slopes already" in problem(
        accuracy_class=6, helix="iso_1328", lead_misalignment_um="iso_1328"
    )


def test_gears_outside_the_standard_are_refused_by_name() -> None:
    small = [
        "gears.module_mm=0.4",
        "gears.face_width_mm=3.0",
        "gears.pinion.bore_radius_mm=1",
        "gears.gear.bore_radius_mm=2",
    ]
    with pytest.raises(ConfigError, match=r"manufacture: received tolerances for a (pinion|gear) with") as refused:
        load_config("tests/configs/casing.yaml", [*small, "manufacture={accuracy_class: 6}"])
    assert "ISO 1328-1: " in str(refused.value)
