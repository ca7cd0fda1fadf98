"""The numerical error of a finished set: measured, compared with what the set states, kept without touching the set."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import siggen.record.simulation
from siggen.cli.app import app
from siggen.columns.record import Record, RecordFailure
from siggen.config import Config
from siggen.dataset.manifest import PHYSICS, read_manifest
from siggen.dataset.storage import LocalFolder
from siggen.errors import EXIT_MISMATCH, DatasetError
from siggen.sets.precision import REFERENCE_STEPS, measure_precision
from siggen.sets.verification import verify
from tests.dataset.fake_set import fake_config, file_bytes, simulate, write_fake_set

SECOND = Path(__file__).parent / "schema_2"


def simulate_off_by(config: Config, record_ids: Sequence[int], error: float) -> list[Record | RecordFailure]:
    """Stand in for the physics: the reference differs from everything else by a share of the signal."""
    results = simulate(config, record_ids)
    if (config.dynamics.method, config.dynamics.steps_per_sample) == ("runge_kutta", REFERENCE_STEPS):
        for result in results:
            assert isinstance(result, Record)
            name = next(iter(result.channels))
            result.channels[name] = (result.channels[name] / (1.0 + error)).astype(np.float32)
    return results


def simulate_rounded(config: Config, record_ids: Sequence[int]) -> list[Record | RecordFailure]:
    """Stand in for a converter that makes a difference of 1e-4 one of 1e-2."""
    rounds = any(sensor.bits is not None for sensor in config.sensors)
    return simulate_off_by(config, record_ids, 1e-2 if rounds else 1e-4)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_fake_set(tmp_path / "set", fake_config())
    return tmp_path / "set"


def measured(folder: Path, monkeypatch: pytest.MonkeyPatch, error: float, *options: str):
    monkeypatch.setattr(siggen.record.simulation, "simulate_specimen", partial(simulate_off_by, error=error))
    return CliRunner().invoke(app, ["verify", str(folder), "--sample", "0", "--physics", "7", *options])


def test_the_error_is_found_in_every_state_and_the_set_stays_as_it_is(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = file_bytes(folder)
    assert read_manifest(LocalFolder(folder)).content["integration_tolerance"] == 1e-3
    result = measured(folder, monkeypatch, 5e-4, "--json")
    assert result.exit_code == 0
    found = json.loads(result.stdout)["physics"]
    assert [state["state"] for state in found["states"]] == ["healthy", "slight", "moderate"]
    assert sorted(state["records"] for state in found["states"]) == [2, 2, 3]
    assert all(state["largest"] == pytest.approx(5e-4, rel=1e-3) for state in found["states"])
    kept = json.loads((folder / PHYSICS).read_text())
    assert kept["records"] == found["records"]
    assert kept["within"] is True
    (folder / PHYSICS).rename(folder.parent / PHYSICS)
    assert file_bytes(folder) == before


def test_codes_of_a_converter_that_differ_are_no_error_of_integration(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(siggen.record.simulation, "simulate_specimen", simulate_rounded)
    assert measure_precision(folder, 3).largest == pytest.approx(1e-4, rel=1e-2)


def test_an_error_above_the_stated_one_ends_with_4(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    result = measured(folder, monkeypatch, 2e-3)
    assert result.exit_code == EXIT_MISMATCH
    assert "above the tolerance: 2.0e-03; allowed: 0.001" in result.stdout
    assert verify(folder).mismatches == ()
    kept = folder / PHYSICS
    kept.write_text(kept.read_text().replace('"within": false', '"within": true'))
    assert [mismatch.what for mismatch in verify(folder).mismatches] == [PHYSICS]


def test_the_same_records_are_chosen_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = (json.loads(measured(folder, monkeypatch, 0.0, "--json").stdout)["physics"] for _ in range(2))
    assert first == second
    assert all(state["largest"] == 0.0 for state in first["states"])


def test_a_set_of_the_linear_law_is_measured_and_states_no_tolerance(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_fake_set(tmp_path / "set", fake_config(dynamics={"mesh": {"law": "linear"}}))
    monkeypatch.setattr(siggen.record.simulation, "simulate_specimen", partial(simulate_off_by, error=2e-3))
    found = measure_precision(tmp_path / "set", 3)
    assert found.tolerance is None
    assert found.within
    assert found.largest == pytest.approx(2e-3, rel=1e-2)


def test_a_set_of_another_simulation_is_not_measured() -> None:
    with pytest.raises(DatasetError, match="made by simulation version 1"):
        measure_precision(SECOND, 2)
