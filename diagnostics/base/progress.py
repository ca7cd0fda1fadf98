"""Progress of long work on stderr: bars where that is a terminal, a line now and then elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

Advance = Callable[[], None]
Stage = Callable[[str, int], AbstractContextManager[Advance]]
LINE_EVERY_S = 30.0
"""As in the log of `siggen generate`."""


@contextmanager
def silent_stage(title: str, steps: int) -> Iterator[Advance]:  # noqa: ARG001 - the same call as a stage that speaks
    """Say nothing."""
    yield lambda: None


@contextmanager
def terminal_stage(title: str, steps: int) -> Iterator[Advance]:
    """Show a bar for one stage; a stage that ends early (a network that stops) fills it."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    if not console.is_terminal:
        yield _lines(title, steps)
        return
    columns = (TextColumn("{task.description:<28}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console) as bar:
        task = bar.add_task(title, total=steps)
        yield lambda: bar.advance(task)
        bar.update(task, completed=steps)


def _lines(title: str, steps: int) -> Advance:
    """Return what writes a line now and then, for the log of a job."""
    done, last_s = 0, time.monotonic()

    def advance() -> None:
        nonlocal done, last_s
        done += 1
        if time.monotonic() >= last_s + LINE_EVERY_S:
            last_s = time.monotonic()
            sys.stderr.write(f"{title}: {done} of {steps}\n")

    return advance
