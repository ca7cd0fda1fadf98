"""Progress of long work: what it is told to, and bars on stderr where that is a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

Advance = Callable[[], None]
Stage = Callable[[str, int], AbstractContextManager[Advance]]


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
    columns = (TextColumn("{task.description:<28}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, disable=not console.is_terminal) as bar:
        task = bar.add_task(title, total=steps)
        yield lambda: bar.advance(task)
        bar.update(task, completed=steps)
