"""Somebody adds a source of noise, a module and a line: sensors have its key, channels its values, sets its column."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import siggen
from tests.toy_process import said_by

CONFIG = """
extends: quickstart
name: toy
specimens: 1
duration_s: 0.2
repeats: 1
states: {{healthy: {{}}}}
sensors: {{lid: {{place: lid, position_mm: [5, 5], bits: null{source}}}}}
"""
SIGNAL, LABEL = "accel_lid_vertical_m_s2", "toy_drift_lid_vertical_m_s2_per_s"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, str]]:
    """Return a folder with sets without and with the source, and what commands said."""
    folder = tmp_path_factory.mktemp("toy")
    drift = ", toy_drift: {size_m_s2_per_s: [5, 9]}"
    sources = {"without": "", "drift": drift, "mistake": ", toy_drift: {size_m_s2_per_s: -1}"}
    for name, source in sources.items():
        (folder / f"{name}.yaml").write_text(CONFIG.format(source=source))
    lines = {name: f"siggen generate {name}.yaml --out {name} --engine serial" for name in ("without", "drift")}
    lines["mistake"] = "siggen plan mistake.yaml --trial 0"
    return folder, said_by("tests.noise.with_toys", folder, lines, {"mistake": 2})


def test_its_key_its_column_and_what_it_adds(made: tuple[Path, dict[str, str]]) -> None:
    folder, _ = made
    without, drift = (siggen.open(folder / name) for name in ("without", "drift"))
    record = drift.record(0)
    added = record[SIGNAL].astype(float) - without.record(0)[SIGNAL].astype(float)
    # signals are float32, below 100 m/s²
    np.testing.assert_allclose(added, record[LABEL] * np.arange(added.size) / drift.fs_hz, atol=2e-5)
    assert 5.0 <= record[LABEL] <= 9.0
    assert LABEL not in without.labels().column_names
    card = (folder / "drift" / "README.md").read_text(encoding="utf-8")
    assert f"| `{LABEL}` | double | m/s^2/s | drift per second in lid_vertical |" in card


def test_a_mistake_in_it_is_named(made: tuple[Path, dict[str, str]]) -> None:
    wanted = "sensors.lid.toy_drift.size_m_s2_per_s: received -1.0; allowed: a number of at least 0"
    assert wanted in " ".join(made[1]["mistake"].split())
