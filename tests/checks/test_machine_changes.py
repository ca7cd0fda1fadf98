"""What states of a machine change, and what is wrong about it: told in the words of its file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from siggen.checks.loading import load_config
from siggen.checks.plausibility import implausible
from siggen.config import yaml_text
from siggen.errors import ConfigError
from tests.command import command
from tests.config.mill import mill
from tests.config.minimal import minimal
from tests.config.staged import SPALL

ONE_MESH: dict[str, Any] = {
    "shafts": {"input": {}, "output": {}},
    "gears": {
        "ida": {"teeth": 18, "bore_radius_mm": 12.0, "shaft": "input"},
        "otto": {"teeth": 47, "bore_radius_mm": 15.0, "shaft": "output"},
    },
    "meshes": {"fast": {"driver": "ida", "driven": "otto", "module_mm": 2.0, "face_width_mm": 20.0}},
}
ON_BALLS = {**ONE_MESH, "shafts": {"input": {"bearing": {"geometry": {}}}, "output": {}}}
WRONG: dict[str, tuple[str, Any, str, dict[str, Any]]] = {
    "a shaft that is none": ("machine.shafts.inptu.mass_kg", 3.0, "input, middle; did you mean 'input'?", {}),
    "a key that is none": ("machine.shafts.input.mas_kg", 3.0, "did you mean 'mass_kg'?", {}),
    "a number that cannot be": ("machine.shafts.input.mass_kg", -3.0, "received -3.0; allowed: a number above 0", {}),
    "a gear": ("machine.gears.ida.teeth", 19.0, "allowed: keys below machine.shafts, dynamics, housing", {}),
    "where gears stand": ("machine.shafts.middle.span_mm", {"times": 2.0}, "the same in all states", {}),
    "a key of a pair": ("dynamics.pinion.mass_kg", 3.0, "allowed with a machine: keys below machine.shafts", {}),
    "a seat behind the second shaft": (
        "machine.shafts.output.eccentricity_um", 5.0, "received 5.0; allowed: none on a shaft behind the second",
        {"manufacture": {"accuracy_class": 6}},
    ),
    "a stiffness that balls stand in place of": (
        "machine.shafts.input.bearing.stiffness_n_per_m", {"times": 0.5},
        "received a key that machine.shafts.input.bearing.geometry stands in place of; "
        "allowed: changes of machine.shafts.input.bearing.geometry.clearance_um",
        {"machine": ON_BALLS, "dynamics": {}},
    ),
    "a shaft so soft that it tilts": (
        "dynamics.shafts.driver.diameter_mm", 6.0,
        "N m, with machine.shafts.input.bearing.stiffness_n_per_m",
        {"machine": ONE_MESH, "dynamics": {"shafts": {"driver": {"gear_position": 0.3}, "driven": {}}}},
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_a_change_that_cannot_be_is_told_at_its_line_in_the_words_of_the_file(case: str, tmp_path: Path) -> None:
    key, value, words, around = WRONG[case]
    soft = {"fault": "loose_bearing", "severity": "slight", "changes": {key: value}}
    text = yaml_text(mill(**{"states": {"healthy": {}, "soft": soft}, **around}))
    (tmp_path / "mill.yaml").write_text(text)
    ended = command("siggen", "plan", str(tmp_path / "mill.yaml"))
    line = next(number for number, line in enumerate(text.splitlines(), start=1) if f"{key}:" in line)
    assert ended.returncode == 2
    assert f"states.soft.changes.{key}: " in ended.stderr
    assert f"(line {line})" in ended.stderr
    assert words in ended.stderr
    assert "1 problem\n" in ended.stderr, ended.stderr
    for inner in {"dynamics.pinion", "dynamics.gear", "stages.", "pinion"} - {key.rpartition(".")[0]}:
        assert inner not in ended.stderr.replace(key, ""), ended.stderr


def test_a_planetary_section_that_is_wrong_brings_no_problem_of_what_names_its_gears() -> None:
    bad = {"damage": {**SPALL, "gear": "sun", "teeth": [3]}}
    raw = minimal(planetary={"ring_teeth": "many"}, sensors={"at": {"place": "sun_bearing"}})
    raw |= {"dynamics": {"model": "8dof"}, "states": {"healthy": {}, "severe": bad}}
    with pytest.raises(ConfigError) as refused:
        load_config(raw)
    assert [problem.path for problem in refused.value.problems] == ["planetary.ring_teeth"]


DRAWN_CHANGES = (
    "pinion.mass_kg", "pinion.bearing.geometry.clearance_um", "gear.bearing.damping_time_s", "gear.mass_kg",
    "shafts.driver.diameter_mm", "input_coupling.stiffness_nm_per_rad", "load_inertia_kg_m2", "unbalance.grade_mm_s",
    "friction.boundary_friction", "mesh.structure_damping_ratio",
)  # fmt: skip


def test_any_number_of_the_machine_may_change_by_a_drawn_factor() -> None:
    changes = {f"dynamics.{key}": {"times": [0.85, 0.95]} for key in DRAWN_CHANGES}
    states = {"others": None, "healthy": {}, "other": {"fault": "rebuilt", "severity": "slight", "changes": changes}}
    design = load_config({"extends": "quickstart", "states": states})
    assert implausible(design.possible) == ()  # which looks at the ends of both laws
    first, second = (design.gearbox(number) for number in (0, 1))
    ratios = [
        one.in_state(1).train.first.pinion.mass_kg / one.in_state(0).train.first.pinion.mass_kg
        for one in (first, second)
    ]
    assert all(0.85 <= ratio <= 0.95 for ratio in ratios)
    assert ratios[0] != ratios[1]
