"""How long `siggen --help` takes, and what the process imports whose copies are the workers."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from benchmarks.row import Row, cost_row
from benchmarks.timing import Candidate, medians
from siggen.workers.process_pool import DRIVER, PRELOADED

GOAL_S = 0.5
WORKER_GOAL_S = 0.8
ROUNDS = 7

HELP = [str(Path(sys.executable).with_name("siggen")), "--help"]
COMMANDS = {
    "siggen --help": HELP,
    "python -c pass": [sys.executable, "-c", "pass"],
    "python -c 'import numba'": [sys.executable, "-c", "import numba"],
}
WORKER = [sys.executable, "-c", f"import {PRELOADED}"]


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield wall times of whole processes, and the CPU time of the one that imports for all workers."""
    candidates = {name: Candidate(partial(_run, command)) for name, command in COMMANDS.items()}
    _run(HELP)  # byte code and file cache
    cost = medians(candidates, 3 if quick else ROUNDS, time.perf_counter)
    own, *others = COMMANDS
    for name in others:
        yield cost_row(f"{own}, wall", cost[own], name, cost[name], GOAL_S)
    os.environ[DRIVER] = str(os.getpid())  # else it imports nothing
    imports = {name: Candidate(partial(_run, command)) for name, command in {"worker": WORKER, **COMMANDS}.items()}
    cost, (_, libraries) = medians(imports, 3 if quick else ROUNDS, _children_cpu_s), others
    del os.environ[DRIVER]
    what = "what all workers of a machine import, once, CPU"
    yield cost_row(what, cost["worker"], libraries, cost[libraries], WORKER_GOAL_S)


def _run(command: list[str], _number: int = 0) -> None:
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def _children_cpu_s() -> float:
    times = os.times()
    return times.children_user + times.children_system
