"""A command by its entry point in this process: where no fresh one is the subject, its start would cost the most."""

from __future__ import annotations

import sys
from contextlib import redirect_stderr, redirect_stdout
from importlib import import_module
from io import StringIO
from typing import NamedTuple
from unittest.mock import patch


class Ended(NamedTuple):
    """What a command left: exit code, output, messages."""

    returncode: int
    stdout: str
    stderr: str


def command(package: str, *arguments: str) -> Ended:
    """Run `siggen` or, of the package `diagnostics`, `siggen-diagnostics`."""
    main = import_module(f"{package}.cli.app").main
    printed, said, code = StringIO(), StringIO(), 0
    with patch.object(sys, "argv", [package, *arguments]), redirect_stdout(printed), redirect_stderr(said):
        try:
            main()
        except SystemExit as stop:
            code = stop.code if isinstance(stop.code, int) else int(stop.code is not None)
    return Ended(code, printed.getvalue(), said.getvalue())
