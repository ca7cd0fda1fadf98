"""The engine without processes: one task after the other, where it is called."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from siggen.engines.protocol import Result, Results, Task, Unfinished, failure_text, task_error
from siggen.errors import EngineError


class SerialEngine:
    """Runs every task in this process; for small sets, debuggers, and as the reference of the other engines."""

    workers = 1

    def __init__(self) -> None:
        self._draining = False

    def drain(self) -> None:
        """Begin no further task, nor the rest of one; see `DrainingEngine`."""
        self._draining = True

    def map(self, function: Callable[[Task], Result], tasks: Iterable[Task]) -> Results[Result]:
        """Yield (position, result) in the order of the tasks.

        Raises
        ------
        EngineError
            If a task raised, or ran out of memory.
        """
        self._draining = False
        for index, whole in enumerate(tasks):
            result = _answer(function, whole)
            yield index, result
            while isinstance(result, Unfinished) and not self._draining:
                result = _answer(function, result.rest)
                yield index, result
            if self._draining:
                return


def _answer(function: Callable[[Task], Result], task: Task) -> Result:
    try:
        return function(task)
    except MemoryError as error:
        raise EngineError(
            f"{task} ran out of memory; what is committed stays, and the same command continues"
        ) from error
    except Exception as error:
        raise task_error(task, failure_text(error)) from error
