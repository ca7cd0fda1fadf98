"""Gearboxes with two stages from the command line: the plan, what is refused, records, labels, the table of damage."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.csv as pc
import pyarrow.parquet as pq
import pytest
import yaml

from siggen.checks.loading import load_config
from siggen.errors import ConfigError
from tests.command import Ended, command
from tests.config.mill import mill
from tests.config.minimal import by_name
from tests.config.staged import FAST, SLOW, SPALL, in_a_row, staged

SENSORS = [
    {"name": "bearing"},
    {"name": "end", "place": "slow_bearing", "axes": ["horizontal"]},
    {"kind": "bearing_force", "name": "washer", "place": "slow_bearing", "range_n": 1e5},
    {"kind": "encoder", "name": "out", "place": "slow_gear"},
]


def run(*arguments: str) -> Ended:
    return command("siggen", *arguments)


def written(folder: Path, **changes: Any) -> str:
    file = folder / "two.yaml"
    file.write_text(yaml.safe_dump(staged(**changes), sort_keys=False), encoding="utf-8")
    return str(file)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("stages")
    file = written(folder, specimens=1, fs_hz=12_800.0, duration_s=0.1, sensors=by_name(SENSORS))
    done = run("generate", file, "--out", str(folder / "set"), "--executor", "serial")
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "set"


def rows(made: Path, table: str) -> list[dict[str, Any]]:
    """Return the rows of a table of a set: data, labels or damage."""
    files = sorted((made / table).iterdir()) if table == "data" else [made / f"{table}.parquet"]
    return [row for file in files for row in pq.read_table(file).to_pylist()]


HOIST = """
extends: quickstart
machine:
  shafts: {input: {}, output: {}}
  gears:
    ann: {teeth: 18, bore_radius_mm: 12, shaft: input}
    bob: {teeth: 47, bore_radius_mm: 15, shaft: output}
  meshes: {fast: {driver: ann, driven: bob, module_mm: 2, face_width_mm: 20}}
dynamics: {shafts: null, mesh: {law: linear}}
manufacture: null
background: null
housing: {kind: rigid, mass_kg: 60}
sensors: {others: null, end: {place: output_bearing}}
states:
  others: null
  healthy: {}
  wide: {damage: {kind: spall, gear: bob, face_length_mm: 40, profile_length_mm: 2, depth_mm: 0.2}}
  index: {damage: {kind: crack, gear: ann, teeth: [60], depth_share: 0.2}}
  bare: {damage: {kind: crack, depth_share: 0.2}}
  short: {damage: {kind: irregular, gear: ann, face_share: 1.0, profile_length_mm: 0.2}}
