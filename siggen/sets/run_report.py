"""What run.json says of a run, as text for people."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from siggen.dataset.manifest import RUN
from siggen.dataset.seal import unsealed
from siggen.dataset.storage_at import storage_at
from siggen.errors import DatasetError, counted

DRIVER = {
    "planning": "which shards and records there are",
    "taking over": "shards of earlier runs, hashed",
    "compiling": "compiled code, the first time after an install",
    "waiting": "for records of the workers; without workers, making them",
    "engine": "starting and ending workers",
    "closing": "tables, card, manifest",
}
WORKERS = {
    "plan": "what is drawn for gearbox and record",
    "tables": "damage, errors, mesh stiffness of every state",
    "inputs": "drive, errors and loads over the record",
    "loop": "time integration",
    "sensing": "paths, sensors, noise, background",
    "rows": "rows of the files",
    "files": "shards, with their hashes, and what tables take from them",
    "other": "labels, start of a chunk",
}


def read_run(path: Path | str) -> dict[str, Any]:
    """Return run.json of a set.

    Raises
    ------
    DatasetError
        If there is none, or it is damaged.
    """
    storage = storage_at(path)
    if not storage.exists(RUN):
        raise DatasetError(
            f"{storage.location} has no {RUN}: it is no finished set, or one that was passed on without it"
        )
    return unsealed(f"{storage.location}/{RUN}", storage.get(RUN))


def run_text(facts: Mapping[str, Any]) -> str:
    """Return one line on the run as a whole, and a table of its stages if it was written by a version that had them."""
    workers = f"{facts.get('engine', 'an engine')} with {counted(facts['workers'], 'worker')}"
    failed = f", {facts['records_failed']} failed" if "records_failed" in facts else ""
    made = f"{counted(facts['records_made'], 'record')}{failed}"
    head = f"{made} in {facts['seconds']:.1f} s ({facts['records_per_s']:.3g}/s), {workers}"
    stages = facts.get("stages")
    if not stages:
        return f"{head}\nno stages: the set is of a version of siggen that did not measure them"
    driver, worker = stages["driver_s"], stages["worker_cpu_s"]
    lines = [*_table("driver, wall time", driver, DRIVER), *_table("workers, CPU time", worker, WORKERS)]
    return "\n".join([head, *lines])


def _table(title: str, seconds: Mapping[str, float], meanings: Mapping[str, str]) -> Iterator[str]:
    total = sum(seconds.values())
    if not total:
        return
    yield ""
    yield f"{title:<18}{'s':>10}{'share':>8}"
    for stage in (*meanings, *(name for name in seconds if name not in meanings)):
        if stage in seconds:
            share = f"{100 * seconds[stage] / total:.1f} %"
            yield f"{stage:<18}{seconds[stage]:>10.2f}{share:>8}  {meanings.get(stage, '')}".rstrip()
    yield f"{'sum':<18}{total:>10.2f}"
