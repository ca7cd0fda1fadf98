"""A set as the source of a page: labels, indicators, signals, damage, and what no sensor sees where a set stores it."""

from __future__ import annotations

from collections.abc import Iterator
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
from diagnostics.records.gear_train import GEARS, GearNames
from diagnostics.records.named_set import words_of
from diagnostics.records.planetary_members import as_pair, teeth_labels
from diagnostics.records.recording import TACHO_NAME, Recording, gear_names, recordings, turned
from siggen.dataset.reading import Dataset

WAVES_SHOWN = {
    "transmission_error_m": ("Transmission error", "µm", 1e6),
    "mesh_force_n": ("Mesh force", "N", 1.0),
    "mesh_stiffness_n_per_m": ("Mesh stiffness", "N/µm", 1e-6),
}
"""Title, shown unit and factor of the quantities that the page draws, of those that a set may store."""

SHOWN = (
    *("record_id", "specimen_id", "state", "fault", "split", "repeat", "operating_point_id", "start_angle_rad"),
    *("damaged_area_mm2", "speed_hz", "torque_nm", "teeth_pinion", "teeth_gear"),
)
OF_PLANETS = {"sun": "pinion", "planet": "gear"}
"""Which section of the configuration describes a member of a planetary set."""
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
    labels = chosen_labels(dataset)
    words = words_of(dataset)
    further = {words.column(name): values for name, values in further_labels(dataset, labels).items()}

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
        indicators=_indicators(table, dataset),
        further=further,
        held=channel_quantities(dataset),
        named=table.named,
        damage=lambda numbers: _damage(dataset, damage_table(), numbers),
        called=dict(words.names.gears),
        titles={name: words.column(name) for name in labels},
        flanks=lambda row: _flanks(dataset, labels, table.named, row),
        quantities=shown_internals(dataset),
        internals=lambda numbers, detail, fine: internal_waves(dataset, numbers, detail, fine),
    )


def _records(dataset: Dataset, numbers: np.ndarray, records: int) -> Iterator[Recording]:
    """Yield records by their numbers; some of many each by itself."""
    if len(numbers) >= ALL_READ * records:
        yield from recordings(dataset)
        return
    for number in numbers:
        found = dataset.record(int(number))
        labels, pulses = turned(found, found[TACHO_NAME])
        channels = {channel.name: found[channel.column] for channel in dataset.channels}
        held = {channel.name: channel.quantity for channel in dataset.channels}
        yield Recording(labels, channels, np.asarray(pulses), dataset.fs_hz, held)


def chosen_labels(dataset: Dataset) -> dict[str, np.ndarray]:
    """Return the labels that the page needs, (records,) each; those that the set lacks are left out."""
    found = dataset.labels()
    columns = dict(zip(found.column_names, found.columns, strict=True))
    if gear_names(dataset).is_planetary:
        columns = as_pair(columns)
    further = (f"teeth_{mesh}_{gear}" for mesh in gear_names(dataset).meshes for gear in GEARS)
    present = [name for name in (*SHOWN, *teeth_labels(), *further) if name in columns]
    return {name: np.asarray(columns[name].to_pylist()) for name in present}


def shown_internals(dataset: Dataset) -> list[dict[str, str]]:
    """Return name, title and shown unit of the stored quantities that the page draws; none for a set without them."""
    stored, waves = {column.name for column in getattr(dataset, "internal_columns", ())}, _waves(dataset)
    return [{"name": name, "title": title, "unit": unit} for name, (title, unit, _) in waves.items() if name in stored]


def _waves(dataset: Dataset) -> dict[str, tuple[str, str, float]]:
    """Return the quantities that the page draws, of every mesh where there are several; as `WAVES_SHOWN`."""
    names = dataset.names()[0]
    return dict(WAVES_SHOWN) | {
        names.quantity(mesh, name): (f"{title}, {mesh.word}", unit, factor)
        for mesh in names.meshes[: len(names.meshes) if names.given else 0]
        for name, (title, unit, factor) in WAVES_SHOWN.items()
        if names.quantity(mesh, name) != name
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


def _damage(dataset: Dataset, table: pa.Table | None, ids: np.ndarray) -> dict[int, list[dict[str, Any]]]:
    """Return the outlines of damage by record, empty for a set without a table of damage."""
    if table is None:
        return {}
    short = {own: gear for gear, own in words_of(dataset).names.gears}
    kept = table.filter(pc.is_in(table.column("record_id"), value_set=pa.array(ids.tolist(), pa.int64()))).to_pylist()
    by_record: dict[int, list[dict[str, Any]]] = {}
    for row in kept:
        row["gear"] = short.get(row["gear"], row["gear"])
        by_record.setdefault(row["record_id"], []).append(row)
    return {record: outlines(found) for record, found in by_record.items()}


def _flanks(dataset: Dataset, labels: dict[str, np.ndarray], known: GearNames, row: int) -> dict[str, Any]:
    names = words_of(dataset).names
    every = [*GEARS, *(f"{mesh}.{gear}" for mesh in known.meshes for gear in GEARS)]
    return {
        gear: flank_size(dataset.config, section, int(labels[f"teeth_{gear.replace('.', '_')}"][row]), names)
        for gear, section in (OF_PLANETS.items() if known.is_planetary else zip(every, every, strict=True))
    }


def _indicators(table: RecordTable, dataset: Dataset) -> list[dict[str, Any]]:
    """Return the indicators of a set in the user's names."""
    names, words, held = table.names(), words_of(dataset), channel_quantities(dataset)
    found = packed_indicators(names, table.values(names), table.settings, table.own, held, table.named)
    return [
        {**one, "name": words.column(one["name"])}
        | {key: words.about(one["name"].rpartition("__")[0], one[key]) for key in ("title", "definition")}
        for one in found
    ]
