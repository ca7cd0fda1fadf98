"""Killed and interrupted generation: the same command finishes the set, with the bytes of an undisturbed run."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from unittest.mock import patch

import pytest
from typer.testing import CliRunner

import siggen
from siggen.cli.app import app
from siggen.errors import EXIT_INTERRUPTED, DatasetError, UsageError
from siggen.file_writing import LEFTOVER_SUFFIX
from siggen.sets.generation import generate
from siggen.sets.set_run import InterruptionError
from tests.dataset.fake_set import (
    fake_config,
    fake_physics,
    file_bytes,
    write_fake_set,
)


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    path = tmp_path_factory.mktemp("sets") / "reference"
    write_fake_set(path)
    return file_bytes(path)


def start(folder: Path) -> subprocess.Popen[str]:
    """Start generation in a process of its own; simulations take 50 ms per record there."""
    command = [sys.executable, "-m", "tests.dataset.fake_set", str(folder), "2"]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def wait_for(condition, process: subprocess.Popen[str]) -> None:
    deadline = time.monotonic() + 60
    while not condition() and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.005)


def shards(folder: Path) -> list[Path]:
    return sorted((folder / "data").glob("*.parquet"))


def assert_complete(folder: Path, reference: dict[str, bytes]) -> None:
    assert file_bytes(folder) == reference
    assert not list(folder.rglob(f"*{LEFTOVER_SUFFIX}"))


def test_after_sigkill_the_same_command_gives_the_bytes_of_an_undisturbed_run(
    tmp_path: Path, reference: dict[str, bytes]
) -> None:
    process = start(tmp_path)
    wait_for(lambda: len(shards(tmp_path)) >= 2, process)
    process.kill()
    process.communicate()
    kept = len(shards(tmp_path))
    assert 2 <= kept < 5
    assert not (tmp_path / "manifest.json").exists()
    again = write_fake_set(tmp_path)
    assert again.shards_taken_over == kept
    assert_complete(tmp_path, reference)


def test_a_signal_ends_with_130_committed_shards_and_a_hint(tmp_path: Path, reference: dict[str, bytes]) -> None:
    process = start(tmp_path)
    wait_for(lambda: len(shards(tmp_path)) >= 1, process)
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate()
    assert process.returncode == EXIT_INTERRUPTED
    kept = len(shards(tmp_path))
    # nothing but the one message: no traceback of a worker, no complaint of the interpreter
    form = rf"stopped: {kept} of 5 shards of {tmp_path} are finished and stay; lost is what was under way, a shard of "
    assert re.fullmatch(rf"{form}each worker at most; the same command continues from there\n", said)
    assert 1 <= kept < 5
    assert not list(tmp_path.rglob(f"*{LEFTOVER_SUFFIX}"))
    assert write_fake_set(tmp_path).shards_taken_over == kept
    assert_complete(tmp_path, reference)


def test_an_interrupted_call_raises_and_continues(tmp_path: Path, reference: dict[str, bytes]) -> None:
    def interrupt(done: int, total: int) -> None:
        if done >= 8:
            signal.raise_signal(signal.SIGINT)

    with fake_physics(), pytest.raises(InterruptionError, match="2 of 5 shards"):
        generate(fake_config(), tmp_path, 0, interrupt)
    write_fake_set(tmp_path)
    assert_complete(tmp_path, reference)


MEMORY = """
import sys
from pathlib import Path
from benchmarks.peak_memory import peak_memory_bytes
from siggen.sets.generation import generate
from tests.dataset.fake_set import fake_config, fake_physics
if __name__ == "__main__":
    config = fake_config(fs_hz=51200.0, duration_s=10.0, specimens=int(sys.argv[2]))
    with fake_physics():
        generate(config, Path(sys.argv[1]), 2)
    print(peak_memory_bytes()["parent"])
"""


@pytest.mark.slow
def test_the_drivers_memory_does_not_grow_with_the_set(tmp_path: Path) -> None:
    """Records of 4.1 MB: 10 gearboxes are 246 MB of signals, 30 are 737 MB, of which the driver sees none."""
    peaks = []
    for specimens in (10, 30):
        command = [sys.executable, "-c", MEMORY, str(tmp_path / str(specimens)), str(specimens)]
        peaks.append(int(subprocess.run(command, check=True, capture_output=True, text=True).stdout))
    assert peaks[1] < 300e6  # an interpreter with the simulation has about 250 MB
    assert peaks[1] - peaks[0] < 20e6


def test_a_disk_that_takes_no_more_stops_with_what_to_do_and_the_rest_is_made_later(
    tmp_path: Path, reference: dict[str, bytes]
) -> None:
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    largest = max(len(content) for name, content in reference.items() if name.startswith("data/"))
    resource.setrlimit(resource.RLIMIT_FSIZE, (largest - 1, before[1]))
    try:
        with pytest.raises(DatasetError, match="File too large; finished shards stay, and the same command continues"):
            write_fake_set(tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    write_fake_set(tmp_path)
    assert_complete(tmp_path, reference)


def ended(kind: type[ThreadPoolExecutor | ProcessPoolExecutor]) -> Executor:
    executor = kind(1)
    executor.shutdown()
    return executor


@pytest.mark.parametrize(
    ("argument", "value"),
    [
        *(("part", value) for value in ("1/2", (1, 2, 3), 1, (1.0, 2), (3, 2))),
        *(("workers", value) for value in (1.5, "2", -1, True)),
        *(("allowed_loss", value) for value in ("a", float("nan"), -0.1, None)),
        *(("out", value) for value in (5, None)),
    ],
)
def test_an_argument_that_cannot_be_is_refused_by_its_name(tmp_path: Path, argument: str, value: object) -> None:
    given = {"out": tmp_path / "set", argument: value}
    with pytest.raises(UsageError, match=rf"^{argument}: received .*; allowed: "):
        siggen.generate(fake_config(), executor="serial", **given)  # type: ignore[arg-type]
    assert not (tmp_path / "set/config.yaml").exists()


@pytest.mark.parametrize("kind", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_an_executor_that_was_shut_down_is_refused(
    tmp_path: Path, kind: type[ThreadPoolExecutor | ProcessPoolExecutor]
) -> None:
    with pytest.raises(UsageError, match=rf"^executor: received a {kind.__name__} that was shut down; allowed: "):
        siggen.generate(fake_config(), tmp_path / "set", executor=ended(kind))
    assert not (tmp_path / "set").exists()


def test_an_unknown_executor_is_refused_before_anything_is_announced(tmp_path: Path) -> None:
    given = ["generate", "quickstart", "--out", str(tmp_path / "set"), "--executor", "foo"]
    with patch("siggen.sets.compilation.is_compiled", lambda _: False):
        said = CliRunner().invoke(app, given)
    assert isinstance(said.exception, UsageError)
    assert "compiling" not in said.stderr
