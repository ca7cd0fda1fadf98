"""What a record of every shipped preset costs, split by stage: as `siggen.record` times them, and writing."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

import pyarrow as pa

from benchmarks.row import Row, duration_text
from benchmarks.shipped import ROOT, shipped
from siggen.columns.record import SimulatedRecord, record_batch
from siggen.dataset.shard import packed
from siggen.dataset.storage import LocalFolder
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record, record_ids_of
from siggen.record.stage_times import collected, stage
from siggen.sets.drawn import set_columns, simulated

GOALS_S = {"quickstart": 0.06, "bench": 0.06, "industrial": 0.045}
RECORDS = 4
"""Records of a gearbox, from its first to its last: where a preset has states, one of each of these."""


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield one row per preset: CPU time per second of signal as a sum, and its parts."""
    for file in sorted((ROOT / "configs").glob("*.yaml")):
        config = shipped(file)
        costs(shipped(file, "duration_s=0.05"), 0)  # compiles
        found = [costs(config, gearbox) for gearbox in range(1, 2 if quick else 4)]
        mean = {name: sum(cost.get(name, 0.0) for cost in found) / len(found) for name in found[0]}
        yield _row(file.stem, config, mean)


def _row(name: str, config: SetDesign, cost: Mapping[str, float]) -> Row:
    channels, total = len(config.channels), sum(cost.values())
    goal = GOALS_S.get(name)
    parts = ", ".join(f"{stage} {1e3 * value:.1f}" for stage, value in cost.items())
    return Row(
        f"{name}: a record of {channels} channels, CPU per s of signal",
        duration_text(total),
        f"of it in ms: {parts}",
        goal="" if goal is None else f"<= {duration_text(goal)}",
        met=None if goal is None else total <= goal,
    )


def costs(config: SetDesign, gearbox: int) -> dict[str, float]:
    """Return the CPU time of every stage per second of signal; plan and tables are shared out to all records."""
    ids = record_ids_of(config, gearbox)
    chosen = [ids[round(k * (len(ids) - 1) / (RECORDS - 1))] for k in range(RECORDS)]
    states = {planned_record(config, i).state_id for i in ids}
    with collected("rest") as times:
        results = list(simulated(config, chosen))
        records = [result for result in results if isinstance(result, SimulatedRecord)]
        with stage("writing"), tempfile.TemporaryDirectory() as folder:
            table = pa.Table.from_batches([record_batch(set_columns(config), records)])
            LocalFolder(Path(folder)).put("data.parquet", packed(table))
    shared = {"plan": len(ids), "tables": RECORDS * len(ids) / len(states)}
    return {name: value / shared.get(name, RECORDS) / config.duration_s for name, value in times.seconds.items()}
