"""Worker processes: one thread each, deaf to Ctrl-C, replaced when killed, and gone when the parent is."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from siggen.child_environment import ONE_THREAD
from siggen.engines.processes import ProcessEngine, default_workers
from siggen.engines.serial import SerialEngine
from siggen.errors import EngineError, UsageError
from tests.engines import tasks
from tests.engines.tasks import DiesOnArrival


def is_alive(pid: int) -> bool:
    """A zombie is dead: its stat says Z."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def test_workers_have_one_numeric_thread_and_ignore_the_signals_meant_for_the_parent(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "5")
    monkeypatch.delenv("ARROW_NUM_THREADS", raising=False)
    answers = [answer for _, answer in ProcessEngine(2).map(tasks.environment, range(8))]
    for pid, variables, arrow_threads, ignores in answers:
        assert pid != os.getpid()
        assert {name: variables[name] for name in ONE_THREAD} == ONE_THREAD
        assert arrow_threads == 1
        assert ignores
    assert len({pid for pid, *_ in answers}) <= 2
    assert os.environ["OMP_NUM_THREADS"] == "5"
    assert "ARROW_NUM_THREADS" not in os.environ


def test_a_killed_worker_is_replaced_and_its_task_done_again(tmp_path: Path) -> None:
    markers = [str(tmp_path / name) for name in ("a", "b", "c")]
    assert dict(ProcessEngine(2).map(tasks.die_once, markers)) == dict(enumerate(markers))


def test_a_worker_without_memory_is_replaced_and_its_task_done_again(tmp_path: Path) -> None:
    markers = [str(tmp_path / name) for name in ("a", "b")]
    assert dict(ProcessEngine(2).map(tasks.no_memory_once, markers)) == dict(enumerate(markers))


def test_a_task_that_never_has_enough_memory_is_named_with_what_to_do() -> None:
    with pytest.raises(
        EngineError, match=r"^0 was lost 3 times because its worker died \(out of memory\).*fewer workers"
    ):
        dict(ProcessEngine(1).map(tasks.no_memory, [0]))
    with pytest.raises(EngineError, match=r"^0 ran out of memory; what is committed stays"):
        dict(SerialEngine().map(tasks.no_memory, [0]))


def test_a_task_that_kills_every_worker_ends_with_an_error_that_names_it() -> None:
    with pytest.raises(
        EngineError, match=r"3 was lost 3 times because its worker died \(signal 9, usually out of memory"
    ):
        dict(ProcessEngine(2).map(tasks.die_at_three, range(6)))


@pytest.mark.filterwarnings("ignore")  # the dying process leaves its semaphore tracker to complain
def test_workers_that_cannot_start_end_with_a_hint_at_the_main_guard() -> None:
    with pytest.raises(EngineError, match=r'3 workers died while starting \(exit code 7\).*__name__ == "__main__"'):
        dict(ProcessEngine(1).map(DiesOnArrival(), range(3)))


def test_fewer_than_one_worker_is_refused() -> None:
    with pytest.raises(UsageError, match="received 0 workers"):
        ProcessEngine(0)
    assert 1 <= default_workers() <= (os.cpu_count() or 1)


PARENT = """
import sys, time
from siggen.engines.processes import ProcessEngine
from tests.engines import tasks
if __name__ == "__main__":
    for _, (pid, *_) in ProcessEngine(2).map(tasks.environment, iter(range(10**9))):
        print(pid, flush=True)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_workers_end_when_their_parent_is_killed() -> None:
    parent = subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    pids = {int(parent.stdout.readline()) for _ in range(200)}
    parent.send_signal(signal.SIGKILL)
    parent.communicate()
    # they notice at their next answer, milliseconds away; a minute for a machine under load
    deadline = time.monotonic() + 60
    while any(is_alive(pid) for pid in pids) and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not [pid for pid in pids if is_alive(pid)]
