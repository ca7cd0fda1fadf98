"""A set as the source of a page: labels, indicators, signals, damage, and what no sensor sees where a set stores it.

Which of its records a page shows, and which healthy record each is laid over. Damaged flanks are to scale: face width,
ends of the flank, and the outline of every pit or spall.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.explore.look import TEMPLATES
from diagnostics.explore.payload import Detail, PageSource, further_labels, packed_indicators, packed_wave
from diagnostics.indicators.table import RecordTable
from diagnostics.page.sentences import listed
from diagnostics.records.channel_quantities import channel_quantities
from diagnostics.records.recording import Recording, one_recording, pair_teeth, recordings
from diagnostics.records.state_classes import HEALTHY
from siggen.dataset.reading import Dataset


def missing_parts(
    labels: Mapping[str, np.ndarray],
    overlaid: Sequence[int | None],
    flanks: bool,
    internals: bool,
    *,
    named: bool,
) -> list[str]:
    """Return sentences on what is missing; none for a set that has everything."""
    healthy = labels["fault"] == HEALTHY
    return listed(
        TEMPLATES / "missing_of_set.txt",
        records=healthy.size,
        healthy=bool(healthy.any()),
        gearboxes=np.unique(labels["specimen_id"][healthy]).size,
        alone=sum(other is None for other in overlaid),
        flanks=flanks,
        internals=internals,
        named=named,
    )


def chosen_records(labels: Mapping[str, np.ndarray], limit: int, first: Sequence[int] = ()) -> np.ndarray:
    """Return the rows of whole gearboxes, spread evenly over the set, that stay within the limit.

    Of a set whose first gearbox alone has more records, rows spread evenly over it come back.

    Parameters
    ----------
    labels : mapping of str to (records,)
        Column `specimen_id`.
    limit : int
        Most records.
    first : sequence of int
        Gearboxes that come before all others, in this order, as far as the limit allows.
    """
    specimens, counts = np.unique(labels["specimen_id"], return_counts=True)
    if labels["specimen_id"].size <= limit:
        return np.arange(labels["specimen_id"].size)
    size = dict(zip(specimens.tolist(), counts.tolist(), strict=True))
    kept = _first_within([number for number in dict.fromkeys(first) if number in size], size, limit)
    rest = np.array([number for number in specimens.tolist() if number not in kept])
    left = limit - sum(size[number] for number in kept)
    for wanted in range(rest.size, -1, -1):
        place = np.unique(np.linspace(0, rest.size - 1, wanted).round().astype(np.int64))
        chosen = [*kept, *rest[place].tolist()]
        if chosen and sum(size[number] for number in rest[place].tolist()) <= left:
            return np.flatnonzero(np.isin(labels["specimen_id"], chosen))
    rows = np.flatnonzero(labels["specimen_id"] == specimens[0])
    return np.asarray(rows[np.unique(np.linspace(0, rows.size - 1, limit).round().astype(np.int64))])


def _first_within(wanted: Sequence[int], size: Mapping[int, int], limit: int) -> list[int]:
    """Return the gearboxes, in order, until the next would exceed the limit."""
    total = np.cumsum([size[number] for number in wanted])
    return [number for number, records in zip(wanted, total, strict=True) if records <= limit]


def overlaid_records(labels: Mapping[str, np.ndarray]) -> list[int | None]:
    """Return for every row the row of its gearbox's healthy record, None where there is no other than itself.

    Same gearbox and operating point; the same repeat if there is one, for a healthy record another repeat.
    """
    healthy = labels["fault"] == HEALTHY
    overlaid: list[int | None] = []
    for row in range(healthy.size):
        same = healthy & (labels["specimen_id"] == labels["specimen_id"][row])
        same &= labels["operating_point_id"] == labels["operating_point_id"][row]
        same[row] = False
        rows = np.flatnonzero(same)
        nearest = rows[np.argsort(labels["repeat"][rows] != labels["repeat"][row], kind="stable")]
        overlaid.append(int(nearest[0]) if nearest.size else None)
    return overlaid


ELLIPSE_CORNERS = 48
DIGITS = 3
FLANK = {"face_mm": "face_width_mm", "pitch_mm": "pitch_height_mm", "tip_mm": "tip_height_mm"}
"""Size of the damaged gear's flanks, and the columns that hold it."""


