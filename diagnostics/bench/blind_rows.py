"""Rows of a test part without what tells a state, decided by the roles of columns; and the labels that are sealed.

Signals, pulses and conditions stay. Numbers of records and gearboxes are drawn anew. What follows from the damage, what
was drawn for the record and what can be computed from the signal do not go along. Which records are shown, told or
asked about follows from what the benchmark asks.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import pyarrow as pa

from diagnostics.bench.derived_secret import shuffled
from diagnostics.bench.question import PublishedRecords, Renumbered
from diagnostics.records.state_classes import HEALTHY
from diagnostics.scoring.benchmark import PER_PART
from siggen.dataset.reading import Dataset, as_record
from siggen.keys.column import Role

UNKNOWN = "unknown"
TEXTS = ("state", "fault", "severity")
NUMBERS = ("damaged_area_mm2", "damaged_area_share", "damage_profile_length_mm", "mesh_stiffness_loss")
"""Columns that every reader of sets expects; of a test record they say nothing."""
GIVEN = ("operating_point_id", "speed_hz", "torque_nm")
"""Conditions that every set has."""
TEETH = "teeth_"


def renumbered(dataset: Dataset, shown: PublishedRecords, secret: bytes, name: str, place: int) -> Renumbered:
    """Return new numbers in an order that only the secret tells, those that are asked about last.

    Parameters
    ----------
    dataset : siggen Dataset
        The simulated set.
    shown : Shown
        Which of its records are published.
    secret : bytes
    name : str
        Of the part.
    place : int
        Of the part, from 0.
    """
    first = (place + 1) * PER_PART
    specimens = set(dataset.labels(columns=["specimen_id"]).column("specimen_id").to_pylist())
    ordered = shuffled(secret, f"records/{name}", shown.state_id)
    ordered.sort(key=lambda one: one in shown.asked)  # stable: both kinds stay in their order
    gearboxes = shuffled(secret, f"gearboxes/{name}", specimens)
    return Renumbered(
        {old: first + new for new, old in enumerate(ordered)},
        {old: first + new for new, old in enumerate(gearboxes)},
        shown,
    )


def condition_fields(dataset: Dataset) -> pa.Schema:
    """Return the columns that are conditions, beside those of every set."""
    schema = dataset.labels().schema
    kept = [field for field in schema if (field.metadata or {}).get(b"role") == Role.CONDITION.value.encode()]
    return pa.schema([field for field in kept if field.name not in GIVEN and not field.name.startswith(TEETH)])


def blind_rows(dataset: Dataset, numbers: Renumbered) -> list[dict[str, Any]]:
    """Return the rows of a part by their new numbers, with signals."""
    found = []
    kept = [*GIVEN, *condition_fields(dataset).names]
    kept += [name for name in dataset.labels().column_names if name.startswith(TEETH)]
    for batch in dataset.records(batch_rows=16):
        for place, record in enumerate(batch.column("record_id").to_pylist()):
            if record in numbers.record:
                row = as_record(batch.slice(place, 1))
                found.append(_blind(row, numbers, kept, [channel.column for channel in dataset.channels]))
    return sorted(found, key=lambda row: int(row["record_id"]))


def _blind(row: dict[str, Any], numbers: Renumbered, kept: list[str], signals: list[str]) -> dict[str, Any]:
    told = row["record_id"] in numbers.shown.told
    return {
        **{name: row[name] for name in kept},
        "record_id": numbers.record[row["record_id"]],
        "specimen_id": numbers.gearbox[row["specimen_id"]],
        "state_id": numbers.shown.state_id[row["record_id"]],
        "repeat": 0,
        "split": numbers.split(row["record_id"]),
        **dict.fromkeys(TEXTS, HEALTHY if told else UNKNOWN),
        "faulty_gear": "none" if told else UNKNOWN,
        **dict.fromkeys(NUMBERS, 0.0 if told else math.nan),
        "signals": tuple(row[name].copy() for name in signals),
        "tacho_s": row["tacho_s"],
    }


def sealed_part(dataset: Dataset, numbers: Renumbered, life: Mapping[str, pa.Table]) -> dict[str, Any]:
    """Return labels, damaged teeth and tables of `life/` of a part, columns by name, ascending by new numbers."""
    table = dataset.labels()
    targets = [
        field.name for field in table.schema if (field.metadata or {}).get(b"role") == Role.TARGET.value.encode()
    ]
    labels = table.select(["record_id", "state_id", *targets]).to_pylist()
    labels = _published([{**row, "simulated_record_id": row["record_id"]} for row in labels], numbers)
    damage = _published(dataset.damage().select(["record_id", "gear", "tooth"]).to_pylist(), numbers)
    return {
        "labels": _columns(labels),
        "damage": _columns(damage) or {"record_id": [], "gear": [], "tooth": []},
        **({"life": {name: table.to_pydict() for name, table in life.items()}} if life else {}),
    }


def _published(rows: list[dict[str, Any]], numbers: Renumbered) -> list[dict[str, Any]]:
    """Return the rows of published records by their new numbers."""
    known = numbers.record
    return [{**row, "record_id": known[row["record_id"]]} for row in rows if row["record_id"] in known]


def _columns(rows: list[dict[str, Any]]) -> dict[str, list[Any]]:
    rows.sort(key=lambda row: int(row["record_id"]))
    return {name: [row[name] for row in rows] for name in (rows[0] if rows else ())}
