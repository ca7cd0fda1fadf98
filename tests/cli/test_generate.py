"""`siggen generate`: path on stdout, everything else on stderr, and the exit codes."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner

import siggen.sets.generation
from siggen.cli.app import app
from siggen.columns.record import RecordFailure
from siggen.config import yaml_text
from siggen.errors import EXIT_INTERRUPTED, EXIT_RECORDS_FAILED, EXIT_USAGE, DatasetError
from tests.dataset.fake_set import fake_config, file_bytes, simulate, simulate_with_failures, write_fake_set


@pytest.fixture
def config(tmp_path: Path) -> Path:
    path = tmp_path / "fake.yaml"
    path.write_text(yaml_text(fake_config().canonical()))
    return path


@pytest.fixture
def simulation(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """Let the command generate with a stand-in for the physics, in this process."""
    chosen = SimpleNamespace(function=simulate)

    def stand_in(loaded, out, workers, progress, *, part, executor, events, allowed_loss):
        assert (workers in (None, 1), executor) == (True, None)
        return write_fake_set(
            out, loaded, part=part, simulation=chosen.function, events=events, allowed_loss=allowed_loss
        )

    monkeypatch.setattr(siggen.sets.generation, "generate", stand_in)
    return chosen


def test_the_path_alone_is_on_stdout(config: Path, tmp_path: Path, simulation: SimpleNamespace) -> None:
    result = CliRunner().invoke(app, ["generate", str(config), "--out", str(tmp_path / "set")])
    assert result.exit_code == 0
    assert result.stdout == f"{tmp_path / 'set'}\n"
    assert "30 records in the set" in result.stderr
    again = CliRunner().invoke(app, ["generate", str(config), "--out", str(tmp_path / "set")])
    assert again.exit_code == 0
    assert "finished already" in again.stderr


def test_failed_records_end_with_3_and_are_named(config: Path, tmp_path: Path, simulation: SimpleNamespace) -> None:
    simulation.function = simulate_with_failures
    result = CliRunner().invoke(
        app, ["generate", str(config), "--out", str(tmp_path / "set"), "--workers", "1", "--allowed-loss", "0.2"]
    )
    assert result.exit_code == EXIT_RECORDS_FAILED
    assert "record 8 failed: diverged (motion left the backlash)" in result.stderr
    assert "3 records could not be simulated; the set is usable" in result.stderr
    assert result.stdout == f"{tmp_path / 'set'}\n"


def test_a_long_list_of_failures_is_cut_short(config: Path, tmp_path: Path, simulation: SimpleNamespace) -> None:
    simulation.function = lambda config, ids: [RecordFailure(i, "diverged", "always") for i in ids]
    result = CliRunner().invoke(app, ["generate", str(config), "--out", str(tmp_path / "set"), "--allowed-loss", "1"])
    assert result.stderr.count("failed: diverged") == 10
    assert "30 records could not be simulated" in result.stderr


def test_another_set_in_the_folder_is_a_usage_error(config: Path, tmp_path: Path, simulation: SimpleNamespace) -> None:
    write_fake_set(tmp_path / "set", fake_config(seed=8))
    result = CliRunner().invoke(app, ["generate", str(config), "--out", str(tmp_path / "set")])
    assert isinstance(result.exception, DatasetError)
    assert result.exception.exit_code == EXIT_USAGE
    assert "seed: 8 there, 7 asked for" in str(result.exception)


SCRIPT = str(Path(sys.executable).parent / "siggen")
QUICKSTART = str(Path(__file__).parents[2] / "tests/configs/linear_pits.yaml")
SMALL = ["--set", "specimens=2", "--set", "duration_s=0.2", "--set", "fs_hz=20480", "--set", "mesh_harmonics=2"]


@pytest.mark.slow
def test_the_real_command_generates_verifies_is_silent_in_a_pipe_and_repeatable(tmp_path: Path) -> None:
    for name, workers in (("a", "1"), ("b", "2")):
        arguments = [SCRIPT, "generate", QUICKSTART, "--out", str(tmp_path / name), "--workers", workers, *SMALL]
        run = subprocess.run(arguments, capture_output=True, text=True, check=False)
        assert run.returncode == 0, run.stderr
        assert run.stdout == f"{tmp_path / name}\n"
        assert "\x1b" not in run.stderr
        # On a machine whose cache is empty one line more says that the simulation is compiled.
        told = [
            line for line in run.stderr.splitlines() if not line.startswith("compiling the simulation, the first time")
        ]
        assert len(told) == 1
    assert file_bytes(tmp_path / "a") == file_bytes(tmp_path / "b")
    verified = subprocess.run(
        [SCRIPT, "verify", str(tmp_path / "a"), "--sample", "3"], capture_output=True, text=True, check=False
    )
    assert verified.returncode == 0, verified.stderr
    assert "3 records simulated again, compared bit for bit" in verified.stdout


@pytest.mark.slow
def test_ctrl_c_on_the_real_command_ends_with_130_and_the_same_command_continues(tmp_path: Path) -> None:
    arguments = [SCRIPT, "generate", QUICKSTART, "--out", str(tmp_path / "set"), *SMALL, "--set", "specimens=12"]
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not (tmp_path / "set/config.yaml").exists() and process.poll() is None:
        time.sleep(0.01)
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    out, said = process.communicate()
    assert process.returncode == EXIT_INTERRUPTED, said
    assert out == ""
    assert "the same command continues from there" in said
    assert "Traceback" not in said
    assert subprocess.run(arguments, capture_output=True, check=False).returncode == 0
