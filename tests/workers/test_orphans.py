"""Workers whose driver was killed end within two seconds, however busy they are."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

DRIVER = """
import sys
from siggen.workers.choice import workers_of
from siggen.workers.tasks import results
from tests.workers.tasks import busy
if __name__ == "__main__":
    list(results(workers_of(sys.argv[1], 2), busy, range(8)))
"""
STARTING = """
import os, sys
from siggen.workers.choice import workers_of
from siggen.workers.tasks import results
if __name__ == "__main__":
    os.environ["SIGGEN_TEST_DRIVER"] = str(os.getpid())
    from tests.workers.slow_to_import import same
    list(results(workers_of(sys.argv[1], 2), same, range(8)))
"""
LIBRARY = """
import os
from multiprocessing import get_context
from siggen.workers.orphan import ending_with_this
if __name__ == "__main__":
    os.environ["SIGGEN_TEST_DRIVER"] = str(os.getpid())
    from tests.workers.slow_to_import import same
    with ending_with_this():
        started = [get_context("spawn").Process(target=same, args=(1,)) for _ in range(2)]
        for one in started:
            one.start()
        for one in started:
            one.join()
"""

EXECUTORS = [
    "processes",
    pytest.param("dask", marks=pytest.mark.slow),
    pytest.param("ray", marks=pytest.mark.slow),
]


def is_alive(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"


def wait_until(condition, seconds: float) -> bool:
    deadline = time.monotonic() + seconds
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.02)
    return bool(condition())


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize("executor", EXECUTORS)
def test_busy_workers_end_with_their_driver(executor: str, tmp_path: Path) -> None:
    pytest.importorskip({"dask": "distributed"}.get(executor, executor if executor == "ray" else "siggen"))
    assert_workers_end_with_their_driver(DRIVER, executor, tmp_path)


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_workers_that_still_import_the_physics_end_with_their_driver(tmp_path: Path) -> None:
    assert_workers_end_with_their_driver(STARTING, "processes", tmp_path)


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_processes_of_a_library_that_still_import_end_with_their_driver(tmp_path: Path) -> None:
    assert_workers_end_with_their_driver(LIBRARY, "none", tmp_path)


def assert_workers_end_with_their_driver(code: str, executor: str, tmp_path: Path) -> None:
    script = tmp_path / "driver.py"
    script.write_text(code)
    (tmp_path / "busy").mkdir()
    environment = {**os.environ, "SIGGEN_TEST_BUSY": str(tmp_path / "busy"), "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, script, executor]
    driver = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL, start_new_session=True)
    workers: list[int] = []
    try:
        assert wait_until(lambda: len(list((tmp_path / "busy").iterdir())) == 2, 90)
        workers = [int(file.name) for file in (tmp_path / "busy").iterdir()]
        assert all(is_alive(pid) for pid in workers)
        driver.kill()
        assert wait_until(lambda: not any(is_alive(pid) for pid in workers), 60)
    finally:
        with suppress(ProcessLookupError):
            os.killpg(driver.pid, signal.SIGKILL)  # with two processes of Ray's own, which outlive what they served
        driver.wait()
