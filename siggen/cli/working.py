"""What a command is doing while it takes its time: a line with a clock on stderr, on a terminal alone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

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
