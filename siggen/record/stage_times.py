"""Time spent by stage: named spans of which the inner one alone counts, so that all of them add up to the whole."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar


class StageTimes:
    """Seconds by stage, in the order in which stages began.

    Parameters
    ----------
    clock : callable, optional
        Returns seconds; by default wall time.
    """

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self.seconds: dict[str, float] = {}
        self._clock = clock
        self._open: list[str] = []
        self._since_s = 0.0

    @contextmanager
    def during(self, stage: str) -> Iterator[None]:
        """Charge a stage with the time of the block, less that of stages inside it."""
        self._charge()
        self.seconds.setdefault(stage, 0.0)
        self._open.append(stage)
        try:
            yield
        finally:
            self._charge()
            self._open.pop()

    def so_far(self) -> dict[str, float]:
        """Return seconds by stage, with what open stages have spent until now."""
        self._charge()
        return dict(self.seconds)

    def _charge(self) -> None:
        now_s = self._clock()
        if self._open:
            self.seconds[self._open[-1]] += now_s - self._since_s
        self._since_s = now_s


_COLLECTING: ContextVar[StageTimes | None] = ContextVar("_COLLECTING", default=None)


def stage(name: str) -> AbstractContextManager[None]:
    """Charge a stage of whoever collects times, such as a worker; where nobody does, nothing happens."""
    times = _COLLECTING.get()
    return nullcontext() if times is None else times.during(name)


@contextmanager
def collected(rest: str) -> Iterator[StageTimes]:
    """Collect CPU time of this thread by stage inside the block; `rest` is what no stage of its own covers."""
    times = StageTimes(time.thread_time)
    token = _COLLECTING.set(times)
    try:
        with times.during(rest):
            yield times
    finally:
        _COLLECTING.reset(token)
