"""What workers have begun and not given back: the work that is lost where a run stops at once."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

from siggen.engines.protocol import Unfinished
from siggen.sets.shard_work import Answer, Task

STOP_AT_ONCE_S = 45.0
"""Less than the minute that a worker may lose, by what stopping takes."""


@dataclass(slots=True)
class UnderWay:
    """What the workers of a run are busy with, judged by what they take and give back.

    Parameters
    ----------
    workers : int
    clock : callable
        Gives seconds.
    """

    workers: int
    clock: Callable[[], float] = time.monotonic
    _begun_s: float = 0.0
    _open: int = 0
    _heard_s: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._begun_s = self.clock()

    def taken(self, tasks: Iterable[Task | None]) -> Iterator[Task | None]:
        """Yield tasks, which are open as soon as they are taken."""
        for task in tasks:
            self._open += task is not None
            yield task

    def hear(self, heard: Answer | Unfinished[Task, Answer]) -> Answer:
        """Note an answer and return what it holds."""
        if isinstance(heard, Unfinished):
            answer: Answer = heard.result
        else:
            answer = heard
            self._open -= 1
        self._heard_s[answer.worker] = self.clock()
        return answer

    def lost_s(self) -> list[float]:
        """Return for every worker that is busy how long it has given nothing back, the longest last [s]."""
        now_s, heard_s = self.clock(), list(self._heard_s.values())
        never = [self._begun_s] * (self.workers - len(heard_s))
        silent_s = sorted(now_s - since_s for since_s in [*heard_s, *never])
        # who has nothing to do is silent for longest
        return silent_s[: min(self.workers, self._open)]
