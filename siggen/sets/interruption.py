"""Ctrl-C and SIGTERM as one exception that reaches the main thread once."""

from __future__ import annotations

import signal
import sys
import threading
from types import FrameType, TracebackType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Interruption:
    """Inside the block, the first SIGINT or SIGTERM raises KeyboardInterrupt; later ones are ignored.

    Cleaning up is thereby never interrupted itself. Outside of the main thread signals cannot be caught, and are left
    to whoever catches them.

    Attributes
    ----------
    requested
        A signal has raised KeyboardInterrupt.
    """

    def __init__(self) -> None:
        self.requested = False
        self._before: dict[signal.Signals, object] = {}
        self._report = sys.unraisablehook

    def __enter__(self) -> Interruption:
        if threading.current_thread() is threading.main_thread():
            self._before = {number: signal.signal(number, self._stop) for number in SIGNALS}
            self._report, sys.unraisablehook = sys.unraisablehook, self._lost
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler if handler is not None else signal.SIG_DFL)  # type: ignore[arg-type]
        if self._before:
            sys.unraisablehook = self._report

    def check(self) -> None:
        """Raise again if a signal came: an exception that met a destructor or a callback of C code is lost."""
        if self.requested:
            raise KeyboardInterrupt

    def _lost(self, unraisable: UnraisableHookArgs) -> None:
        """Say nothing of an interruption that C code swallowed: `check` raises it again, and one message is enough."""
        if not (self.requested and unraisable.exc_type is KeyboardInterrupt):
            self._report(unraisable)

    def _stop(self, _number: int, _frame: FrameType | None) -> None:
        if self.requested:
            return
        self.requested = True
        raise KeyboardInterrupt
