"""Executors of Dask and Ray on clusters of their own: as every other, and a set's bytes do not depend on them."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import closing, suppress
from pathlib import Path

import pytest

from siggen.dataset.reading import open as open_set
from siggen.errors import EngineError
from siggen.sets.generation import generate
from siggen.workers.choice import workers_of
from siggen.workers.tasks import results
from tests.dataset.fake_set import fake_config, fake_physics, file_bytes, simulate_and_die_once, write_fake_set
from tests.workers.tasks import die_at_three, fail_at_three, square

pytestmark = [pytest.mark.filterwarnings("ignore"), pytest.mark.slow]
PACKAGES = {"dask": "distributed", "ray": "ray"}


@pytest.fixture(params=PACKAGES)
def name(request: pytest.FixtureRequest) -> str:
    pytest.importorskip(PACKAGES[request.param])
    return str(request.param)


def test_every_task_gives_one_result_at_its_position(name: str) -> None:
    assert dict(results(workers_of(name, 2), square, range(20))) == {i: i * i for i in range(20)}


def test_a_raising_task_is_named_with_its_traceback(name: str) -> None:
    with pytest.raises(EngineError, match=r"(?s)^3 raised ValueError: three is not allowed.*in fail_at_three"):
        dict(results(workers_of(name, 1), fail_at_three, range(6)))


def test_a_task_that_kills_its_workers_is_named(name: str) -> None:
    with pytest.raises(EngineError, match="3 was lost because the workers that ran it died"):
        dict(results(workers_of(name, 1), die_at_three, range(6)))


def test_no_process_of_a_cluster_listens_to_other_machines(name: str) -> None:
    psutil = pytest.importorskip("psutil")
    with closing(results(workers_of(name, 1), square, range(20))) as found:
        next(found)
        tree = [psutil.Process(), *psutil.Process().children(recursive=True)]
        ends = [end for process in tree for end in process.net_connections("tcp") if end.status == psutil.CONN_LISTEN]
    assert ends
    assert {end.laddr.ip.removeprefix("::ffff:") for end in ends} <= {"127.0.0.1", "::1"}


def test_a_set_has_the_same_bytes(name: str, tmp_path: Path) -> None:
    with fake_physics():
        generate(fake_config(), tmp_path / name, 2, executor=name)
        generate(fake_config(), tmp_path / "serial", executor="serial")
    assert file_bytes(tmp_path / name) == file_bytes(tmp_path / "serial")
    assert open_set(tmp_path / name).labels().num_rows == 30


def test_a_killed_worker_costs_nothing_but_a_repeat(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SIGGEN_TEST_MARKER", str(tmp_path / "killed"))
    write_fake_set(tmp_path / name, workers=2, simulation=simulate_and_die_once, executor=name)
    write_fake_set(tmp_path / "serial")
    assert (tmp_path / "killed").exists()
    assert file_bytes(tmp_path / name) == file_bytes(tmp_path / "serial")


def test_a_killed_driver_loses_nothing_that_is_committed(name: str, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "tests.dataset.fake_set", str(tmp_path / name), "2", name]
    driver = subprocess.Popen(command, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL, start_new_session=True)
    deadline = time.monotonic() + 120
    while len(list((tmp_path / name).glob("data/*.parquet"))) < 2 and time.monotonic() < deadline:
        time.sleep(0.01)
    driver.kill()
    driver.wait()
    with suppress(ProcessLookupError):
        os.killpg(driver.pid, signal.SIGKILL)  # processes of Ray's own, which outlive what they served
    kept = len(list((tmp_path / name).glob("data/*.parquet")))
    assert 2 <= kept < 5
    assert write_fake_set(tmp_path / name, workers=2, executor=name).shards_taken_over == kept
    write_fake_set(tmp_path / "serial")
    assert file_bytes(tmp_path / name) == file_bytes(tmp_path / "serial")
