"""How long work says how far it is: a stage has a title and a number of steps, and is told of every step."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

Advance = Callable[[], None]
Stage = Callable[[str, int], AbstractContextManager[Advance]]


@contextmanager
def silent_stage(title: str, steps: int) -> Iterator[Advance]:  # noqa: ARG001 - the same call as a stage that speaks
    """Say nothing."""
    yield lambda: None
