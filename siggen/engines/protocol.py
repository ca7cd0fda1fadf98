"""What every engine offers: independent tasks in, results as they complete."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from typing import Protocol, TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")

Results = Generator[tuple[int, Result], None, None]
"""Positions of tasks with their results; closing it stops the work."""


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
