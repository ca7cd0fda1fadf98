"""A run while it goes on: progress with rate, failures and time left on stderr, and a log of JSON lines."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.opened_log import opened_log
from siggen.cli.working import ticking

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress

LogJson = Annotated[
    str | None,
    typer.Option("--log-json", help="Add one JSON object per event to a file; - for stderr.", metavar="FILE"),
]


class RunDisplay:
    """What a command shows of a run; `progress` and `events` are what `siggen.generate` takes.

    Parameters
    ----------
    draw : callable
        Called with (records done, records of the run, records that failed).
    log : callable, optional
        Writes a line of the log; an OSError of it is the log's end, not the run's.
    quiet : bool
        The log has stderr for itself: sentences become events.
    """

    def __init__(
        self, draw: Callable[[int, int, int], None], log: Callable[[str], object] | None = None, *, quiet: bool = False
    ):
        self.failures = 0
        self._draw, self._log, self._quiet = draw, log, quiet

    def progress(self, done: int, total: int) -> None:
        """Show how far the run is."""
        self._draw(done, total, self.failures)

    def events(self, event: Mapping[str, object]) -> None:
        """Note an event; a log that cannot be written any more is given up in words, the run goes on."""
        if event["event"] == "record_failed":
            self.failures += 1
        if event["event"] == "said" and not self._quiet:
            echo(event["sentence"], err=True)
        if self._log is None:
            return
        try:
            self._log(json.dumps(event) + "\n")
        except OSError as error:
            self._log = None
            echo(f"--log-json: no further events are written ({error}); the run goes on", err=True)

    def say(self, sentence: str) -> None:
        """Say something on stderr; in the log if it has stderr for itself."""
        if self._quiet:
            from siggen.sets.run_journal import stamped

            self.events(stamped("said", {"sentence": sentence}))
        else:
            echo(sentence, err=True)


@contextmanager
def run_shown(log_json: str | None = None, out: Path | None = None) -> Iterator[RunDisplay]:
    """Give what shows a run, until it is over.

    Parameters
    ----------
    log_json : str, optional
        File to which events are added, or '-' for stderr, which then has nothing else.
    out : Path, optional
        Folder of the set, which holds no log.

    Raises
    ------
    UsageError
        If the file cannot be written, is no log of ours, or lies in the set.
    """
    with ExitStack() as stack:
        if log_json == "-":
            yield RunDisplay(_silent, sys.stderr.write, quiet=True)
            return
        file = None if log_json is None else stack.enter_context(opened_log(Path(log_json), out))
        log = None if file is None else (lambda line: file.write(line.encode()))
        yield RunDisplay(stack.enter_context(_drawn()), log)


def _silent(done: int, total: int, failures: int) -> None:
    """Show nothing."""


@contextmanager
def _drawn() -> Iterator[Callable[[int, int, int], None]]:
    """Give what draws a bar on a terminal, and writes a line now and then elsewhere."""
    from rich.console import Console

    console = Console(stderr=True)
    if not console.is_terminal:
        lines = _Lines()
        with ticking(lines.line):
            yield lines.note
        return
    with _bar(console) as bar:
        task = bar.add_task("records", total=None, rate="", failed="")

        def draw(done: int, total: int, failures: int) -> None:
            speed = bar.tasks[0].speed
            rate = f"{speed:.3g}/s" if speed else ""
            bar.update(task, completed=done, total=total, rate=rate, failed=f"{failures} failed" if failures else "")

        yield draw


def _bar(console: Console) -> Progress:
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    return Progress(
        TextColumn("records"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TextColumn("[red]{task.fields[failed]}"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(compact=True),
        console=console,
        transient=True,
    )


class _Lines:
    """How far a run is, as a line with rate, failures and time left."""

    def __init__(self) -> None:
        self._first: int | None = None
        self._far = (0, 0, 0)

    def note(self, done: int, total: int, failures: int) -> None:
        self._first = done if self._first is None else self._first
        self._far = done, total, failures

    def line(self, passed_s: float) -> str:
        done, total, failures = self._far
        if self._first is None:
            return f"the first records are on the way, {passed_s:.0f} s"
        rate = (done - self._first) / passed_s
        left = f"{(total - done) / rate / 60:.1f} min left" if rate else "time left unknown"
        return f"{done} of {total} records in {passed_s:.0f} s, {rate:.3g}/s, {failures} failed, {left}"
