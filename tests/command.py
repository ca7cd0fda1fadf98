"""Commands and scripts in this process: where no fresh one is the subject, its start would cost the most."""

from __future__ import annotations

import runpy
import sys
import warnings
from contextlib import redirect_stderr, redirect_stdout
from importlib import import_module
from io import StringIO
from pathlib import Path
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


def script(file: Path) -> str:
    """Run a script as `python FILE` does, but for warnings; return what it printed."""
    path = [str(file.parent), *sys.path]
    with (
        patch.object(sys, "argv", [str(file)]), patch.object(sys, "path", path), redirect_stdout(StringIO()) as printed,
        warnings.catch_warnings(action="ignore"),
    ):  # fmt: skip
        runpy.run_path(str(file), run_name="__main__")
    return printed.getvalue()
