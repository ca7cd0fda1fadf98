"""The numerical error of a finished set: measured, compared with what the set states, kept without touching the set."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import siggen.record.simulation
from siggen.cli.app import app
from siggen.columns.record import RecordFailure, SimulatedRecord
from siggen.dataset.manifest import PHYSICS, read_manifest
from siggen.dataset.seal import sealed, unsealed
from siggen.dataset.storage import LocalFolder
from siggen.errors import EXIT_MISMATCH, DatasetError
from siggen.gearbox.design import SetDesign
from siggen.sets.precision import FIRST_STEPS, MOST_STEPS, measure_precision
from siggen.sets.verification import verify
from tests.dataset.fake_set import copy_fake_set, fake_config, file_bytes, simulate, write_fake_set


def simulate_off_by(
    config: SetDesign, record_ids: Sequence[int], error: float
) -> list[SimulatedRecord | RecordFailure]:
    """Stand in for the physics: the reference differs from everything else by a share of the signal."""
    results = simulate(config, record_ids)
    if config.config.dynamics.method == "runge_kutta":
        for result in results:
            assert isinstance(result, SimulatedRecord)
            name = next(iter(result.channels))
            result.channels[name] = (result.channels[name] / (1.0 + error)).astype(np.float32)
    return results


def simulate_converging(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Stand in for a reference whose error falls with its steps alone, and slowly."""
    steps = config.config.dynamics.steps_per_sample
    return simulate_off_by(config, record_ids, 1e-3 * FIRST_STEPS / steps)


def simulate_astray(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Stand in for a reference that finer steps lead away."""
    return simulate_off_by(config, record_ids, 1e-5 * config.config.dynamics.steps_per_sample)


def simulate_told(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Stand in for records that are off, with a label that says so."""
    results = simulate_off_by(config, record_ids, 2e-3)
    told = {"integration_error": 2.5e-3} if config.config.dynamics.method == "exponential" else {}
    return [replace(one, labels={**one.labels, **told}) for one in results if isinstance(one, SimulatedRecord)]


def simulate_rounded(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Stand in for a converter that makes a difference of 1e-4 one of 1e-2."""
    rounds = any(sensor.bits is not None for sensor in config.sensors)
    return simulate_off_by(config, record_ids, 1e-2 if rounds else 1e-4)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_fake_set(tmp_path / "set", fake_config())
    return tmp_path / "set"


def measured(folder: Path, monkeypatch: pytest.MonkeyPatch, error: float, *options: str):
    monkeypatch.setattr(siggen.sets.drawn, "simulated", partial(simulate_off_by, error=error))
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
    monkeypatch.setattr(siggen.sets.drawn, "simulated", simulate_rounded)
    assert measure_precision(folder, 3, workers=0).largest == pytest.approx(1e-4, rel=1e-2)


def test_an_error_above_the_stated_one_ends_with_4(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    result = measured(folder, monkeypatch, 2e-3)
    assert result.exit_code == EXIT_MISMATCH
    assert "above the tolerance: 2.0e-03; allowed: 0.001" in result.stdout
    assert verify(folder).mismatches == ()
    kept = folder / PHYSICS
    kept.write_text(kept.read_text().replace('"within": false', '"within": true'))
    assert [mismatch.what for mismatch in verify(folder).mismatches] == [PHYSICS]


def test_the_reference_halves_its_steps_until_two_agree(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(siggen.sets.drawn, "simulated", simulate_converging)
    found = measure_precision(folder, 3, workers=0)
    assert found.reference == f"runge_kutta, up to {16 * FIRST_STEPS} steps per sample"
    assert found.apart == pytest.approx(1e-3 / 16, rel=1e-2)
    assert found.largest == pytest.approx(1e-3 / 16, rel=1e-2)


def test_a_reference_that_never_agrees_ends_and_says_so(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(siggen.sets.drawn, "simulated", simulate_astray)
    found = measure_precision(folder, 3, workers=0)
    assert found.reference == f"runge_kutta, up to {MOST_STEPS} steps per sample"
    assert found.apart == pytest.approx(0.5e-5 * MOST_STEPS, rel=1e-2)


def test_an_error_that_its_label_tells_is_no_fault(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(siggen.sets.drawn, "simulated", simulate_told)
    found = measure_precision(folder, 3, workers=0)
    assert (found.told, found.untold, found.within) == (3, 0, True)


def test_the_same_records_are_chosen_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(siggen.sets.drawn, "simulated", partial(simulate_off_by, error=0.0))
    first, second = (measure_precision(folder, 7, workers=0) for _ in range(2))
    assert first == second
    assert all(state.largest == 0.0 for state in first.states)


def test_a_set_of_the_linear_law_is_measured_and_states_no_tolerance(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_fake_set(tmp_path / "set", fake_config(dynamics={"mesh": {"law": "linear"}}))
    monkeypatch.setattr(siggen.sets.drawn, "simulated", partial(simulate_off_by, error=2e-3))
    found = measure_precision(tmp_path / "set", 3, workers=0)
    assert found.tolerance is None
    assert found.within
    assert found.largest == pytest.approx(2e-3, rel=1e-2)


def test_a_set_of_another_simulation_is_not_measured(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    manifest = tmp_path / "manifest.json"
    manifest.write_bytes(sealed({**unsealed("manifest.json", manifest.read_bytes()), "simulation_version": 1}))
    with pytest.raises(DatasetError, match="made by simulation version 1"):
        measure_precision(tmp_path, 2)