def outlines(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return the damage of a record: gear, tooth, kind, depth, corners (face, height) of the outline, flank [mm]."""
    return [
        {
            "gear": row["gear"],
            "tooth": row["tooth"],
            "kind": row["kind"],
            "depth_mm": round(float(row["depth_mm"]), DIGITS),
            "corners": _corners(row),
            "flank": {end: round(float(row[column]), DIGITS) for end, column in FLANK.items()},
        }
        for row in rows
    ]


def _corners(row: Mapping[str, Any]) -> list[list[float]]:
    face, height = np.asarray(row["polygon_face_mm"], float), np.asarray(row["polygon_height_mm"], float)
    if face.size == 0:
        angle = 2.0 * np.pi * np.arange(ELLIPSE_CORNERS) / ELLIPSE_CORNERS
        face = row["face_mm"] + row["semi_axis_face_mm"] * np.cos(angle)
        height = row["height_mm"] + row["semi_axis_profile_mm"] * np.sin(angle)
    corners: list[list[float]] = np.round(np.stack([face, height], axis=1), DIGITS).tolist()
    return corners


WAVES_SHOWN = {
    "transmission_error_m": ("Transmission error", "µm", 1e6),
    "mesh_force_n": ("Mesh force", "N", 1.0),
    "mesh_stiffness_n_per_m": ("Mesh stiffness", "N/µm", 1e-6),
}
"""Title, shown unit and factor of the quantities that the page draws, of those that a set may store."""

SHOWN = (
    *("record_id", "specimen_id", "state", "fault", "split", "repeat", "operating_point_id", "start_angle_rad"),
    *("damaged_area_mm2", "speed_hz", "torque_nm"),
)
ALL_READ = 0.3
"""Share of a set's records from which on reading all of them in order is faster than each by its number."""


def set_source(dataset: Dataset, table: RecordTable, kept: np.ndarray) -> PageSource:
    """Return all records of a set.

    Parameters
    ----------
    dataset : siggen Dataset
    table : RecordTable
        Its indicators.
    kept : (m,) int64
        Rows whose signals the page holds.
    """
    labels, names = chosen_labels(dataset), table.names()
    teeth = dataset.columns_of("teeth")

    @lru_cache(maxsize=1)
    def damage_table() -> pa.Table | None:
        return dataset.damage() if hasattr(dataset, "damage") else None

    return PageSource(
        labels=labels,
        overlay=overlaid_records(labels),
        kept=kept,
        records=lambda numbers: _records(dataset, numbers, labels["record_id"].size),
        channels=tuple(channel.name for channel in dataset.channels),
        fs_hz=dataset.fs_hz,
        duration_s=dataset.duration_s,
        indicators=packed_indicators(
            names, table.values(names), table.settings, table.own, channel_quantities(dataset), table.named
        ),
        teeth=tuple(teeth[gear] for gear in table.named[0].gears),
        further=further_labels(dataset, labels),
        held=channel_quantities(dataset),
        named=table.named,
        damage=lambda numbers: _damage(damage_table(), numbers),
        quantities=shown_internals(dataset),
        internals=lambda numbers, detail, fine: internal_waves(dataset, numbers, detail, fine),
    )


def _records(dataset: Dataset, numbers: np.ndarray, records: int) -> Iterator[Recording]:
    """Yield records by their numbers; some of many each by itself."""
    if len(numbers) >= ALL_READ * records:
        yield from recordings(dataset)
        return
    for number in numbers:
        yield one_recording(dataset, int(number))


def chosen_labels(dataset: Dataset) -> dict[str, np.ndarray]:
    """Return the labels that the page needs, (records,) each; those that the set lacks are left out."""
    table = dataset.labels()
    columns = dict(zip(table.column_names, table.columns, strict=True))
    teeth = dict.fromkeys([*pair_teeth(dataset), *dataset.columns_of("teeth").values()])
    present = [name for name in (*SHOWN, *teeth) if name in columns]
    return {name: np.asarray(columns[name].to_pylist()) for name in present}


def shown_internals(dataset: Dataset) -> list[dict[str, str]]:
    """Return name, title and shown unit of the stored quantities that the page draws; none for a set without them."""
    stored, waves = {column.name for column in getattr(dataset, "internal_columns", ())}, _waves(dataset)
    return [{"name": name, "title": title, "unit": unit} for name, (title, unit, _) in waves.items() if name in stored]


def _waves(dataset: Dataset) -> dict[str, tuple[str, str, float]]:
    """Return the quantities that the page draws, of every mesh where there are several; as `WAVES_SHOWN`."""
    return WAVES_SHOWN | {
        f"{mesh.name}_{name}": (f"{title}, {mesh.name}", unit, factor)
        for mesh in dataset.drivetrain.meshes
        for name, (title, unit, factor) in WAVES_SHOWN.items()
        if mesh.name
    }


def internal_waves(
    dataset: Dataset, ids: np.ndarray, detail: Detail, fine: list[tuple[int, int]]
) -> list[dict[str, Any]]:
    """Return the packed quantities of every record by name; empty for records that the set stores none of.

    Parameters
    ----------
    dataset : siggen Dataset
    ids : (n,) int64
        Numbers of records.
    detail : Detail
        How many points.
    fine : list of (int, int)
        Stretch of every record that is kept whole, as of its signals.
    """
    packed: list[dict[str, Any]] = [{} for _ in ids]
    names, waves = [quantity["name"] for quantity in shown_internals(dataset)], _waves(dataset)
    place = {int(record): row for row, record in enumerate(ids)}
    if not names:
        return packed
    for batch in dataset.internals(columns=["record_id", *names], batch_rows=16):
        for line, record in enumerate(batch.column("record_id").to_pylist()):
            row = place.get(record)
            if row is not None:
                series = {name: waves[name][2] * np.asarray(batch.column(name)[line].values) for name in names}
                packed[row] = {name: packed_wave(values, detail, fine[row]) for name, values in series.items()}
    return packed


def _damage(table: pa.Table | None, ids: np.ndarray) -> dict[int, list[dict[str, Any]]]:
    """Return the outlines of damage by record, empty for a set without a table of damage."""
    if table is None:
        return {}
    kept = table.filter(pc.is_in(table.column("record_id"), value_set=pa.array(ids.tolist(), pa.int64()))).to_pylist()
    by_record: dict[int, list[dict[str, Any]]] = {}
    for row in kept:
        by_record.setdefault(row["record_id"], []).append(row)
    return {record: outlines(rows) for record, rows in by_record.items()}
