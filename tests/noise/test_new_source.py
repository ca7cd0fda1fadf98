"""Somebody adds a source of noise, a module and a line: sensors have its key, channels its values, sets its column."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np

import siggen
from tests.house.source_tree import ROOT

CONFIG = """
extends: quickstart
name: toy
specimens: 1
duration_s: 0.2
repeats: 1
states: [{{name: healthy}}]
sensors: [{{name: lid, place: lid, position_mm: [5, 5], bits: null{source}}}]
"""
SIGNAL, LABEL = "accel_lid_vertical_m_s2", "toy_drift_lid_vertical_m_s2_per_s"


def command(folder: Path, *words: str, code: int = 0) -> str:
    """Run siggen with the toy registered, in a fresh process."""
    done = subprocess.run(
        [sys.executable, "-m", "tests.noise.with_toys", *words],
        cwd=folder, env={**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "COLUMNS": "160"},
        capture_output=True, text=True, timeout=500, check=False,
    )  # fmt: skip
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout + done.stderr


def test_its_key_its_column_and_what_it_adds(tmp_path: Path) -> None:
    sizes = {"without": "", "drift": ", toy_drift: {size_m_s2_per_s: {kind: uniform, low: 5, high: 9}}"}
    for name, source in sizes.items():
        (tmp_path / f"{name}.yaml").write_text(CONFIG.format(source=source))
        command(tmp_path, "generate", f"{name}.yaml", "--out", name, "--engine", "serial")
    without, drift = (siggen.open(tmp_path / name) for name in sizes)
    record = drift.record(0)
    added = record[SIGNAL].astype(float) - without.record(0)[SIGNAL].astype(float)
    # signals are float32, below 100 m/s²
    np.testing.assert_allclose(added, record[LABEL] * np.arange(added.size) / drift.fs_hz, atol=2e-5)
    assert 5.0 <= record[LABEL] <= 9.0
    assert LABEL not in without.labels().column_names
    card = (tmp_path / "drift" / "README.md").read_text(encoding="utf-8")
    assert f"| `{LABEL}` | double | m/s^2/s | drift per second in lid_vertical |" in card


def test_a_mistake_in_it_is_named(tmp_path: Path) -> None:
    (tmp_path / "toy.yaml").write_text(CONFIG.format(source=", toy_drift: {size_m_s2_per_s: -1}"))
    said = command(tmp_path, "plan", "toy.yaml", "--trial", "0", code=2)
    assert "sensors.0.toy_drift.size_m_s2_per_s: received -1.0; allowed: a number of at least 0" in " ".join(
        said.split()
    )
