"""Processes below one that a benchmark started, found in /proc (Linux): who works for it, and who is left."""

from __future__ import annotations

import os
import signal
import time
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple


class Process(NamedTuple):
    """A process, told from a later one of the same number by when it began."""

    pid: int
    began: int
    command: str

    @property
    def lives(self) -> bool:
        """Whether it runs; a zombie does not."""
        found = _stat(self.pid)
        return found is not None and found[2] == self.began and found[0] != "Z"

    def kill(self) -> None:
        """End it at once, if it is still the same."""
        if self.lives:
            with suppress(ProcessLookupError):
                os.kill(self.pid, signal.SIGKILL)


def below(pid: int) -> list[Process]:
    """Return all descendants of a process."""
    children: dict[int, list[tuple[int, int]]] = {}
    for folder in Path("/proc").iterdir():
        if folder.name.isdecimal() and (found := _stat(int(folder.name))) is not None:
            children.setdefault(found[1], []).append((int(folder.name), found[2]))
    result, waiting = [], [pid]
    while waiting:
        for child, began in children.get(waiting.pop(), ()):
            result.append(Process(child, began, _command(child)))
            waiting.append(child)
    return result


def seconds_until_gone(processes: list[Process], most_s: float) -> float:
    """Wait until none of them lives; return how long that took, infinity after `most_s`."""
    started_s = time.monotonic()
    while any(one.lives for one in processes):
        if time.monotonic() - started_s > most_s:
            return float("inf")
        time.sleep(0.01)
    return time.monotonic() - started_s


def _stat(pid: int) -> tuple[str, int, int] | None:
    """Return state, parent and start of a process, in ticks."""
    fields = _fields(pid)
    return (fields[0], int(fields[1]), int(fields[19])) if fields else None


def _fields(pid: int) -> list[str]:
    """Return what /proc/PID/stat holds behind the name (proc(5), from field 3 on); nothing if there is no such."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return []


def _command(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
    except OSError:
        return ""
