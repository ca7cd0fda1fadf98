"""Some records of a set, simulated by their numbers as the set would hold them; nothing is written."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass

import pyarrow as pa

from siggen.columns.record import ChannelColumn, RecordFailure, damage_schema, label_schema, record_schema
from siggen.gearbox.design import SetDesign, expect_design
from siggen.gearbox.plan import expect_record
from siggen.sets import physics as contents
from siggen.sets.verification import OneRecord
from siggen.workers.choice import workers_of
from siggen.workers.tasks import results


@dataclass(frozen=True, slots=True)
class ChosenRecords:
    """Records of a set, without the set.

    Attributes
    ----------
    rows : pyarrow.Table
        A row per record that did not fail, in the order asked for: labels, channels, `tacho_s`.
    labels : pyarrow.Table
        The same without signals and pulses, as `siggen.open(...).labels` returns them.
    damage : pyarrow.Table
        A row per single damage, as `siggen.open(...).damage` returns them.
    channels : tuple of ChannelColumn
    failures : tuple of RecordFailure
    """

    rows: pa.Table
    labels: pa.Table
    damage: pa.Table
    channels: tuple[ChannelColumn, ...]
    failures: tuple[RecordFailure, ...]


def simulate_records(design: SetDesign, record_ids: Sequence[int], workers: int | None = None) -> ChosenRecords:
    """Return some records of a set, as the whole set holds them.

    Parameters
    ----------
    design : SetDesign
        What `load_config` returns.
    record_ids : sequence of int
        Numbers of records, as `plan` lists them.
    workers : int, optional
        Worker processes, by default one per core. 0 runs everything in this process.

    Raises
    ------
    UsageError
        If the design is none, or has no record of such a number.
    EngineError
        If a simulation raised.
    """
    expect_design(design)
    for record_id in record_ids:
        expect_record(design, record_id, "record_ids")
    physics = contents.physics()
    simulation = physics.simulation(design)
    tasks = [OneRecord((record_id,)) for record_id in record_ids]
    with closing(results(workers_of(None, workers), simulation, tasks)) as answers:
        made = [found for _, found in sorted(answers, key=lambda answer: answer[0])]
    columns = simulation.columns
    schema = record_schema(columns)  # Arrow forgets what elements of signals are called on the way between processes
    rows = pa.Table.from_batches([one.rows.cast(schema) for one in made], schema)
    damage = [row for record_id in rows["record_id"].to_pylist() for row in physics.damage_rows(design, [record_id])]
    return ChosenRecords(
        rows,
        rows.select(label_schema(columns).names),
        pa.Table.from_pylist(damage, schema=damage_schema(columns)),
        tuple(columns.channels),
        tuple(failure for one in made for failure in one.failures),
    )
