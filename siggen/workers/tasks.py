"""Independent tasks on an executor: results as they complete; a pool that broke is replaced, which goes on."""

from __future__ import annotations

import os
import traceback
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import chain
from multiprocessing.reduction import ForkingPickler
from queue import SimpleQueue
from typing import Any, TypeVar

from siggen.errors import EngineError
from siggen.workers.orphan import end_with

DONE, RAISED = "done", "raised"
BREAKS = 3
"""Pools that may break one after the other without the result of a task between them."""
OPEN_PER_WORKER = 2
"""Tasks that a worker has: one under way, and the next one."""
NAMED = 4

Task = TypeVar("Task")
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Workers:
    """Who runs tasks.

    Attributes
    ----------
    name
        As the log has it.
    count
        How many tasks run at a time.
    opened
        Gives a pool, which ends with its block at once, whatever runs; asked again after a pool broke.
    bound_to
        Process that workers of this machine end with; None where nobody knows where they run.
    """

    name: str
    count: int
    opened: Callable[[], AbstractContextManager[Executor]]
    bound_to: int | None = None


def _always() -> bool:
    return True


def results(
    workers: Workers,
    function: Callable[[Task], Result],
    tasks: Iterable[Task],
    say: Callable[[str], object] | None = None,
    room: Callable[[], bool] = _always,
    ahead: int = 0,
) -> Generator[tuple[int, Result], None, None]:
    """Yield (position of the task, its result) as tasks complete. Closing it stops the work.

    Parameters
    ----------
    workers : Workers
    function : callable
        Importable by name, and so is all that it carries; it goes to each worker once.
    tasks : iterable
        Each taken when it is begun, so there may be endlessly many. Their texts stand in messages.
    say : callable, optional
        Called with a sentence on a pool that broke, and on what was under way there.
    room : callable, optional
        Whether another task may begin beside those under way: whoever keeps results bounds how many.
    ahead : int
        Least number of tasks that workers are given at a time: they go on while nobody asks for results.

    Raises
    ------
    EngineError
        If a task raised, or pools kept breaking; names tasks.
    """
    call = _TaskCall(function, workers.bound_to)
    fresh, left, breaks = enumerate(tasks), dict[int, Task](), 0
    while True:
        under_way: list[Task] = []
        try:
            with workers.opened() as pool:
                begun = chain(list(left.items()), fresh)
                most = max(OPEN_PER_WORKER * workers.count if workers.count > 1 else 1, ahead)
                for position, result in _of_one_pool(pool, most, call, begun, left, under_way, room):
                    breaks = 0
                    yield position, result
            return
        except (BrokenExecutor, CancelledError) as error:
            breaks += 1
            if breaks == BREAKS:
                raise EngineError(_given_up(under_way, error)) from error
            if say is not None:
                say(f"a worker died ({_first_line(error)}); a new pool goes on. Under way: {_named(under_way)}")


def _of_one_pool(
    pool: Executor, most: int, call: _TaskCall, begun: Iterator[tuple[int, Any]], left: dict[int, Any],
    under_way: list[Any], room: Callable[[], bool],
) -> Iterator[tuple[int, Any]]:  # fmt: skip
    """Yield results until all are there; `left` holds what is begun, `under_way` gets it when a pool breaks."""
    done: SimpleQueue[Future[tuple[str, Any]]] = SimpleQueue()
    opened: dict[Future[tuple[str, Any]], int] = {}

    def submit() -> None:
        while len(opened) < most and (not opened or room()):
            position, task = next(begun, (-1, None))
            if position < 0:
                return
            left[position] = task
            future = pool.submit(call, task)
            opened[future] = position
            future.add_done_callback(done.put)

    try:
        submit()
        while opened:
            future = done.get()
            position = opened[future]
            task = left[position]
            kind, content = _answer(future, task)
            del opened[future]
            if kind == RAISED:
                raise EngineError(f"{task} raised {content.splitlines()[-1]}\n{content}")
            del left[position]
            yield position, content
            submit()
    except (BrokenExecutor, CancelledError):
        under_way += [left[position] for position in opened.values()]
        raise


def _answer(future: Future[tuple[str, Any]], task: object) -> tuple[str, Any]:
    try:
        return future.result()
    except (BrokenExecutor, CancelledError):
        raise
    except Exception as error:  # of the executor's own: tasks raise nothing
        raise EngineError(
            f"{task} was lost because the workers that ran it died ({_first_line(error)}); what is finished stays: try "
            "again with fewer workers"
        ) from error


def _given_up(under_way: Sequence[object], error: BaseException) -> str:
    return (
        f"workers died {BREAKS} times, and nothing was done between ({_first_line(error)}). Under way: "
        f"{_named(under_way)}. What is finished stays: try again with fewer workers, usually memory is short, or with "
        "workers=0, in this process, to see where it stops"
    )


def _named(tasks: Sequence[object]) -> str:
    some = ", ".join(str(task) for task in tasks[:NAMED])
    return f"{some} and {len(tasks) - NAMED} more" if len(tasks) > NAMED else some or "nothing"


def _first_line(error: BaseException) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]


class _TaskCall:
    """What runs in a worker: the function, which is pickled once, and unpickled once in each process, on a task."""

    def __init__(self, function: Callable[[Any], Any], bound_to: int | None) -> None:
        self._function, self._bound_to = function, bound_to

    @cached_property
    def _pickled(self) -> bytes:
        return bytes(ForkingPickler.dumps(self._function))

    def __reduce__(self) -> tuple[Callable[[bytes, int | None], _TaskCall], tuple[bytes, int | None]]:
        return _unpickled, (self._pickled, self._bound_to)

    def __call__(self, task: Any) -> tuple[str, Any]:
        """Return the result, or that it raised and with which text: not every exception survives the way back."""
        if self._bound_to not in (None, os.getpid()):
            _bind(self._bound_to)
        try:
            return DONE, self._function(task)
        except MemoryError:
            return RAISED, "MemoryError: ran out of memory; what is finished stays: try again with fewer workers"
        except Exception as error:
            return RAISED, "".join(traceback.format_exception(error)).rstrip()


@lru_cache(maxsize=1)
def _unpickled(pickled: bytes, bound_to: int | None) -> _TaskCall:
    return _TaskCall(ForkingPickler.loads(pickled), bound_to)


@lru_cache(maxsize=1)
def _bind(process: int) -> None:
    """End this worker with the process that owns it."""
    end_with(process)
