"""Commands in one fresh process that knows kinds registered from tests: its start costs more than most commands."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from tests.blank_pictures import blank_pictures
from tests.command import command
from tests.house.source_tree import ROOT

PACKAGES = {"siggen": "siggen", "siggen-diagnostics": "diagnostics"}


def said_by(
    module: str, folder: Path, lines: Mapping[str, str], codes: Mapping[str, int] | None = None
) -> dict[str, str]:
    """Run command lines one after the other in a fresh process, in a folder; return by name all that each said.

    Parameters
    ----------
    module : str
        What registers the kinds and then calls `serve`.
    folder : Path
        Where they run.
    lines : mapping of str to str
        Command lines by name.
    codes : mapping of str to int, optional
        Exit codes that are not 0, by name.
    """
    done = subprocess.run(
        [sys.executable, "-m", module], input=json.dumps([shlex.split(line) for line in lines.values()]),
        cwd=folder, env={**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "COLUMNS": "160"},
        capture_output=True, text=True, timeout=500, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    found = {}
    for name, (code, printed, told) in zip(lines, json.loads(done.stdout), strict=True):
        found[name] = printed + told
        assert code == (codes or {}).get(name, 0), f"{lines[name]}: exit code {code}\n{found[name]}"
        assert "Traceback" not in found[name]
    return found


def serve() -> None:
    """Run the command lines of standard input, print what they said as JSON."""
    lines = json.load(sys.stdin)
    with blank_pictures():
        json.dump([command(PACKAGES[program], *words) for program, *words in lines], sys.stdout)
