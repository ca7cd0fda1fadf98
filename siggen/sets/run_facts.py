"""What run.json keeps of a run: its speed, where the time went, and on which machine."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import UTC, datetime
from typing import Any

from siggen.dataset.environment import host_facts, peak_memory_bytes
from siggen.dataset.sidecar import Sidecar
from siggen.engines.protocol import Engine
from siggen.sets.run_journal import RunJournal


def run_facts(
    duration_s: float,
    engine: Engine,
    sidecars: Iterable[Sidecar],
    journal: RunJournal,
    *,
    made: int,
    taken_over: int,
    environment: dict[str, str],
) -> dict[str, Any]:
    """Return the facts of the run that finished a set; records of earlier runs are in `shards_taken_over` alone."""
    seconds = journal.seconds
    return {
        "finished_at": datetime.now(UTC).isoformat(timespec="seconds"),
        "seconds": round(seconds, 3),
        "engine": type(engine).__name__,
        "workers": engine.workers,
        "records_made": made,
        "records_failed": journal.failures,
        "records_per_s": round(made / seconds, 3),
        "signal_s_per_s": round(made * duration_s / seconds, 3),
        "shards_taken_over": taken_over,
        "stages": journal.stages(),
        "bytes": sum(file.bytes for sidecar in sidecars for file in sidecar.files),
        "peak_memory_bytes": peak_memory_bytes(),
        "host": host_facts(),
        "environment": environment,
    }
