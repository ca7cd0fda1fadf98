"""Overrides: one value replaced, everything else untouched, and every slip named."""

from __future__ import annotations

import copy

import pytest

from siggen.config import apply_overrides, parse
from siggen.errors import ConfigError
from tests.config.minimal import MINIMAL, minimal


@pytest.mark.parametrize(
    ("override", "change"),
    [
        ("seed=8", {"seed": 8}),
        ("gears.module_mm=3.5", {"gears__module_mm": 3.5}),
        ("dynamics.pinion.mass_kg=1", {"dynamics__pinion__mass_kg": 1}),  # section left out in the file
        ("operating_points.0.speed_hz=25", {"operating_points__0__speed_hz": 25}),
        ("states.slight.damage.pits_per_layer=3", {"states__slight__damage__pits_per_layer": 3}),
        ("states.slight.damage.0.pits_per_layer=3", {"states__slight__damage__pits_per_layer": 3}),  # the only one
        (
            "gears.module_mm=[2, 4]",
            {"gears__module_mm": [2, 4]},
        ),
        ("sensors.bearing.bits=null", {"sensors__bearing__bits": None}),
        ("sensors.bearing.noise.floor_m_s2=2e1", {"sensors__bearing__noise": {"floor_m_s2": 20.0}}),
        ("name=a=b", {"name": "a=b"}),
    ],
)
def test_an_override_replaces_one_value(override, change):
    assert apply_overrides(MINIMAL, [override]) == minimal(**change)


def test_the_mapping_that_was_given_is_left_alone():
    before = copy.deepcopy(MINIMAL)
    apply_overrides(MINIMAL, ["gears.module_mm=9", "sensors.bearing.bits=4", "stiffness.beam=base_circle"])
    assert before == MINIMAL


def test_later_overrides_win():
    assert apply_overrides(MINIMAL, ["seed=1", "seed=2"])["seed"] == 2


def test_all_slips_are_named_at_once():
    slips = [
        "operating_points.7.speed_hz=1",
        "sensors.baering.bits=4",
        "operating_points.two.speed_hz=1",
        "seed.first=3",
        "module_mm",
        "=3",
        "a..b=3",
        "seed=[1",
        "operating_points.-1.speed_hz=1",
    ]
    with pytest.raises(ConfigError) as caught:
        apply_overrides(MINIMAL, slips)
    paths = [problem.path for problem in caught.value.problems]
    assert sorted(paths) == sorted(f"--set {slip}" for slip in slips)
    assert "an index from 0 to 0" in str(caught.value)
    assert "received 7 at seed" in str(caught.value)
    assert "gears.module_mm=3.5" in str(caught.value)  # the form, by example


def test_an_unknown_key_is_refused_when_the_configuration_is_parsed():
    (problem,) = parse(apply_overrides(MINIMAL, ["gears.modul_mm=3"])).problems
    assert problem.path == "gears.modul_mm"
    assert "did you mean 'module_mm'?" in problem.allowed
