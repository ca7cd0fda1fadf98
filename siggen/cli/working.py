"""What a command is doing while it takes its time: a line with a clock on stderr."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from siggen.cli.echo import echo

FIRST_TIME = "the first time after an install it also compiles, for up to a minute"


@contextmanager
def working(what: str, *, compiles: bool = True) -> Iterator[None]:
    """Show what is done and for how long, until it is done.

    Parameters
    ----------
    what : str
        Such as `computing the mesh stiffness`.
    compiles : bool
        Whether it may compile first.
    """
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
    from rich.table import Column

    console = Console(stderr=True)
    text = TextColumn("{task.description}", table_column=Column(no_wrap=False))  # whole on a narrow terminal too
    columns = (SpinnerColumn(), text, TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as line:
        line.add_task(f"{what} ({FIRST_TIME})" if compiles else what, total=None)
        yield


QUIET_S = 2.0
"""After which something is said where stderr is no terminal."""
LINE_EVERY_S = 30.0


@contextmanager
def stepwise(what: str) -> Iterator[Callable[[int, int], None]]:
    """Give what shows (done, total): a bar on a terminal, elsewhere a line after two seconds and now and then.

    Parameters
    ----------
    what : str
        Such as `trying short records`.
    """
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    if not console.is_terminal:
        yield _lines(what)
        return
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(what, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def _lines(what: str) -> Callable[[int, int], None]:
    begun_s, due_s = time.monotonic(), QUIET_S

    def tell(done: int, total: int) -> None:
        nonlocal due_s
        passed_s = time.monotonic() - begun_s
        if passed_s >= due_s:
            due_s = passed_s + LINE_EVERY_S
            echo(f"{what}: {done} of {total}", err=True)

    return tell
