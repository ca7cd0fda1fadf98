"""Functions for workers: module-level, so that a spawned process can import them."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path


def square(task: int) -> int:
    return task * task


def slow_at_first(task: int) -> int:
    time.sleep(0.5 if task == 0 else 0.0)
    return task


def fail_at_three(task: int) -> int:
    if task == 3:
        raise ValueError("three is not allowed")
    return task


def die_once(task: str) -> str:
    """Kill the own process unless the marker file says that this happened before."""
    marker = Path(task)
    if not marker.exists():
        marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return task


def no_memory(task: int) -> int:
    raise MemoryError


def die_at_three(task: int) -> int:
    if task == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return task


def environment(task: int) -> tuple[int, dict[str, str], int, bool]:
    import pyarrow as pa

    ignores = all(signal.getsignal(number) == signal.SIG_IGN for number in (signal.SIGINT, signal.SIGTERM))
    variables = {name: value for name, value in os.environ.items() if name.endswith("_THREADS")}
    return os.getpid(), variables, pa.cpu_count(), ignores


class DiesOnArrival:
    """A function that no worker survives unpickling."""

    def __call__(self, task: int) -> int:
        return task

    def __reduce__(self) -> tuple:
        return os._exit, (7,)


def busy(task: int) -> int:
    """Say that it works, then hold the interpreter for minutes in one call, as compiled code does for seconds."""
    import re

    if folder := os.environ.get("SIGGEN_TEST_BUSY"):
        (Path(folder) / str(os.getpid())).touch()
        re.match(r"(a?){32}a{32}", "a" * 32)
    return task


def busy_but_first(task: int) -> int:
    return busy(task) if task else task
