"""The whole quickstart set with all cores, beside the real time of its signals."""

from __future__ import annotations

from collections.abc import Iterator

from benchmarks.row import Row, cost_row
from benchmarks.shipped import QUICKSTART, shipped
from benchmarks.workers import run_facts
from siggen.workers.choice import default_workers

GOAL_S = 60.0


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the wall time of the generation, with all cores and with one; nothing in a quick run."""
    if quick:
        return
    workers = default_workers()
    facts, alone = run_facts(workers), run_facts(1)
    seconds, records = facts["seconds"], facts["records_made"]
    signal_s = records * shipped(QUICKSTART).duration_s
    what = f"{records} records with {workers} workers, wall"
    yield cost_row(what, seconds, "real time of the signals", signal_s, GOAL_S)
    yield cost_row(what, seconds, "1 worker, once", alone["seconds"], GOAL_S)
