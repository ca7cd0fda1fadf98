"""Gearboxes with casing that cannot exist are refused by name; those whose integration runs away are told by number."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from siggen.checks.loading import load_config
from siggen.cli.app import app
from siggen.columns.record import RecordFailure
from siggen.errors import EXIT_RECORDS_FAILED, ConfigError
from tests.simulated import simulate

CONFIG = "tests/configs/casing.yaml"
SHORT = ["specimens=1", "duration_s=0.02", "operating_points=[{speed_hz: 30.0, torque_nm: 20.0}]"]
HEALTHY = "states={healthy: {}}"
# So much damping that nothing but rounding is left of the shaft; no stiffness alone makes the scheme run away.
DAMPED = "dynamics.pinion.bearing.damping_n_s_per_m"


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ("dynamics.pinion.bearing.stiffness_n_per_m=-1e8", "allowed: a number above 0"),
        ("dynamics.input_coupling.stiffness_nm_per_rad=-1", "allowed: a number above 0"),
        ("housing.mass_kg=0", "allowed: a number above 0"),
        ("housing.bolts.shear_stiffness_n_per_m=0", "allowed: a number above 0"),
        ("housing.loose_foot_share=0", "allowed: a number above 0 and of at most 1"),
        ("housing.loose_foot_share=1.5", "allowed: a number above 0 and of at most 1"),
        ("housing.bolts.positions_mm=[[9, 0], [9, 0]]", "about a single one the casing would turn freely"),
        ("dynamics.friction.coefficient=-0.1", "allowed: a number from 0 to 0.5"),
        ("operating_points.0.speed_hz=0", "allowed: a number above 0"),
        ("variation.speed.end_ratio=0.02", "allowed: a mean torque above 0 at the mesh"),
    ],
)
def test_an_impossible_gearbox_is_refused_by_the_name_of_its_number_alone(change: str, named: str) -> None:
    with pytest.raises(ConfigError) as refused:
        load_config(CONFIG, [*SHORT, change])
    (problem,) = refused.value.problems
    assert problem.path == change.partition("=")[0]
    assert named in problem.allowed


def test_a_diverged_record_says_where_and_beyond_what() -> None:
    (failure,) = simulate(load_config(CONFIG, [*SHORT, HEALTHY, f"{DAMPED}=1e20"]), [0])
    assert isinstance(failure, RecordFailure)
    assert failure.status == "diverged"
    for part in ("approach ", " m at ", "allowed are finite values within", "raise steps_per_sample (received 2)"):
        assert part in failure.reason


def test_diverged_records_are_counted_listed_and_leave_the_others(tmp_path: Path) -> None:
    changes = [*SHORT[1:], HEALTHY, "specimens=6"]
    changes += [f"{DAMPED}={{one_of: [800, 1e+20]}}"]
    arguments = [word for change in changes for word in ("--set", change)]
    arguments += ["--allowed-loss", "1", "--out", str(tmp_path / "set"), "--executor", "serial"]
    result = CliRunner().invoke(app, ["generate", CONFIG, *arguments])
    assert result.exit_code == EXIT_RECORDS_FAILED, result.output
    manifest = json.loads((tmp_path / "set" / "manifest.json").read_text())
    failed = {failure["record_id"] for failure in manifest["failures"]}
    assert 0 < len(failed) < 6
    assert manifest["rows"] + len(failed) == 6
    assert all(failure["status"] == "diverged" and "approach" in failure["reason"] for failure in manifest["failures"])
    for record_id in failed:
        assert f"record {record_id} failed: diverged (approach" in result.output
    assert f"{len(failed)} record" in result.output
