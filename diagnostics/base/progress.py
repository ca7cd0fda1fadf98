"""Progress of long work on stderr: bars where that is a terminal, a line now and then elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

from siggen.cli.working import stepwise

Advance = Callable[[], None]
Stage = Callable[[str, int], AbstractContextManager[Advance]]


@contextmanager
def silent_stage(title: str, steps: int) -> Iterator[Advance]:  # noqa: ARG001 - the same call as a stage that speaks
    """Say nothing."""
    yield lambda: None


@contextmanager
def terminal_stage(title: str, steps: int) -> Iterator[Advance]:
    """Show a bar for one stage; a stage that ends early (a network that stops) fills it."""
    done = 0
    with stepwise(title, steps) as show:

        def advance() -> None:
            nonlocal done
            done += 1
            show(done, steps)

        yield advance
