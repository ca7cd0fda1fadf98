"""Records of a set by their ids, as the workers of `generate` simulate them."""

from __future__ import annotations

from collections.abc import Sequence

from siggen.columns.record import RecordFailure, SimulatedRecord
from siggen.config import Config
from siggen.planning.plan import planned_record
from siggen.record.simulation import simulate_specimen


def simulate(config: Config, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Simulate any records; a record is a pure function of (config, record_id), so order and grouping do not matter."""
    by_specimen: dict[int, list[int]] = {}
    for record_id in record_ids:
        by_specimen.setdefault(planned_record(config, record_id).specimen_id, []).append(record_id)
    done = {
        record_id: result
        for ids in by_specimen.values()
        for record_id, result in zip(ids, simulate_specimen(config, ids), strict=True)
    }
    return [done[i] for i in record_ids]
