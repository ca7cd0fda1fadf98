"""The end of a worker whose parent has died, however busy it is."""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import threading
import time

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


def _asked_kernel() -> bool:
    try:
        return int(ctypes.CDLL(None).prctl(SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)) == 0
    except (OSError, AttributeError):
        return False


def _look(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(LOOK_S)
    os._exit(1)
