"""Records of a set by their ids, as the workers of `generate` simulate them."""

from __future__ import annotations

from collections.abc import Sequence

import pyarrow as pa

from siggen.columns.record import RecordFailure, SimulatedRecord
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import PlannedRecord, planned_record
from siggen.gearbox.specimen import Specimen
from siggen.record.internals import internals_table as internals_of
from siggen.sets import drawn
from siggen.sets.drawn import set_columns, simulated


def simulate(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Simulate any records; a record is a pure function of (config, record_id), so order and grouping do not matter."""
    by_specimen: dict[int, list[int]] = {}
    for record_id in record_ids:
        by_specimen.setdefault(planned_record(config, record_id).specimen_id, []).append(record_id)
    done = {
        record_id: result
        for ids in by_specimen.values()
        for record_id, result in zip(ids, simulated(config, ids), strict=True)
    }
    return [done[i] for i in record_ids]


def drawn_record(config: SetDesign, record_id: int) -> tuple[Specimen, PlannedRecord]:
    """Return the gearbox of a record, and where the record stands."""
    planned = planned_record(config, record_id)
    return config.gearbox(planned.specimen_id), planned


def internals_table(config: SetDesign, record_id: int, *, internals: bool = True) -> pa.Table:
    """Return what sensors and nobody saw of one record."""
    return internals_of(*drawn_record(config, record_id), internals=internals)


def label_names(config: SetDesign) -> tuple[str, ...]:
    """Return the keys of the labels of a record."""
    return ("state", *(column.name for column in set_columns(config).labels))


def damage_rows(config: SetDesign, *record_ids: int) -> list[dict[str, object]]:
    """Return the rows of damage of records of one gearbox."""
    return [*drawn.damage_rows(config, record_ids)]
