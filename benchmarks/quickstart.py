"""The whole quickstart set with all cores, beside the real time of its signals."""

from __future__ import annotations

from collections.abc import Iterator

from benchmarks.row import Row, duration_text
from benchmarks.shipped import QUICKSTART, shipped
from benchmarks.workers import run_facts
from siggen.engines.processes import default_workers

GOAL_S = 60.0


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the wall time of the generation; nothing in a quick run."""
    if quick:
        return
    workers = default_workers()
    facts = run_facts(workers)
    signal_s = facts["records_made"] * shipped(QUICKSTART).duration_s
    yield Row(
        f"quickstart, {facts['records_made']} records, {workers} workers ({facts['records_per_s']:.3g} records/s)",
        duration_text(facts["seconds"]),
        f"real time of the signals: {duration_text(signal_s)}",
        signal_s / facts["seconds"],
        f"<= {duration_text(GOAL_S)}",
        facts["seconds"] <= GOAL_S,
    )
