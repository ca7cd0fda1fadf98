"""A set as the source of a page: labels, indicators, signals, damage, and what no sensor sees where a set stores it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.explore.chosen_records import overlaid_records
from diagnostics.explore.detail import Detail
from diagnostics.explore.flanks import flank_size, outlines
from diagnostics.explore.page_labels import further_labels
from diagnostics.explore.payload import PageSource, packed_indicators
from diagnostics.explore.record_views import packed_wave
from diagnostics.indicators.table import RecordTable
from diagnostics.records.channel_quantities import channel_quantities
from diagnostics.records.recording import Recording, one_recording, pair_teeth, recordings
from siggen.dataset.reading import Dataset

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
        flanks=lambda row: flank_sizes(dataset, {gear: int(labels[name][row]) for gear, name in teeth.items()}),
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
    found = dataset.labels()
    columns = dict(zip(found.column_names, found.columns, strict=True))
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
    found: list[dict[str, Any]] = [{} for _ in ids]
    names, waves = [quantity["name"] for quantity in shown_internals(dataset)], _waves(dataset)
    place = {int(record): row for row, record in enumerate(ids)}
    if not names:
        return found
    for batch in dataset.internals(columns=["record_id", *names], batch_rows=16):
        for line, record in enumerate(batch.column("record_id").to_pylist()):
            row = place.get(record)
            if row is not None:
                series = {name: waves[name][2] * np.asarray(batch.column(name)[line].values) for name in names}
                found[row] = {name: packed_wave(values, detail, fine[row]) for name, values in series.items()}
    return found


def _damage(table: pa.Table | None, ids: np.ndarray) -> dict[int, list[dict[str, Any]]]:
    """Return the outlines of damage by record, empty for a set without a table of damage."""
    if table is None:
        return {}
    kept = table.filter(pc.is_in(table.column("record_id"), value_set=pa.array(ids.tolist(), pa.int64()))).to_pylist()
    by_record: dict[int, list[dict[str, Any]]] = {}
    for row in kept:
        by_record.setdefault(row["record_id"], []).append(row)
    return {record: outlines(found) for record, found in by_record.items()}


def flank_sizes(dataset: Dataset, teeth: Mapping[str, int]) -> dict[str, dict[str, float] | None]:
    """Return the flank's size of every gear but a ring, by its number of teeth."""
    return {gear: flank_size(*law, teeth[gear]) for gear, law in dataset.gears.items()}