"""
"""One mesh under the linear law, with a mistake in every state."""


def test_damage_is_refused_in_the_words_of_its_file(tmp_path: Path) -> None:
    (tmp_path / "hoist.yaml").write_text(HOIST)
    done = run("plan", str(tmp_path / "hoist.yaml"), "--trial", "0")
    assert done.returncode == 2
    for told in (
        "states.wide.damage: received spalls of bob tooth 0 that take the whole contact length",
        "states.index.damage.teeth: received tooth 60; allowed: an index from 0 to 17, ann has 18 teeth",
        "states.bare.damage.gear: received nothing; this key is needed where gears have names; allowed: one of",
        "states.short.damage.profile_length_mm: received 0.2 mm: over 20 mm of face its edges, with skew_mm_per_10mm",
    ):
        assert told in done.stderr
    assert "pinion" not in done.stderr


def test_channels_at_the_third_shaft_are_called_by_quantity_sensor_axis_and_unit(made: Path) -> None:
    table = pq.read_table(made / "data")
    facts = {name: table.schema.field(name).metadata for name in table.column_names}
    columns = {
        "accel_end_horizontal_m_s2": (b"slow_bearing", b"m/s^2"),
        "force_washer_vertical_n": (b"slow_bearing", b"N"),
        "speed_out_rotation_rad_s": (b"slow_gear", b"rad/s"),
    }
    assert {name: (facts[name][b"place"], facts[name][b"unit"]) for name in columns} == columns
    # A fifth of a turn of this shaft, so what vibrates stays in the means.
    speed, force = (np.array(table.column(name).to_pylist()).mean(axis=1) for name in [*columns][:0:-1])
    assert speed == pytest.approx(2.0 * np.pi * table.column("slow_shaft_hz").to_numpy(), rel=0.01)
    assert np.abs(force) == pytest.approx(20.0 * 47 / 18 / (0.5 * 17 * 3e-3), rel=0.05)  # torque over pitch radius


def test_labels_name_the_stage_and_its_frequencies(made: Path) -> None:
    healthy, severe = sorted(rows(made, "labels"), key=lambda row: row["record_id"])
    assert severe["status"] == healthy["status"] == "ok"
    assert (healthy["faulty_gear"], severe["faulty_gear"]) == ("none", "slow_pinion")
    assert severe["faulty_teeth_pinion"] == []
    assert len(severe["faulty_teeth_slow_pinion"]) == 1
    assert severe["mesh_stiffness_loss_as_simulated"] > healthy["mesh_stiffness_loss_as_simulated"] == 0.0
    shaft = Fraction(18, 47)
    assert severe["mesh_slow_hz"] == pytest.approx(30.0 * float(shaft * 17))
    assert severe["slow_shaft_hz"] == pytest.approx(30.0 * float(shaft * Fraction(17, 52)))
    assert (severe["teeth_slow_pinion"], severe["teeth_slow_gear"]) == (17, 52)


def test_the_table_of_damage_names_gear_and_stage(made: Path) -> None:
    (row,) = rows(made, "damage")
    assert row["gear"] == "slow_pinion"
    (severe,) = (row for row in rows(made, "labels") if row["state"] == "severe")
    assert [row["tooth"]] == severe["faulty_teeth_slow_pinion"]


def test_the_card_and_the_plan_name_every_mesh(made: Path) -> None:
    card = " ".join((made / "README.md").read_text(encoding="utf-8").split())
    assert "`slow`, in which slow_pinion with 17 teeth drives slow_gear with 52" in card
    told = run("plan", str(made / "config.yaml"), "--trial", "0")
    assert "mesh of slow" in told.stdout
    assert f"{30.0 * 18 / 47 * 17:.6g} Hz" in told.stdout


@pytest.mark.parametrize(
    ("changes", "path", "allowed"),
    [
        (
            {"states": {"severe": {"damage": {**SPALL, "gear": "fast_pinion"}}}},
            "states.severe.damage.gear", "slow_gear",
        ),
        (
            {"states": {"severe": {"damage": {**SPALL, "gear": "slow_pinion", "teeth": [17]}}}},
            "states.severe.damage.teeth", "slow_pinion has 17 teeth",
        ),
        ({"operating_points": [{"speed_hz": 30.0, "torque_nm": -1.0}]}, "operating_points.0.torque_nm", "above 0"),
        ({"stages": [{**SLOW, "direction_deg": 270.0}]}, "machine.meshes.slow.direction_deg", "from -180 to 180"),
        (
            {"stages": [{**SLOW, "gears": {**SLOW["gears"], "pinion": {"teeth": 17, "bore_radius_mm": 35.0}}}]},
            "machine.gears.slow_pinion.bore_radius_mm", "below the root radius",
        ),
        ({"fs_hz": 2_560.0}, "fs_hz", "mesh harmonic"),
        ({"machine": {**in_a_row(FAST, []), "shafts": {}}}, "machine.shafts", "2 to 100"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_its_path_and_what_is_allowed(
    changes: dict[str, Any], path: str, allowed: str
) -> None:
    with pytest.raises(ConfigError) as told:
        load_config(staged(**changes))
    problems = {problem.path: problem for problem in told.value.problems}
    assert path in problems, problems
    assert allowed in problems[path].allowed


def test_the_plan_of_what_cannot_be_ends_with_the_path_and_no_traceback(tmp_path: Path) -> None:
    told = run("plan", written(tmp_path, stages=[{**SLOW, "direction_deg": 270.0}]))
    assert told.returncode == 2
    assert "machine.meshes.slow.direction_deg" in told.stderr
    assert "Traceback" not in told.stderr


def test_a_stage_is_looked_at_by_its_name(tmp_path: Path, made: Path) -> None:
    file, table = written(tmp_path), tmp_path / "flank.csv"
    done = run("inspect", "flank", file, "--mesh", "slow", "--out", str(table))
    assert done.returncode == 0, done.stderr
    (row,) = pc.read_csv(table).to_pylist()
    assert row["gear"] == "slow_pinion"
    told = run("inspect", "flank", file, "--mesh", "third", "--out", str(table)).stderr
    assert "allowed: fast, slow" in told
    curves = tmp_path / "tvms.csv"
    done = run("inspect", "tvms", str(made / "config.yaml"), "--mesh", "slow", "--out", str(curves))
    assert done.returncode == 0, done.stderr
    assert "severe_n_per_m" in curves.read_text(encoding="utf-8").splitlines()[0]


def test_modes_are_those_of_all_shafts_and_call_a_machines_gears_by_name(tmp_path: Path) -> None:
    done = run("inspect", "modes", written(tmp_path), "--json")
    assert done.returncode == 0, done.stderr
    assert "shape_theta_slow_gear" in done.stdout
    file = tmp_path / "mill.yaml"
    file.write_text(yaml.safe_dump(mill(), sort_keys=False), encoding="utf-8")
    found = json.loads(run("inspect", "modes", str(file), "--json").stdout)
    assert list(found["mesh_stiffness_n_per_m"]) == ["fast", "slow"]
    moving = {name.partition("shape_theta_")[2] for name in found["modes"][0] if "theta" in name}
    assert moving == {"motor", "ida", "otto", "eva", "karl", "load"}
