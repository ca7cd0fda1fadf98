"""Results of tasks that a cluster runs: handed in as room opens in the window, given as they finish."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from itertools import islice, takewhile
from typing import Any

from siggen.engines.protocol import Result, Results, Task, Unfinished

WINDOW_PER_WORKER = 4
"""Tasks that may be ahead of the oldest unfinished one, per worker: enough for uneven tasks, and bounded memory."""


def windowed(
    tasks: Iterable[Task],
    workers: int,
    submit: Callable[[Task], Any],
    finished: Callable[[Collection[Any]], Iterable[Any]],
    value: Callable[[Any, Task], Result],
    drained: Callable[[], bool] = lambda: False,
) -> Results[Result]:
    """Yield (position, result) as tasks complete; see `Engine.map`.

    Parameters
    ----------
    tasks : iterable
        Taken one by one.
    workers : int
        The window is `WINDOW_PER_WORKER` times as wide.
    submit : callable
        Task -> what the cluster calls it, which can be a key of a mapping.
    finished : callable
        Open ones -> those of them that are finished, at least one; waits for it.
    value : callable
        (finished one, its task) -> its result, or what went wrong is raised.
    drained : callable
        Whether nothing more shall be begun; see `DrainingEngine`.
    """
    source = iter(tasks)
    opened: dict[Any, tuple[int, Task]] = {}
    unfinished: dict[int, None] = {}  # by position, the oldest first: thousands of workers have a wide window
    taken = 0
    while True:
        oldest = next(iter(unfinished), taken)
        room = 0 if drained() else max(0, oldest + WINDOW_PER_WORKER * workers - taken)
        for task in takewhile(_is_task, islice(source, room)):
            opened[submit(task)] = (taken, task)
            unfinished[taken] = None
            taken += 1
        if not opened:
            return
        for one in finished(opened.keys()):
            index, task = opened.pop(one)
            result = value(one, task)
            if isinstance(result, Unfinished):
                if not drained():
                    opened[submit(result.rest)] = (index, result.rest)
            else:
                del unfinished[index]
            yield index, result


def _is_task(task: object) -> bool:
    return task is not None
