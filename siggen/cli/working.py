"""What a command is doing while it takes its time: a clock or a bar on a terminal, elsewhere a line now and then."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, Thread

from siggen.cli.echo import echo

FIRST_TIME = "the first time after an install it also compiles, for up to a minute"
LINE_EVERY_S, SELDOM = 10.0, 30.0
"""Where stderr is no terminal: seconds between lines at first; later a thirtieth of the time that has passed."""


@contextmanager
def ticking(line: Callable[[float], str]) -> Iterator[None]:
    """Write a line on stderr now and then until the block ends, as the log of a job needs it.

    Parameters
    ----------
    line : callable
        Returns it, of the seconds that have passed; called in a thread of its own.
    """
    over, begun_s = Event(), time.monotonic()

    def tell() -> None:
        while not over.wait(max(LINE_EVERY_S, (time.monotonic() - begun_s) / SELDOM)):
            echo(line(time.monotonic() - begun_s), err=True)

    thread = Thread(target=tell, daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


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
    title = f"{what} ({FIRST_TIME})" if compiles else what
    if not console.is_terminal:
        with ticking(lambda passed_s: f"{title}: {passed_s:.0f} s"):
            yield
        return
    text = TextColumn("{task.description}", table_column=Column(no_wrap=False))  # whole on a narrow terminal too
    with Progress(SpinnerColumn(), text, TimeElapsedColumn(), console=console, transient=True) as line:
        line.add_task(title, total=None)
        yield


@contextmanager
def stepwise(what: str, steps: int | None = None) -> Iterator[Callable[[int, int], None]]:
    """Give what shows (done, total): a bar on a terminal, elsewhere a line now and then.

    Parameters
    ----------
    what : str
        Such as `trying short records`.
    steps : int, optional
        In all, where that is known; a bar that ends early is filled and stays.
    """
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    if not console.is_terminal:
        far = (0, steps or 0)

        def note(done: int, total: int) -> None:
            nonlocal far
            far = done, total

        with ticking(
            lambda passed_s: f"{what}: " + (f"{far[0]} of {far[1]}, " if far[1] else "") + f"{passed_s:.0f} s"
        ):
            yield note
        return
    columns = (TextColumn("{task.description:<28}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=steps is None) as bar:
        task = bar.add_task(what, total=steps)
        yield lambda done, total: bar.update(task, completed=done, total=total)
        if steps is not None:
            bar.update(task, completed=steps)
