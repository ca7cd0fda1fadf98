"""How long `siggen --help` takes, beside an empty Python and the import of the slowest library."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from benchmarks.row import Row, cost_row
from benchmarks.timing import Candidate, medians

GOAL_S = 0.5
ROUNDS = 7

HELP = [str(Path(sys.executable).with_name("siggen")), "--help"]
COMMANDS = {
    "siggen --help": HELP,
    "python -c pass": [sys.executable, "-c", "pass"],
    "python -c 'import numba'": [sys.executable, "-c", "import numba"],
}


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield wall times of whole processes."""
    candidates = {name: Candidate(partial(_run, command)) for name, command in COMMANDS.items()}
    _run(HELP)  # byte code and file cache
    cost = medians(candidates, 3 if quick else ROUNDS, time.perf_counter)
    own, *others = COMMANDS
    for name in others:
        yield cost_row(f"{own}, wall", cost[own], name, cost[name], GOAL_S)


def _run(command: list[str], _number: int = 0) -> None:
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
