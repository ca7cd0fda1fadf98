"""What every engine offers: independent tasks in, results as they complete."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar, runtime_checkable

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
