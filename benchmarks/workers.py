"""Two workers beside one, and the memory that a worker takes at short and at long records."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from statistics import median

from benchmarks.row import Row, duration_text
from benchmarks.shipped import QUICKSTART

SPEEDUP_GOAL = 1.9
MEMORY_GOAL_BYTES = 500e6
MEMORY_WORKERS = 2
DURATIONS_S = (1, 10)


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the gain of a second worker, and the largest worker's memory by length of record."""
    yield from _gain_rows(specimens=4 if quick else 12, pairs=1 if quick else 5)
    for duration_s in DURATIONS_S:
        used = run_facts(MEMORY_WORKERS, "specimens=2", f"duration_s={duration_s}")["largest_worker"]
        bare = _import_memory_bytes()
        yield Row(
            f"peak memory of a worker, records of {duration_s} s",
            f"{used / 1e6:.0f} MB",
            f"importing siggen.record.simulation: {bare / 1e6:.0f} MB",
            used / bare,
            f"<= {MEMORY_GOAL_BYTES / 1e6:.0f} MB",
            used <= MEMORY_GOAL_BYTES,
        )


def run_facts(workers: int, *overrides: str) -> dict:
    """Generate the quickstart with overrides in a process of its own: seconds, records, bytes of the largest worker.

    Raises
    ------
    RuntimeError
        If the generation fails; holds what it said.
    """
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "benchmarks.workers", folder, str(workers), *overrides]
        done = subprocess.run(command, check=False, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"siggen.generate ended with {done.returncode}: {done.stderr.strip()}")
        return json.loads(done.stdout)


def _generate(folder: str, workers: str, *overrides: str) -> None:
    from multiprocessing import forkserver

    import siggen
    from benchmarks.peak_memory import peak_memory_bytes

    done = siggen.generate(siggen.load_config(QUICKSTART, overrides), folder, int(workers))
    forkserver._forkserver._stop()  # type: ignore[attr-defined]  # until it has ended, its workers count for nobody
    facts = {"seconds": done.seconds, "records_made": done.records_made}
    sys.stdout.write(json.dumps({**facts, "largest_worker": peak_memory_bytes()["largest_worker"]}))


def _gain_rows(specimens: int, pairs: int) -> Iterator[Row]:
    """Yield the wall time of one worker over that of two (medians of interleaved pairs), and the same of CPU times."""
    if (os.cpu_count() or 1) < 2:
        yield Row("2 workers against 1", "", "needs two cores")
        return
    wall: dict[int, list[float]] = {1: [], 2: []}
    cpu: dict[int, list[float]] = {1: [], 2: []}
    run_facts(1, "specimens=1")  # compiles, and reads the libraries into the file cache
    records = 0
    for _ in range(pairs):
        for workers in (1, 2):
            before = _children_cpu_s()
            facts = run_facts(workers, f"specimens={specimens}")
            cpu[workers].append(_children_cpu_s() - before)
            wall[workers].append(facts["seconds"])
            records = facts["records_made"]
    gain = median(one / two for one, two in zip(wall[1], wall[2], strict=True))
    what = f"2 workers, {records} records of the quickstart, start of the workers included"
    one, two = median(wall[1]), median(wall[2])
    yield Row(
        what, duration_text(two), f"1 worker: {duration_text(one)}", gain, f">= {SPEEDUP_GOAL}", gain >= SPEEDUP_GOAL
    )
    one, two = median(cpu[1]), median(cpu[2])
    yield Row("the same, CPU time of all processes", duration_text(two), f"1 worker: {duration_text(one)}", one / two)


def _children_cpu_s() -> float:
    times = os.times()
    return times.children_user + times.children_system


def _import_memory_bytes() -> int:
    """Return the peak memory of a process that imports what a worker imports.

    A small process starts it: what the starting process holds counts as the peak of the started one.
    """
    code = (
        "import subprocess, sys; from benchmarks.peak_memory import peak_memory_bytes;"
        "subprocess.run([sys.executable, '-c', 'import siggen.record.simulation'], check=True);"
        "print(peak_memory_bytes()['largest_worker'])"
    )
    return int(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout)


if __name__ == "__main__":  # python -m benchmarks.workers FOLDER WORKERS PATH=VALUE...; workers import this file
    _generate(*sys.argv[1:])
