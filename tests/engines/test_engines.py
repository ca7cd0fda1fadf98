"""Every engine: all results, whatever the order; a raising task is named; no run-away ahead of a slow task."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing

import pytest

from siggen.engines.processes import ProcessEngine
from siggen.engines.protocol import Engine
from siggen.engines.registry import engine_of, running
from siggen.engines.serial import SerialEngine
from siggen.engines.window import WINDOW_PER_WORKER
from siggen.errors import EngineError, UsageError
from tests.engines.tasks import fail_at_three, slow_at_first, square

ENGINES = [SerialEngine(), ProcessEngine(1), ProcessEngine(2)]
NAMES = ["serial", "one process", "two processes"]


@pytest.mark.parametrize("engine", ENGINES, ids=NAMES)
def test_every_task_gives_one_result_at_its_position(engine: Engine) -> None:
    assert dict(engine.map(square, range(20))) == {i: i * i for i in range(20)}


@pytest.mark.parametrize("engine", ENGINES, ids=NAMES)
def test_no_tasks_give_no_results(engine: Engine) -> None:
    assert list(engine.map(square, [])) == []


@pytest.mark.parametrize("engine", ENGINES, ids=NAMES)
def test_a_raising_task_is_named_with_its_traceback(engine: Engine) -> None:
    with pytest.raises(EngineError, match=r"(?s)^3 raised ValueError: three is not allowed.*in fail_at_three"):
        dict(engine.map(fail_at_three, range(6)))


@pytest.mark.parametrize("engine", ENGINES, ids=NAMES)
def test_nothing_runs_further_than_a_window_ahead_of_a_slow_task(engine: Engine) -> None:
    """Task 0 takes 0.5 s and the others none: without the window all 59 of them would wait for it in memory."""
    taken: list[int] = []

    def tasks() -> Iterator[int]:
        for task in range(60):
            taken.append(task)
            yield task

    waiting: set[int] = set()
    with closing(engine.map(slow_at_first, tasks())) as results:
        for index, _ in results:
            if 0 not in waiting and index != 0:
                assert index < WINDOW_PER_WORKER * engine.workers
            waiting.add(index)
            # the rest of what the engine may have taken since the oldest task was finished: one more window
            assert len(taken) <= len(waiting) + 2 * WINDOW_PER_WORKER * engine.workers
    assert waiting == set(range(60))


def test_closing_the_results_stops_the_work() -> None:
    results = ProcessEngine(2).map(slow_at_first, range(10_000))
    next(results)
    results.close()
    assert list(results) == []


def test_engines_are_found_by_name_and_objects_are_taken_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    assert isinstance(engine_of(None, 0), SerialEngine)
    assert isinstance(engine_of("serial", None), SerialEngine)
    assert engine_of(None, 3).workers == 3
    monkeypatch.setattr("siggen.engines.registry.default_workers", lambda: 5)
    assert engine_of("processes", None).workers == 5
    mine = ProcessEngine(2)
    assert engine_of(mine, None) is mine
    assert engine_of(mine, 2) is mine


def test_an_unknown_engine_and_two_numbers_of_workers_are_refused() -> None:
    with pytest.raises(
        UsageError, match="received the engine 'spark'; allowed: serial, processes, dask, ray, or an Engine object"
    ):
        engine_of("spark", 2)
    with pytest.raises(UsageError, match="received the address a:1 and the engine processes; allowed: an address with"):
        engine_of(None, 2, "a:1")
    with pytest.raises(UsageError, match="received workers 3 and an engine of 2 workers"):
        engine_of(ProcessEngine(2), 3)


class _Without:
    workers = 1


class _Listing(_Without):
    def map(self, function, tasks):
        return list(enumerate(map(function, tasks)))


class _Uncounted(_Listing):
    workers = "two"


@pytest.mark.parametrize("engine", [_Without(), _Uncounted(), object(), 3])
def test_an_object_that_is_no_engine_is_refused_with_what_one_has(engine: object) -> None:
    with pytest.raises(UsageError, match=r"received a \w+ with.* as an engine; allowed: an engine whose map"):
        engine_of(engine, None)  # type: ignore[arg-type]


def test_a_map_that_is_no_generator_is_refused_when_it_runs() -> None:
    with pytest.raises(UsageError, match=r"map of a _Listing gave a list; allowed: "), running(_Listing(), abs, [1]):
        pass
