"""How long `siggen --help` and `predict` take, and what the process imports whose copies are the workers."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import siggen
from benchmarks.row import Row, cost_row
from benchmarks.timing import Candidate, medians
from siggen.workers.process_pool import DRIVER, PRELOADED

GOAL_S = 0.5
WORKER_GOAL_S = 0.8
PREDICT_GOAL_S, RECORDING_S = 2.0, 10.0
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
    yield from _predicted(3 if quick else ROUNDS)


def _predicted(rounds: int) -> Iterator[Row]:
    """Yield the CPU time of a process that asks the network that comes along."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "recording.npz"
        design = siggen.load_config("quickstart", [f"duration_s={RECORDING_S:g}"])
        record = siggen.simulate_records(design, [3], 0).rows.to_pylist()[0]
        columns = [name for name in record if name == "tacho_s" or name.startswith("accel_")]
        np.savez(file, **{name: np.array(record[name]) for name in columns})
        program = str(Path(sys.executable).with_name("siggen-diagnostics"))
        teeth, rate = f"{record['teeth_pinion']},{record['teeth_gear']}", f"{design.fs_hz:g}"
        asked = [program, "predict", str(file), "--teeth", teeth, "--fs", rate]
        commands = {"predict": asked, "python -c 'import torch'": [sys.executable, "-c", "import torch"]}
        candidates = {name: Candidate(partial(_run, command)) for name, command in commands.items()}
        for candidate in candidates.values():
            candidate.function(0)
        cost, (own, other) = medians(candidates, rounds, _children_cpu_s), commands
    what = f"siggen-diagnostics {own}, {RECORDING_S:g} s of 2 channels, CPU"
    yield cost_row(what, cost[own], other, cost[other], PREDICT_GOAL_S)


def _run(command: list[str], _number: int = 0) -> None:
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def _children_cpu_s() -> float:
    times = os.times()
    return times.children_user + times.children_system
