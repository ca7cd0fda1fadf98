"""One worker process: started with one numeric thread, deaf to Ctrl-C, fed through a pipe."""

from __future__ import annotations

import contextlib
import os
import signal
from collections.abc import Callable, Iterator
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.reduction import ForkingPickler
from typing import Any

from siggen.child_environment import OF_WORKERS, child_environment
from siggen.engines.orphan import end_with

READY, DONE, RAISED = "ready", "done", "raised"

PARENTS_SIGNALS = {signal.SIGINT, signal.SIGTERM}
"""A terminal sends Ctrl-C to the whole process group; only the parent decides what it means."""

GOODBYE_S = 5.0

OUT_OF_MEMORY = 71
"""Exit code of a worker that was refused memory."""


class Worker:
    """The parent's side of a worker process.

    Attributes
    ----------
    connection
        Pipe to the process; reading from it ends with EOFError when the process dies.
    task
        Position of the task the worker is busy with, or None.
    ready
        Whether the process has started: unpickling its function has imported, once, what the tasks need.
    """

    def __init__(self, function: Callable[[Any], Any]) -> None:
        context = get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.task: int | None = None
        self.ready = False
        # as bytes: reading it imports the physics, and before that the process has to end with its parent
        pickled = bytes(ForkingPickler.dumps(function))
        self._process = context.Process(target=_work, args=(theirs, pickled, os.getpid()), daemon=True)
        with child_environment(OF_WORKERS), _blocked(PARENTS_SIGNALS):
            self._process.start()
        # the process must hold the only other end, or its death would not close the pipe
        theirs.close()

    @property
    def pid(self) -> int | None:
        """Process id."""
        return self._process.pid

    def stop(self) -> None:
        """Let an idle process end by itself."""
        self.connection.close()
        self._process.join(GOODBYE_S)
        self.kill()

    def kill(self) -> int | None:
        """End the process at once and return its exit code; negative codes are signals."""
        self.connection.close()
        self._process.kill()
        self._process.join()
        return self._process.exitcode


def _work(connection: Connection, pickled: bytes, parent: int) -> None:
    """Run tasks until the parent closes the pipe or dies."""
    end_with(parent)
    try:
        function = ForkingPickler.loads(pickled)
    except MemoryError:
        os._exit(OUT_OF_MEMORY)
    _settle_down()
    with contextlib.suppress(EOFError, OSError):
        connection.send((READY, None))
        while True:
            connection.send(answer(function, connection.recv()))


def answer(function: Callable[[Any], Any], task: Any) -> tuple[str, Any]:
    """Return the result of a task, or that it raised and with which text: not every exception survives the way back.

    A process that is refused memory ends, so that its task runs again in another one.
    """
    from siggen.engines.protocol import failure_text

    try:
        return DONE, function(task)
    except MemoryError:  # a new process has what this one has lost; whoever counts deaths says it in words
        os._exit(OUT_OF_MEMORY)
    except Exception as error:
        return RAISED, failure_text(error)


def _settle_down() -> None:
    for number in PARENTS_SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    import pyarrow as pa

    pa.set_cpu_count(1)
    pa.set_io_thread_count(1)


@contextlib.contextmanager
def _blocked(numbers: set[signal.Signals]) -> Iterator[None]:
    """Block signals inside the block: a process started there inherits it, and cannot be hit before it ignores them."""
    if not hasattr(signal, "pthread_sigmask"):  # not a POSIX system
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, numbers)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
