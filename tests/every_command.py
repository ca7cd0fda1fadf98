"""Every command that exists, by its whole name: `siggen inspect modes`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import typer

import diagnostics.cli.app
import siggen.cli.app

APPS = {"siggen": siggen.cli.app.app, "siggen-diagnostics": diagnostics.cli.app.app}


def _below(name: str, command: Any) -> Iterator[tuple[str, Any]]:
    yield name, command
    for word, below in getattr(command, "commands", {}).items():
        yield from _below(f"{name} {word}", below)


COMMANDS = dict(pair for program, app in APPS.items() for pair in _below(program, typer.main.get_command(app)))
"""Groups too."""
LEAVES = [name for name, command in COMMANDS.items() if not hasattr(command, "commands")]
"""Those that do something."""
