"""`siggen plan`: counts that add up, and messages instead of tracebacks."""

from __future__ import annotations

import json
from pathlib import Path
from unittest.mock import patch

import pytest
from typer.testing import CliRunner

from siggen.checks.loading import load_config
from siggen.cli.app import app
from siggen.cli.life_table import cost_summary, cost_text
from siggen.cli.plan import plan_summary
from siggen.config import yaml_text
from siggen.gearbox.design import SetDesign
from siggen.sets.record_cost import SetCost
from siggen.sets.set_run import planned_shards
from tests.config.minimal import config, minimal


@pytest.fixture
def path(tmp_path):
    found = tmp_path / "set.yaml"
    found.write_text(yaml_text(minimal(specimens=100)), encoding="utf-8")
    return found


def run(*arguments) -> str:
    """Return what the command prints without the trial, which has tests of its own (tests/sets/test_trial.py)."""
    given = [*map(str, arguments), "--trial", "0"]
    result = CliRunner().invoke(app, given, env={"COLUMNS": "160"})
    assert result.exit_code == 0, result.output
    return result.stdout


def test_json_holds_what_the_configuration_describes(path):
    summary = json.loads(run("plan", path, "--json"))
    assert summary["identity"] == config().identity
    assert summary["records"] == 200
    assert summary["specimens_of_split"] == {"train": 60, "validation": 20, "test": 20}
    assert summary["signal_hours"] == 200 / 3600
    assert summary["mesh_hz"] == [540, 540]
    assert summary["severity_share"] == {"healthy": 0.5, "slight": 0.5}
    assert summary["raw_bytes"] == 200 * 51_200 * 4
    assert summary["shards_of_split"] == {"train": 60, "validation": 20, "test": 20}


def test_records_of_states_and_splits_add_up_to_all():
    summary = plan_summary(
        SetDesign(
            config(
                specimens=47,
                repeats=3,
                operating_points=[{"speed_hz": [20, 35], "torque_nm": 60}] * 2,
            )
        )
    )
    counts = [count for state in summary["states"] for count in state["records_of_split"].values()]
    assert sum(counts) == summary["records"] == 47 * 2 * 2 * 3
    assert summary["mesh_hz"] == [360, 630]


def test_overrides_change_the_plan(path):
    summary = json.loads(
        run("plan", path, "--set", "specimens=10", "--set", "operating_points.0.speed_hz=20", "--json")
    )
    assert summary["records"] == 20
    assert summary["mesh_hz"] == [360, 360]


def test_the_table_shows_identity_splits_and_size(path):
    text = run("plan", path)
    for part in (config().identity, "train 60, validation 20, test 20", "540 Hz", "healthy 50%", "18.4 MB", "slight"):
        assert part in text


def test_errors_of_the_teeth_are_named_by_their_class(tmp_path):
    assert plan_summary(SetDesign(config()))["manufacture"] == "perfect gears"
    override = ("--set", "manufacture={accuracy_class: 6, accuracy_class_driven: 7, draw: state}")
    text = run("plan", Path("tests/configs/casing.yaml"), *override)
    assert "ISO 1328-1 class 6, gear 7; share of its tolerances: [0.3, 0.5]" in text
    assert "drawn anew for" in text


def test_gears_outside_a_models_range_are_named_with_the_limits(path):
    assert json.loads(run("plan", path, "--json"))["stiffness_notes"] == []
    override = ("--set", "gears.pinion.bore_radius_mm=[3, 10]")
    (note,) = json.loads(run("plan", path, *override, "--json"))["stiffness_notes"]
    assert "pinion (18 teeth)" in note
    assert "1.4 to 7" in note
    assert f"note: {note}" in " ".join(run("plan", path, *override).split())


def test_a_large_set_is_planned_quickly(path):
    # a million records; listing must stay far from the minutes that simulating one shard takes
    summary = json.loads(run("plan", path, "--set", "specimens=500000", "--json"))
    assert summary["records"] == 1_000_000
    assert summary["shards_of_split"]["train"] == -(-300_000 // summary["specimens_per_full_shard"])


def test_a_temperature_of_oil_that_acts_on_nothing_is_told(path):
    friction = ["--set", "dynamics.friction.oil_temperature_c=60", "--trial", "0"]
    for model, told in (("off", 1), ("mixed_ehl", 0)):
        said = json.loads(run("plan", path, *friction, "--set", f"dynamics.friction.model={model}", "--json"))
        assert sum("oil_temperature_c acts on no record" in note for note in said["state_notes"]) == told


def test_the_plan_says_what_varies_within_a_record(path):
    varying = [
        "variation.speed.start_ratio=0.5",
        "variation.speed.random_rms=0.003",
        "dynamics.unbalance.grade_mm_s=6.3",
        "dynamics.friction.model=off",
    ]
    overrides = [word for one in varying for word in ("--set", one)]
    summary = json.loads(run("plan", path, *overrides, "--json"))
    assert summary["variation"] == [
        "speed runs from 0.5 to 1 times nominal over a record",
        "slow random speed of 0.3 % rms up to 0.5 Hz",
        "unbalance of grade G6.3 at 50 Hz",
    ]
    assert summary["mesh_hz"] == pytest.approx([540 * 0.5 * 0.988, 540 * 1.012])
    assert "unbalance of grade G6.3" in run("plan", path, *overrides)
    assert json.loads(run("plan", path, "--json"))["variation"] == []


def test_a_set_too_small_to_judge_models_by_is_told_with_the_size_to_take(path):
    assert json.loads(run("plan", path, "--json"))["size_notes"] == []
    small = ("--set", "specimens=24", "--set", "duration_s=0.4")
    few, short = json.loads(run("plan", path, *small, "--json"))["size_notes"]
    assert "below 6 the limits of every score are too wide to tell models apart; take specimens: 30 or more" in few
    assert short.startswith("duration_s: the slowest record has 12 turns of the first shaft, fewer than 2 windows of 8")
    assert short.endswith("take 0.53 s or more")
    said = " ".join(run("plan", path, *small).split())
    assert f"note: {few}" in said
    assert f"note: {short}" in said


def test_a_set_of_pairs_tells_them_and_the_mesh_frequencies_of_all(tmp_path):
    found = tmp_path / "set.yaml"
    pairs = [{"teeth": teeth, "module_mm": 2.5, "face_width_mm": 25} for teeth in ([18, 47], [20, 51], [25, 56])]
    found.write_text(yaml_text(minimal(specimens=2, gears__pairs=pairs)), encoding="utf-8")
    summary = json.loads(run("plan", found, "--json"))
    assert summary["mesh_hz"] == [540, 750]
    assert summary["pairs"][2] == "25/56 teeth, m 2.5, b 25 mm"
    assert "3, of which its gearboxes have 2: 18/47 teeth" in run("plan", found)


def test_more_workers_than_shards_make_a_set_no_faster_than_its_largest_shard() -> None:
    design = load_config("quickstart")
    counts = [shard.record_count for shard in planned_shards(design)]
    assert counts == [5] * 24
    summary = {"records": sum(counts), "life": None}
    cost = cost_summary(SetCost(1.0, 1.0, 1.0, 1.0), summary, design)
    assert cost["largest_shard"] == max(counts) / sum(counts)
    with patch("siggen.workers.choice.default_workers", lambda: 48):
        said = cost_text({**cost, "cpu_hours": 10.0})
    assert said.startswith("about 10 h of this processor, 25 min with 48 processes, as the largest shard is 4% of the")
    with patch("siggen.workers.choice.default_workers", lambda: 16):
        assert "largest" not in cost_text(cost)
