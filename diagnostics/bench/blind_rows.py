"""Rows of a test part without what tells a state, decided by the roles of columns; and the labels that are sealed.

Signals, pulses and conditions stay. Numbers of records and gearboxes are drawn anew. What follows from the damage, what
was drawn for the record and what can be computed from the signal do not go along. One healthy record of each gearbox is
told, as a reference: it is the split `train` of the part.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import pyarrow as pa

from diagnostics.bench.derived_secret import shuffled
from diagnostics.records.state_classes import HEALTHY, SHAM
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
Key = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Renumbered:
    """New numbers of the records of a part.

    Attributes
    ----------
    record, gearbox : mapping of int to int
        Number in the simulated set -> number in the part.
    references : frozenset of int
        Records, by their number in the simulated set, that are told to be healthy.
    """

    record: Mapping[int, int]
    gearbox: Mapping[int, int]
    references: frozenset[int]


def renumbered(dataset: Dataset, secret: bytes, name: str, place: int) -> Renumbered:
    """Return new numbers in an order that only the secret tells, references first.

    Parameters
    ----------
    dataset : siggen Dataset
        The simulated set.
    secret : bytes
    name : str
        Of the part.
    place : int
        Of the part, from 0.
    """
    rows, first = dataset.labels().to_pylist(), (place + 1) * PER_PART
    references = frozenset(_references(rows, secret, name))
    ids = [row["record_id"] for row in rows]
    ordered = shuffled(secret, f"records/{name}", ids)
    ordered.sort(key=lambda one: one not in references)  # stable: both kinds stay in their order
    gearboxes = shuffled(secret, f"gearboxes/{name}", {row["specimen_id"] for row in rows})
    return Renumbered(
        {old: first + new for new, old in enumerate(ordered)},
        {old: first + new for new, old in enumerate(gearboxes)},
        references,
    )


def _references(rows: list[dict[str, Any]], secret: bytes, name: str) -> Iterator[int]:
    """Yield a healthy record of every gearbox and operating point that has two of them, drawn by lot."""
    healthy: dict[Key, list[int]] = {}
    for row in rows:
        if row["fault"] == HEALTHY and not row.get(SHAM, False):
            healthy.setdefault((row["specimen_id"], row["operating_point_id"]), []).append(row["record_id"])
    yield from (shuffled(secret, f"references/{name}", own)[0] for own in healthy.values() if len(own) > 1)


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
        for place in range(batch.num_rows):
            row = as_record(batch.slice(place, 1))
            found.append(_blind(row, numbers, kept, [channel.column for channel in dataset.channels]))
    return sorted(found, key=lambda row: int(row["record_id"]))


def _blind(row: dict[str, Any], numbers: Renumbered, kept: list[str], signals: list[str]) -> dict[str, Any]:
    told = row["record_id"] in numbers.references
    return {
        **{name: row[name] for name in kept},
        "record_id": numbers.record[row["record_id"]],
        "specimen_id": numbers.gearbox[row["specimen_id"]],
        "state_id": int(not told),
        "repeat": 0,
        "split": "train" if told else "test",
        **dict.fromkeys(TEXTS, HEALTHY if told else UNKNOWN),
        "faulty_gear": "none" if told else UNKNOWN,
        **dict.fromkeys(NUMBERS, 0.0 if told else math.nan),
        "signals": tuple(row[name].copy() for name in signals),
        "tacho_s": row["tacho_s"],
    }


def sealed_part(dataset: Dataset, numbers: Renumbered) -> dict[str, Any]:
    """Return labels and damaged teeth of a part, columns by name, ascending by new numbers."""
    table = dataset.labels()
    targets = [
        field.name for field in table.schema if (field.metadata or {}).get(b"role") == Role.TARGET.value.encode()
    ]
    labels = table.select(["record_id", "state_id", *targets]).to_pylist()
    labels = [
        {**row, "simulated_record_id": row["record_id"], "record_id": numbers.record[row["record_id"]]}
        for row in labels
    ]
    damage = dataset.damage().select(["record_id", "gear", "tooth"]).to_pylist()
    damage = [{**row, "record_id": numbers.record[row["record_id"]]} for row in damage]
    return {"labels": _columns(labels), "damage": _columns(damage) or {"record_id": [], "gear": [], "tooth": []}}


def _columns(rows: list[dict[str, Any]]) -> dict[str, list[Any]]:
    rows.sort(key=lambda row: int(row["record_id"]))
    return {name: [row[name] for row in rows] for name in (rows[0] if rows else ())}
