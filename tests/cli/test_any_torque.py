"""Idle and reversed operating points from the command line: all records, labels, the plan, and the reference."""

from __future__ import annotations

from pathlib import Path

import pyarrow.parquet as pq
import pytest
import yaml

from tests.command import command
from tests.config.minimal import minimal

TORQUES_NM = (-20.0, 0.0, 0.01, 20.0)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("torques")
    raw = minimal(
        specimens=1,
        fs_hz=25_600.0,
        duration_s=0.08,
        dynamics={"mesh": {"law": "pairs", "damage": "geometry", "tip_relief_um": 5.0}},
        operating_points=[{"speed_hz": 30.0, "torque_nm": torque} for torque in TORQUES_NM],
    )
    file = folder / "torques.yaml"
    file.write_text(yaml.safe_dump(raw, sort_keys=False), encoding="utf-8")
    run("generate", str(file), "--out", str(folder / "set"), "--executor", "serial")
    return file, folder / "set"


def run(*arguments: str) -> str:
    done = command("siggen", *arguments)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


@pytest.mark.slow
def test_records_of_any_torque_are_made_and_labelled(made: tuple[Path, Path]):
    rows = pq.read_table(made[1] / "labels.parquet").to_pylist()
    assert [row["status"] for row in rows] == ["ok"] * 8
    damaged = [row for row in rows if row["state"] == "slight"]
    losses = {row["torque_nm"]: row["mesh_stiffness_loss_as_simulated"] for row in damaged}
    assert losses[-20.0] == 0.0
    assert all(0.0 < losses[torque] < 1.0 for torque in (0.0, 0.01, 20.0))
    lost = {row["torque_nm"]: row["contact_loss_share"] for row in damaged}
    assert lost[0.0] > 0.5
    assert lost[20.0] == lost[-20.0] == 0.0


@pytest.mark.slow
def test_the_plan_says_what_idle_and_reversal_are(made: tuple[Path, Path]):
    said = " ".join(run("plan", str(made[0])).split())
    assert "a torque of 0 N m is idle" in said
    assert "torques below 0 N m load the back flanks" in said
    assert "contact stress at the pitch point [MPa] 0" not in said
