"""Tasks on executors: all results, whatever the order; who raised or died is named; no worker outlives its driver."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import pytest

from siggen.child_environment import ONE_THREAD
from siggen.errors import EngineError, UsageError
from siggen.workers.choice import default_workers, workers_of
from siggen.workers.tasks import OPEN_PER_WORKER, Workers, results
from tests.workers import tasks
from tests.workers.test_orphans import is_alive, wait_until

WAYS = {"serial": ("serial", None), "one process": (None, 1), "two processes": (None, 2)}


@pytest.fixture(params=WAYS)
def workers(request: pytest.FixtureRequest) -> Workers:
    return workers_of(*WAYS[request.param])


def test_every_task_gives_one_result_at_its_position(workers: Workers) -> None:
    assert dict(results(workers, tasks.square, range(20))) == {i: i * i for i in range(20)}
    assert list(results(workers, tasks.square, [])) == []


def test_a_raising_task_is_named_with_its_traceback(workers: Workers) -> None:
    with pytest.raises(EngineError, match=r"(?s)^3 raised ValueError: three is not allowed.*in fail_at_three"):
        dict(results(workers, tasks.fail_at_three, range(6)))
    with pytest.raises(EngineError, match=r"^0 raised MemoryError: ran out of memory; what is finished stays"):
        dict(results(workers, tasks.no_memory, [0]))


def test_a_fork_server_that_dies_while_it_copies_itself_is_a_worker_that_died(monkeypatch: pytest.MonkeyPatch) -> None:
    real, said = ProcessPoolExecutor.submit, list[str]()

    def dies_first(pool: ProcessPoolExecutor, *given: object) -> object:
        if not said:
            raise EOFError("unexpected EOF")  # what multiprocessing says then
        return real(pool, *given)

    monkeypatch.setattr(ProcessPoolExecutor, "submit", dies_first)
    assert dict(results(workers_of(None, 1), tasks.square, range(3), said.append)) == {0: 0, 1: 1, 2: 4}
    assert [one.partition(";")[0] for one in said] == ["a worker died (a worker could not be started: unexpected EOF)"]


class Counting(ThreadPoolExecutor):
    """Knows how many tasks were open at a time."""

    open = most = 0

    def submit(self, function, /, *arguments, **named):
        self.open += 1
        self.most = max(self.most, self.open)
        future = super().submit(function, *arguments, **named)
        future.add_done_callback(lambda _: setattr(self, "open", self.open - 1))
        return future


def test_an_executor_of_ones_own_has_few_tasks_open_and_is_left_to_its_owner() -> None:
    with Counting(2) as mine:
        workers = workers_of(mine, None)
        assert (workers.name, workers.count) == ("Counting", 2)
        assert dict(results(workers, tasks.slow_at_first, range(60))) == dict(enumerate(range(60)))
        assert 2 <= mine.most <= OPEN_PER_WORKER * 2
        assert mine.submit(abs, -2).result() == 2
        assert workers_of(mine, 7).count == 7


def test_closing_the_results_stops_the_work_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SIGGEN_TEST_BUSY", str(tmp_path))
    with closing(results(workers_of(None, 2), tasks.busy_but_first, range(8))) as found:
        assert next(found) == (0, 0)
        assert wait_until(lambda: any(tmp_path.iterdir()), 60)
    assert wait_until(lambda: not any(is_alive(int(file.name)) for file in tmp_path.iterdir()), 10)


def test_workers_have_one_numeric_thread_the_drivers_environment_and_ignore_its_signals(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for value in ("1", "2"):  # the fork server keeps the environment of its start
        monkeypatch.setenv("OMP_NUM_THREADS", "5")
        monkeypatch.setenv("SIGGEN_TEST_THREADS", value)
        monkeypatch.delenv("ARROW_NUM_THREADS", raising=False)
        answers = [answer for _, answer in results(workers_of(None, 2), tasks.environment, range(8))]
        for pid, variables, arrow_threads, ignores in answers:
            assert pid != os.getpid()
            assert {name: variables[name] for name in ONE_THREAD} == ONE_THREAD
            assert variables["SIGGEN_TEST_THREADS"] == value
            assert arrow_threads == 1
            assert ignores
        assert os.environ["OMP_NUM_THREADS"] == "5"
        assert "ARROW_NUM_THREADS" not in os.environ


def test_a_pool_whose_worker_was_killed_is_replaced_and_what_was_under_way_is_told(tmp_path: Path) -> None:
    markers, said = [str(tmp_path / name) for name in ("a", "b", "c")], []
    assert dict(results(workers_of(None, 2), tasks.die_once, markers, said.append)) == dict(enumerate(markers))
    assert said
    assert all("a new pool goes on. Under way: " in sentence and str(tmp_path) in sentence for sentence in said)


def test_a_task_that_kills_every_worker_is_among_those_that_are_named() -> None:
    said = r"workers died 3 times, and nothing was done between .* Under way: 3\b.*workers=0"
    with pytest.raises(EngineError, match=said):
        dict(results(workers_of(None, 2), tasks.die_at_three, range(6)))


def test_workers_that_die_at_their_start_end_with_how_to_go_on() -> None:
    with pytest.raises(EngineError, match=r"workers died 3 times.*with workers=0, in this process"):
        dict(results(workers_of(None, 1), tasks.DiesOnArrival(), range(3)))


def test_what_is_no_executor_is_refused_with_what_there_is(monkeypatch: pytest.MonkeyPatch) -> None:
    for wrong, said in (("spark", "'spark'"), (3, "a int"), (object(), "a object")):
        with pytest.raises(UsageError, match=rf"received {said} as an executor; allowed: serial, processes, dask, ray"):
            workers_of(wrong, 2)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="received the address a:1 and the executor processes; allowed: with dask"):
        workers_of(None, 2, "a:1")
    with pytest.raises(UsageError, match="workers: received 0; allowed"):
        workers_of("processes", 0)
    monkeypatch.setattr("siggen.workers.choice.default_workers", lambda: 5)
    assert workers_of("processes", None).count == 5
    assert (workers_of(None, 0).name, workers_of(None, 3).count) == ("serial", 3)
    assert 1 <= default_workers() <= (os.cpu_count() or 1)


class Broken(Executor):
    """A pool whose workers are gone."""

    _broken = True


def test_an_executor_that_was_given_and_broke_is_not_replaced() -> None:
    with pytest.raises(EngineError, match="the executor Broken that was given has broken; give a new one"):
        list(results(workers_of(Broken(), 1), tasks.square, range(3)))


PARENT = """
import sys
from siggen.workers.choice import workers_of
from siggen.workers.tasks import results
from tests.workers import tasks
if __name__ == "__main__":
    for _, (pid, *_) in results(workers_of(None, 2), tasks.environment, range(10**6)):
        print(pid, flush=True)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_workers_end_when_their_parent_is_killed() -> None:
    parent = subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    pids = {int(parent.stdout.readline()) for _ in range(200)}
    parent.kill()
    parent.communicate()
    deadline = time.monotonic() + 60
    while any(is_alive(pid) for pid in pids) and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not [pid for pid in pids if is_alive(pid)]
