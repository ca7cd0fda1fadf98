"""A set of gearboxes with two meshes by command, each in a process of its own: generated, ranked, trained, looked at.

Slow: eight gearboxes are simulated.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import yaml

from tests.config.minimal import by_name
from tests.config.staged import SPALL, staged

pytestmark = pytest.mark.slow

STATES = [
    {"name": "healthy"},
    {"name": "behind", "severity": "severe", "damage": {**SPALL, "gear": "slow_pinion", "teeth": 1}},
]
THIRD_SHAFT = [
    {"name": "end", "place": "slow_bearing"},
    {"kind": "bearing_force", "name": "washer", "place": "slow_bearing", "range_n": 1e5},
    {"kind": "encoder", "name": "out", "place": "slow_gear"},
]


def run(app: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", f"from {app}.cli.app import main; main()", *arguments],
        capture_output=True,
        text=True,
        check=False,
        timeout=500,
    )


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("two_stages")
    sensors = [{"name": "lid", "place": "gear_bearing", "bits": 24}]
    raw = staged(specimens=8, fs_hz=12_800.0, duration_s=1.2, sensors=by_name(sensors), states=by_name(STATES))
    (folder / "two.yaml").write_text(yaml.safe_dump(raw, sort_keys=False), encoding="utf-8")
    done = run("siggen", "generate", str(folder / "two.yaml"), "--out", str(folder / "set"), "--executor", "serial")
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.fixture(scope="module")
def ranked(made: Path) -> pa.Table:
    done = run("diagnostics", "indicators", str(made / "set"), "--out", str(made / "ranked"))
    assert done.returncode == 0, done.stdout + done.stderr
    return pq.read_table(made / "ranked/indicators.parquet")


def medians(table: pa.Table, name: str) -> tuple[float, float]:
    """Return the medians of the healthy and of the damaged records."""
    states, values = np.array(table.column("state").to_pylist()), table.column(name).to_numpy()
    return float(np.median(values[states == "healthy"])), float(np.median(values[states == "behind"]))


def test_damage_of_the_second_mesh_shows_in_the_sidebands_of_that_mesh(ranked: pa.Table) -> None:
    """The damaged tooth meets once per turn of its own shaft: sidebands of its mesh line grow, not those of the first.

    Perfect gears without noise: what a healthy record has in sidebands is below a hundredth of the line. That line is
    0.04 m/s2, so the converter has 24 bits: steps of 16 bits, 0.015 m/s2, alone make a hundredth.
    """
    healthy, damaged = medians(ranked, "sideband_ratio_slow_pinion_h1_k3__lid_vertical")
    assert healthy < 0.01
    assert damaged > 5.0 * healthy
    first = medians(ranked, "sideband_ratio_pinion_h1_k3__lid_vertical")
    assert damaged / healthy > 2.0 * first[1] / first[0]


def test_a_slow_gear_of_four_turns_is_undefined_and_the_notes_say_so_once(made: Path, ranked: pa.Table) -> None:
    gear = [name for name in ranked.column_names if "_slow_gear" in name]
    assert len(gear) > 100
    assert not np.isfinite(np.concatenate([ranked.column(name).to_numpy() for name in gear])).any()
    numbers = json.loads((made / "ranked/indicators.json").read_text(encoding="utf-8"))
    said = " ".join(numbers["notes"])
    assert said.count("all slow_gear averages undefined, since they need 8 slow_gear revolutions") == 1


def test_classifiers_take_features_of_both_meshes_and_predict_refuses_them(made: Path) -> None:
    folder = made / "report"
    done = run("diagnostics", "report", str(made / "set"), "--out", str(folder))
    assert done.returncode == 0, done.stdout + done.stderr
    names = json.loads((folder / "models/feature_names.json").read_text(encoding="utf-8"))
    assert "sideband_ratio_slow_pinion_h1_k3__lid_vertical" in json.dumps(names)
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "mesh harmonic 1, mesh slow" in page
    assert "slow_pinion, mesh harmonic 1, sidebands 1 to 3" in page
    record = made / "record.csv"
    record.write_text("lid_vertical [m/s2]\n" + "\n".join(str(k % 7) for k in range(20_000)), encoding="utf-8")
    told = run("diagnostics", "predict", str(folder), str(record), "--fs", "12800", "--teeth", "18,47")
    assert told.returncode != 0
    assert "further meshes slow" in told.stderr


def test_a_report_takes_an_accelerometer_a_washer_and_an_encoder_of_the_third_shaft(tmp_path: Path) -> None:
    raw = staged(specimens=3, fs_hz=12_800.0, duration_s=0.3, sensors=by_name(THIRD_SHAFT), states=by_name(STATES))
    (tmp_path / "third.yaml").write_text(yaml.safe_dump(raw, sort_keys=False), encoding="utf-8")
    done = run(
        "siggen", "generate", str(tmp_path / "third.yaml"), "--out", str(tmp_path / "set"), "--executor", "serial"
    )
    assert done.returncode == 0, done.stdout + done.stderr
    done = run("diagnostics", "report", str(tmp_path / "set"), "--out", str(tmp_path / "report"), "--no-cnn")
    assert done.returncode == 4, done.stdout + done.stderr  # of three gearboxes nothing is judged
    page = (tmp_path / "report/report.html").read_text(encoding="utf-8")
    assert "washer_vertical" in page
    held = {name.partition("__")[2] for name in pq.read_schema(tmp_path / "report/features.parquet").names}
    assert {"end_vertical", "washer_vertical", "out_rotation"} <= held


def test_audit_and_explorer_take_the_set(made: Path) -> None:
    for arguments in (("audit", str(made / "set")), ("explore", str(made / "set"), "--out", str(made / "look.html"))):
        done = run("diagnostics", *arguments)
        assert done.returncode == 0, done.stdout + done.stderr
    assert "mesh slow" in (made / "look.html").read_text(encoding="utf-8")
