"""The open file of a log of JSON lines: nothing else is ever added to."""

from __future__ import annotations

import json
from io import FileIO
from pathlib import Path

from siggen.errors import UsageError

LONGEST_LINE = 1 << 20
"""Bytes of the first line that are read: what is longer is no event."""


def opened_log(path: Path, out: Path | None = None) -> FileIO:
    """Open without a buffer: every line is in the file at once, and nothing is left to fail when it is closed.

    Raises
    ------
    UsageError
        Before anything is opened for writing, if the file lies in the set's folder `out`, is no regular file, or holds
        something else than events. Also if it cannot be read or written.
    """
    try:
        if reason := _why_not(path, out):
            raise UsageError(f"--log-json: {path} {reason}; allowed: a new file, a log to add to, or - for stderr")
        return path.open("ab", buffering=0)
    except OSError as error:
        raise UsageError(f"--log-json: {path} cannot be written ({error.strerror}); allowed: a file, or -") from error


def _why_not(path: Path, out: Path | None) -> str:
    if out is not None and path.resolve().is_relative_to(out.resolve()):
        return f"lies in {out}, which holds the set alone"
    if not path.exists():
        return ""
    if not path.is_file():
        return "is no regular file"
    return "" if path.stat().st_size == 0 or _begins_with_event(path) else "does not begin with an event of a run"


def _begins_with_event(path: Path) -> bool:
    from siggen.sets.run_journal import EVENTS

    with path.open("rb") as file:
        first = file.readline(LONGEST_LINE)
    try:
        event = json.loads(first)
    except ValueError:
        return False
    return isinstance(event, dict) and "time" in event and event.get("event") in list(EVENTS)
