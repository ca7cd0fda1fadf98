"""What report and audit of sets of 100, 1,000 and 10,000 records cost: CPU time of the commands, first and second call.

The sets are of the quickest model, with short records: what grows with a set is reading, indicators, training, judging.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from benchmarks.row import Row, duration_text
from benchmarks.shipped import QUICKSTART

DURATION_S = 0.5
RECORDS_PER_GEARBOX = 5
GEARBOXES = (20, 200)
LARGEST = 10_000
WATCHED = """
import json, resource, subprocess, sys
ended = subprocess.run(sys.argv[1:], stdout=sys.stderr).returncode
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps([used.ru_utime + used.ru_stime, used.ru_maxrss]))
sys.exit(ended)
"""
"""Runs a command from a small process: what a process is said to have held at most begins with its parent's size."""
COMMANDS = {
    "report without networks": ("report", "--no-cnn"),
    "the same again, indicators at hand": ("report", "--no-cnn"),
    "report with networks": ("report",),
    "audit": ("audit",),
}


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the CPU time of each command by number of records; the largest by proportion from the two measured."""
    sizes = GEARBOXES[:1] if quick else GEARBOXES
    found = {gearboxes * RECORDS_PER_GEARBOX: dict(_costs(gearboxes)) for gearboxes in sizes}
    for what in COMMANDS:
        for records, costs in found.items():
            cpu, wall, memory = costs[what]
            name = f"{what}, {records:,} records of {DURATION_S} s: CPU, peak memory"
            yield Row(name, f"{duration_text(cpu)}, {memory / 1e6:.0f} MB", f"wall: {duration_text(wall)}")
        if len(found) > 1:
            (few, first), (many, last) = ((records, costs[what][0]) for records, costs in found.items())
            grown = last + (LARGEST - many) * (last - first) / (many - few)
            yield Row(f"{what}, {LARGEST:,} records, by proportion, not measured", duration_text(grown))


def _costs(gearboxes: int) -> Iterator[tuple[str, tuple[float, float, float]]]:
    """Generate a set and yield CPU time, wall time and largest resident size [bytes] of each command."""
    with tempfile.TemporaryDirectory() as parent:
        folder = Path(parent) / "set"
        overrides = [f"specimens={gearboxes}", f"duration_s={DURATION_S}"]
        chosen = [part for override in overrides for part in ("--set", override)]
        command_cost("siggen", "generate", str(QUICKSTART), *chosen, "--out", str(folder))
        for what, (command, *options) in COMMANDS.items():
            out = str(Path(parent) / command)
            yield what, command_cost("siggen-diagnostics", command, str(folder), *options, "--out", out)


def command_cost(*command: str) -> tuple[float, float, float]:
    """Run an installed command and return its CPU time, its wall time and its largest resident size [bytes].

    Raises
    ------
    RuntimeError
        If it fails; holds what it said.
    """
    program, begin = str(Path(sys.executable).with_name(command[0])), time.perf_counter()
    watched = [sys.executable, "-c", WATCHED, program, *command[1:]]
    done = subprocess.run(watched, check=False, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command[:2])} ended with {done.returncode}: {done.stderr[-500:]}")
    cpu_s, resident_kb = json.loads(done.stdout.splitlines()[-1])
    return cpu_s, time.perf_counter() - begin, 1024.0 * resident_kb
