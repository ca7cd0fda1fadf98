"""A set of accelerations, speeds and a transmission error through the commands, as a user runs them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

import siggen
from diagnostics.indicators.table import record_table
from diagnostics.loader import StreamSettings, WindowDataset
from siggen.errors import UsageError
from tests.command import command

MIXED = """
extends: quickstart
specimens: 2
duration_s: 0.5
operating_points: [{speed_hz: 33.0, torque_nm: 40.0}]
splits: {train: 10, validation: 5, test: 5}
sensors:
  others: null
  side: {kind: accelerometer}
  first: {kind: encoder, place: pinion, pulses_per_turn: 1800}
  second: {kind: encoder, place: gear, pulses_per_turn: 1800}
  error: {kind: transmission_error, driver_encoder: first, driven_encoder: second}
"""


def ran(package: str, *options: str) -> str:
    found = command(package, *options)
    assert found.returncode == 0, found.stderr
    return found.stdout + found.stderr


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("mixed")
    (place / "mixed.yaml").write_text(MIXED, encoding="utf-8")
    ran("siggen", "generate", str(place / "mixed.yaml"), "--out", str(place / "set"), "--executor", "serial")
    return place / "set"


@pytest.fixture(scope="module")
def mixed(folder: Path) -> Any:
    return siggen.open(folder)


@pytest.mark.slow
def test_windows_come_by_quantity(mixed: Any) -> None:
    every, speeds = (WindowDataset(mixed, "train", StreamSettings(quantity=q)) for q in (None, "angular speed"))
    held = [channel.quantity for channel in mixed.channels]
    chosen = [k for k, quantity in enumerate(held) if quantity == "angular speed"]
    assert len(chosen) == 2 < len(held)
    np.testing.assert_array_equal(speeds[0]["windows"], every[0]["windows"][chosen])
    with pytest.raises(UsageError, match=r"'pressure'.*acceleration, angular speed, transmission error"):
        WindowDataset(mixed, "train", StreamSettings(quantity="pressure"))


@pytest.mark.slow
def test_indicators_explorer_and_audit_take_the_set_in_fresh_processes(folder: Path, mixed: Any) -> None:
    out = folder.parent
    ran("diagnostics", "indicators", str(folder), "--out", str(out / "ranking"))
    ran("diagnostics", "explore", str(folder), "--out", str(out / "explorer.html"))
    ran("diagnostics", "audit", str(folder), "--out", str(out / "audit"))
    table = pq.read_table(out / "ranking" / "indicators.parquet")
    speeds = [channel.name for channel in mixed.channels if channel.quantity == "angular speed"]
    assert len(speeds) == 2
    for name in speeds:
        assert f"crest_factor__{name}" not in table.column_names
        ripple = np.array(table.column(f"speed_ripple__{name}"))
        assert np.isfinite(ripple).all()
        assert 0.0 < ripple.max() < 0.02
        # the mean speed of 207 rad/s on the pinion, 79 on the gear, is no vibration
        assert max(table.column(f"rms_without_mean__{name}").to_pylist()) < 5.0
    assert "Speed ripple" in (out / "explorer.html").read_text(encoding="utf-8")
    assert "rad/s" in (out / "explorer.html").read_text(encoding="utf-8")
    with pytest.raises(UsageError, match=r"holds angular speed.*acceleration alone.*side"):
        record_table(mixed).values([f"crest_factor__{speeds[0]}"])
