"""What every engine offers: independent tasks in, results as they complete, and the error of a task that raised."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Generator, Iterable
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar, runtime_checkable

from siggen.errors import EngineError


def failure_text(error: BaseException) -> str:
    """Return an exception with its traceback as text, since not every exception survives the way between processes."""
    return "".join(traceback.format_exception(error)).rstrip()


def task_error(task: object, text: str) -> EngineError:
    """Return the error that names the task, with the exception's last line first and its traceback below."""
    return EngineError(f"{task} raised {text.splitlines()[-1]}\n{text}")


Task = TypeVar("Task")
Result = TypeVar("Result")

Results = Generator[tuple[int, Result], None, None]
"""Positions of tasks with their results; closing it stops the work."""


@dataclass(frozen=True, slots=True)
class Unfinished(Generic[Task, Result]):
    """The answer of a function that did a part of its task: what came of it, and the task that is left."""

    result: Result
    rest: Task


class Engine(Protocol):
    """Runs independent tasks; results do not depend on the engine nor on the number of workers."""

    workers: int

    def map(self, function: Callable[[Task], Result], tasks: Iterable[Task]) -> Results[Result]:
        """Yield (position of the task, result) as tasks complete.

        Tasks are taken from the iterable as they are needed, and never further than a fixed window ahead of the
        oldest unfinished one: whoever puts results back in order holds a bounded number of them.
        None instead of a task says that nothing can begin before another result was yielded: ask again then. An engine
        that hands it out all the same loses a moment, and yields what the function gives for it.
        Closing the iterator stops the work.

        Raises
        ------
        EngineError
            If a task raised, or if its worker died more often than the engine tolerates; the message names the task.
        """


@runtime_checkable
class DrainingEngine(Engine, Protocol):
    """An engine that loses little when it is stopped.

    An `Unfinished` answer is yielded like any other; then its rest runs as a task of the same position, on the same
    worker where the engine can choose.
    """

    def drain(self) -> None:
        """Begin nothing more in the `map` that runs: its results end once those under way are there.

        Called by a signal handler in the thread that takes the results.
        """
