"""The end of a worker whose parent has died, however busy it is."""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import current_process
from multiprocessing.context import get_spawning_popen
from typing import NamedTuple

SET_PARENT_DEATH_SIGNAL = 1
"""PR_SET_PDEATHSIG of <sys/prctl.h>."""

LOOK_S = 0.5


def end_with(parent: int) -> None:
    """End this process as soon as its parent has died.

    On Linux the kernel sees to it, also while compiled code runs that lets no other thread of Python in. Elsewhere a
    thread looks twice a second. Call it in a child, before or while it works.

    Parameters
    ----------
    parent : int
        Process id of the parent; if it is gone already, the process ends at once.
    """
    if not (sys.platform == "linux" and _asked_kernel()):
        threading.Thread(target=_look, args=(parent,), daemon=True).start()
    if os.getppid() != parent:  # it died before the kernel was asked
        os._exit(1)


@contextmanager
def ending_with_this() -> Iterator[None]:
    """Bind processes that `multiprocessing` spawns inside the block to this one, before they import anything.

    For libraries that start processes of their own and import much in them. A child of `multiprocessing` reads the
    configuration of its parent before the function that it runs, and so before what that function imports.
    """
    facts: dict[str, object] = current_process()._config  # type: ignore[attr-defined]
    facts[_Parent.__name__] = _Parent(os.getpid())
    try:
        yield
    finally:
        facts.pop(_Parent.__name__, None)


class _Parent(NamedTuple):
    """Read by another process, it is nothing but the start of a look at this one."""

    pid: int

    def __reduce__(self) -> tuple[Callable[[int | None], None], tuple[int | None]]:
        # with the other methods of starting, this process need not be the parent
        spawns = getattr(get_spawning_popen(), "method", None) == "spawn"
        return _watch, (self.pid if spawns else None,)


def _watch(parent: int | None) -> None:
    """Look whether the parent lives, from a thread.

    Not by the kernel, which takes the end of the parent's thread for that of the parent: whoever spawned this process
    may have done so from a thread that ends.
    """
    if parent is not None:
        threading.Thread(target=_look, args=(parent,), daemon=True).start()


def _asked_kernel() -> bool:
    try:
        return int(ctypes.CDLL(None).prctl(SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)) == 0
    except (OSError, AttributeError):
        return False


def _look(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(LOOK_S)
    os._exit(1)


if __name__ == "__main__":  # python with the arguments, bound to who started it: Ray names its process
    end_with(int(os.environ.get("RAY_RAYLET_PID", os.getppid())))
    os.execv(sys.executable, [sys.executable, *sys.argv[1:]])
