"""What an engine costs beside the work, and what its driver keeps of a plan: with records that are not simulated.

`measured` is the CPU time of all processes of a run whose records take none, over the CPU time that its records would
take: 30 s, about one shard. The start of an engine is told apart: it comes once, however many shards there are.
"""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import median

from benchmarks.faults.process_tree import cpu_seconds
from benchmarks.row import Row, duration_text
from benchmarks.stand_in import VARIABLE, keep
from siggen.engines.worker import ONE_THREAD

ENGINES = {"serial": "", "processes": "", "dask": "distributed", "ray": "ray"}
WORK_S, OVERHEAD_GOAL = 30.0, 0.05
PLANNED = (1_000, 1_000_000)
FLAT_BYTES = 50e6
PRICE_PER_CORE_HOUR = 0.05
"""Currency units, of a rented core: assumed, so that a cost can be told; it scales with it."""
PLANNING = """
import json, sys
from benchmarks.driver_memory import peak_bytes
print(json.dumps(peak_bytes(int(sys.argv[1]))))
"""


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield overhead and rate per engine, and the memory of the driver by the size of the plan."""
    import siggen

    config = siggen.load_config("quickstart")
    with tempfile.TemporaryDirectory(prefix="bench", dir="/tmp") as name:
        folder = Path(name)
        os.environ.update({VARIABLE: str(folder / "records"), "RAY_TMPDIR": str(folder / "r")})
        gearbox_s = keep(config, folder / "records")
        gearboxes = max(2, round(WORK_S / gearbox_s))
        for engine, package in ENGINES.items():
            if not package or importlib.util.find_spec(package):
                yield _overhead_row(engine, gearboxes, gearbox_s, folder, repeats=1 if quick else 3)
        yield _rate_row(gearbox_s / config.records_per_specimen)
    small, large = (_driver_bytes(count) for count in PLANNED)
    yield from (_memory_row(stage, small[stage], large[stage]) for stage in large)


def _overhead_row(engine: str, gearboxes: int, gearbox_s: float, folder: Path, repeats: int) -> Row:
    starts = [_cpu_s(engine, 1, folder / f"{engine}_start_{i}") for i in range(repeats)]
    totals = [_cpu_s(engine, 1 + gearboxes, folder / f"{engine}_{i}") for i in range(repeats)]
    start_s, work_s = median(starts), gearboxes * gearbox_s
    overhead_s = median(totals) - start_s
    return Row(
        f"{engine}: CPU time beside {gearboxes} gearboxes, which are {work_s:.0f} s of simulation",
        f"{duration_text(overhead_s)}, {100 * overhead_s / work_s:.1f} %",
        f"start, once, with one gearbox: {duration_text(start_s)}",
        work_s / overhead_s,
        f"<= {100 * OVERHEAD_GOAL:.0f} %",
        overhead_s <= OVERHEAD_GOAL * work_s,
    )


def _rate_row(record_s: float) -> Row:
    """Return what a core makes in an hour; the overhead of an engine is not in it."""
    hours = 1e6 * record_s / 3600
    cost = (
        f"{hours:.0f} core-hours a million records, {hours * PRICE_PER_CORE_HOUR:.0f} at {PRICE_PER_CORE_HOUR} an hour"
    )
    return Row("quickstart: records per hour and core", f"{3600 / record_s:.0f}", cost)


def _cpu_s(engine: str, specimens: int, place: Path) -> float:
    command = [sys.executable, "-m", "benchmarks.stand_in", str(place), engine, "1", str(specimens)]
    with tempfile.TemporaryFile() as said:
        run = subprocess.Popen(command, stdout=said, stderr=said, env={**os.environ, **ONE_THREAD})
        found = cpu_seconds(run)
        if run.returncode:
            said.seek(0)
            raise RuntimeError(f"a set with {engine}: {said.read().decode(errors='replace')[-500:]}")
    return found


def _memory_row(stage: str, small: int, large: int) -> Row:
    return Row(
        f"driver, {PLANNED[1]:,} records without their signals, {stage}",
        f"{large / 1e6:.0f} MB",
        f"{PLANNED[0]:,} records: {small / 1e6:.0f} MB",
        small / large,
        f"+ {FLAT_BYTES / 1e6:.0f} MB",
        large - small <= FLAT_BYTES,
    )


def _driver_bytes(records: int) -> dict[str, int]:
    done = subprocess.run([sys.executable, "-c", PLANNING, str(records)], check=True, capture_output=True, text=True)
    return dict(json.loads(done.stdout))
