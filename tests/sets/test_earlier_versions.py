"""Sets of earlier simulations stay readable."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import siggen
from siggen.cli.app import app
from siggen.columns.record import Record, signal_matrix
from siggen.columns.versions import SCHEMA_VERSION, SIMULATION_VERSION
from siggen.dataset.seal import sealed, unsealed
from siggen.errors import DatasetError
from siggen.sets.extension import extend
from siggen.sets.verification import verify
from tests.dataset.fake_set import file_bytes, verify_fake_set, write_fake_set

NEW_LABEL = "mesh_stiffness_loss_as_simulated"

SECOND = Path(__file__).parent / "earlier_set"
"""Two gearboxes in two states, generated as one and extended by one by the first simulation; indexed since."""
RELEASED = Path(__file__).parent / "set_of_0_2"
"""Two gearboxes of `quickstart` in four states, one of them an extension, by siggen 0.2.0; without run.json."""
ROUNDING = 1e-6
"""Of the largest force, and of the rms of a signal in `benchmarks.golden`: how far kinds of processors lie apart."""


def say(folder: Path, **facts: object) -> None:
    """Change what a manifest says about its set, and seal it again."""
    manifest = folder / "manifest.json"
    manifest.write_bytes(sealed({**unsealed("manifest.json", manifest.read_bytes()), **facts}))


def test_an_extended_set_of_the_first_simulation_opens_and_every_byte_of_it_is_checked() -> None:
    dataset = siggen.open(SECOND)
    assert dataset.inventory.simulation_version == 1
    assert [list(shard.specimens) for shard in dataset.index.shards()] == [[(0, 0)], [(1, 1)]]
    assert dataset.labels()["record_id"].to_pylist() == [0, 1, 2, 3]
    signals = np.concatenate([signal_matrix(batch.column("accel_lid_vertical_m_s2")) for batch in dataset.records()])
    assert signals.shape == (4, 1600)
    # a spall in every second record, where the same gearbox hums when it is healthy
    assert (signals.std(axis=1)[[1, 3]] > 2.0 * signals.std(axis=1)[[0, 2]]).all()
    forces = np.stack([dataset.record_internals(i)["mesh_force_n"] for i in range(4)])  # type: ignore[index]
    assert forces.shape == (4, 1600)
    assert (forces.mean(axis=1) > 0.0).all()
    found = verify(SECOND, 0)
    assert found.mismatches == ()


def test_its_hashes_are_verified_and_a_flipped_byte_shows(tmp_path: Path) -> None:
    folder = Path(shutil.copytree(SECOND, tmp_path / "set"))
    data = folder / "data" / "train-00000.parquet"
    content = bytearray(data.read_bytes())
    content[len(content) // 2] ^= 1
    data.write_bytes(content)
    assert [m.what for m in verify(folder).mismatches] == ["data/train-00000.parquet"]


def test_a_set_of_another_simulation_is_neither_resumed_nor_extended(tmp_path: Path) -> None:
    folder = Path(shutil.copytree(SECOND, tmp_path / "set"))
    before = file_bytes(folder)
    with pytest.raises(DatasetError, match="read and verified, not extended"):
        extend(folder, "+1", 0)
    with pytest.raises(DatasetError):
        write_fake_set(folder)
    assert file_bytes(folder) == before


def test_a_newer_unknown_schema_is_refused_in_words_and_verified_by_its_hashes(tmp_path: Path) -> None:
    write_fake_set(tmp_path)
    say(tmp_path, schema_version="99")
    with pytest.raises(DatasetError, match="received schema version 99; allowed is 3 and 4"):
        siggen.open(tmp_path)
    found = verify_fake_set(tmp_path, 3)
    assert found.mismatches == ()
    assert found.comparison.startswith("hashes checked; 3 records not simulated again")


def test_a_finished_set_of_a_newer_version_is_not_made_again(tmp_path: Path) -> None:
    write_fake_set(tmp_path)
    say(tmp_path, schema_version="99")
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.*")}
    with pytest.raises(DatasetError, match="received schema version 99"):
        write_fake_set(tmp_path)
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.*") if path in before} == before


def test_records_of_another_simulation_are_not_simulated_again_and_that_is_said(tmp_path: Path) -> None:
    write_fake_set(tmp_path)
    other = SIMULATION_VERSION + 1
    say(tmp_path, simulation_version=other)
    result = CliRunner().invoke(app, ["verify", str(tmp_path), "--sample", "3"])
    assert result.exit_code == 0, result.output
    told = f"hashes checked; 3 records not simulated again: made by simulation version {other}, this is {other - 1}"
    assert told in result.stdout.splitlines()
    found = json.loads(CliRunner().invoke(app, ["verify", str(tmp_path), "--json"]).stdout)
    assert found["records"] == []
    assert found["ok"]


def test_a_new_set_says_which_simulation_made_it(tmp_path: Path) -> None:
    write_fake_set(tmp_path)
    manifest = siggen.open(tmp_path).manifest
    assert (manifest["schema_version"], manifest["simulation_version"]) == (SCHEMA_VERSION, SIMULATION_VERSION)
    assert np.isfinite(siggen.open(tmp_path).labels(columns=[NEW_LABEL])[NEW_LABEL].to_numpy()).all()


def test_records_of_the_released_version_are_read_verified_and_simulated_again_as_they_were() -> None:
    found = verify(RELEASED, 0)
    assert found.mismatches == ()
    dataset, config = siggen.open(RELEASED), siggen.load_config(RELEASED / "config.yaml")
    assert config.identity == dataset.manifest["identity"]
    for number in (2, 5):  # a spall, and a healthy record of the extension
        (made,) = siggen.simulate(config, [number])
        assert isinstance(made, Record)
        kept, internals = dataset.record(number), dataset.record_internals(number)
        for name, signal in made.channels.items():
            step = np.unique(np.diff(np.unique(signal))).min()  # a rounding may cross a step of the converter
            assert np.abs(signal - kept[f"accel_{name}_m_s2"]).max() <= 1.01 * step
            assert (signal == kept[f"accel_{name}_m_s2"]).mean() > 0.99
        force = internals["mesh_force_n"]
        assert np.abs(made.internals["mesh_force_n"] - force).max() <= ROUNDING * np.abs(force).max()
        assert kept["state"] == made.labels["state"]
        assert kept["housing_first_mode_hz"] == pytest.approx(made.labels["housing_first_mode_hz"], rel=ROUNDING)
