"""Everything that the page's program needs of a set, as one value that JSON can hold.

Transmission error, mesh force and mesh stiffness of records, where a set stores what no sensor sees.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from diagnostics.base.progress import Stage
from diagnostics.explore.chosen_records import overlaid_records
from diagnostics.explore.detail import Detail, page_detail
from diagnostics.explore.flanks import flank_size, outlines
from diagnostics.explore.packed import packed_floats
from diagnostics.explore.record_views import PageAxes, highest_order, order_axis, packed_wave, record_views
from diagnostics.indicators.registry import indicator_definitions, indicator_titles
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.table import RecordTable
from diagnostics.records.channel_quantities import RECORDED, ShownQuantity, channel_quantities
from diagnostics.records.gear_train import GEARS, PAIR, GearNames
from diagnostics.records.named_set import words_of
from diagnostics.records.planetary_members import as_pair, teeth_labels
from diagnostics.records.recording import Recording, gear_names, recordings
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


def shown_internals(dataset: Dataset) -> list[dict[str, str]]:
    """Return name, title and shown unit of the stored quantities that the page draws; none for a set without them."""
    stored = {column.name for column in getattr(dataset, "internal_columns", ())}
    return [
        {"name": name, "title": title, "unit": unit} for name, (title, unit, _) in WAVES_SHOWN.items() if name in stored
    ]


def internal_waves(
    dataset: Dataset, ids: np.ndarray, detail: Detail, fine: list[tuple[int, int]]
) -> list[dict[str, Any]]:
    """Return the packed quantities of every record by name; empty for records that the set stores none of.

    Parameters
    ----------
    dataset : siggen Dataset
    ids : (n,) int64
        Records of the page.
    detail : Detail
        How many points.
    fine : list of (int, int)
        Stretch of every record that is kept whole, as of its signals.
    """
    found: list[dict[str, Any]] = [{} for _ in ids]
    names = [quantity["name"] for quantity in shown_internals(dataset)]
    place = {int(record): row for row, record in enumerate(ids)}
    if not names:
        return found
    for batch in dataset.internals(columns=["record_id", *names], batch_rows=16):
        for line, record in enumerate(batch.column("record_id").to_pylist()):
            row = place.get(record)
            if row is not None:
                series = {name: WAVES_SHOWN[name][2] * np.asarray(batch.column(name)[line].values) for name in names}
                found[row] = {name: packed_wave(values, detail, fine[row]) for name, values in series.items()}
    return found


@dataclass(frozen=True, slots=True)
class PageSource:
    """What a page is made of, whether of a set or of recordings.

    Attributes
    ----------
    labels : dict of str to (n,)
        Those of `SHOWN` that are known, and others for the table.
    overlay : list of int or None
        Row of the healthy record that each is laid over.
    records : callable
        Yields the records in any order; `record_id` in their labels says which.
    channels : tuple of str
    fs_hz, duration_s : float
    indicators : list of dict
        Name, channel, title, definition and packed values of each.
    damage : dict of str to list
        Outlines by record; empty where unknown.
    flanks : list of dict
        Size of the flanks of each record's gears, None where unknown.
    quantities : list of dict
        What the source stores of what no sensor sees.
    internals : callable
        Returns these by record, for a detail and the stretches that are kept whole.
    measured : bool
        Whether these are recordings of one machine.
    beside : list of int or None, optional
        Row of the other side that each can be laid over, where there are recordings and simulated records.
    held : mapping
        What channels hold; those of recordings are not named.
    named : GearNames
        Shafts whose averages are shown.
    called : mapping of str to str
        The user's names of gears, by the program's.
    """

    labels: dict[str, np.ndarray]
    overlay: list[int | None]
    records: Callable[[], Iterable[Recording]]
    channels: tuple[str, ...]
    fs_hz: float
    duration_s: float
    indicators: list[dict[str, Any]]
    damage: dict[str, list[dict[str, Any]]]
    flanks: list[dict[str, Any]]
    quantities: list[dict[str, str]]
    internals: Callable[[Detail, list[tuple[int, int]]], list[dict[str, Any]]]
    measured: bool = False
    beside: list[int | None] | None = None
    held: Mapping[str, ShownQuantity] = field(default_factory=dict)
    named: GearNames = PAIR
    called: Mapping[str, str] = field(default_factory=dict)

    def holds(self, channel: str) -> ShownQuantity:
        """Return what a channel holds."""
        return self.held.get(channel, RECORDED)


def set_source(dataset: Dataset, table: RecordTable, rows: np.ndarray) -> PageSource:
    """Return the chosen rows of a set.

    Parameters
    ----------
    dataset : siggen Dataset
    table : RecordTable
        Indicators of the whole set.
    rows : (n,) int64
        Rows of the table that the page shows.
    """
    labels = chosen_labels(dataset, rows)
    return PageSource(
        labels=labels,
        overlay=overlaid_records(labels),
        records=lambda: recordings(dataset),
        channels=tuple(channel.name for channel in dataset.channels),
        fs_hz=dataset.fs_hz,
        duration_s=dataset.duration_s,
        indicators=_indicators(table, rows, dataset),
        held=channel_quantities(dataset),
        named=table.named,
        damage=_damage(dataset, labels["record_id"]),
        called=dict(words_of(dataset).names.gears),
        flanks=[_flanks(dataset, labels, k) for k in range(rows.size)],
        quantities=shown_internals(dataset),
        internals=lambda detail, fine: internal_waves(dataset, labels["record_id"], detail, fine),
    )


def page_payload(source: PageSource, stage: Stage, *, full: bool) -> dict[str, Any]:
    """Return labels, indicators and packed signals.

    Parameters
    ----------
    source : PageSource
    stage : Stage
        Told of every record.
    full : bool
        Whether all samples are wanted.
    """
    labels = source.labels
    axes = _axes(source, full=full)
    signals = _signals(source, axes, stage)
    fine = [next(iter(found["channels"].values()))["wave"]["fine"] for found in signals]
    return {
        "fs_hz": source.fs_hz,
        "samples": round(source.fs_hz * source.duration_s),
        "channels": list(source.channels),
        "held": {name: source.holds(name)._asdict() for name in source.channels},
        "order_step": axes.orders.step,
        "envelope_step": axes.envelope_orders.step,
        "steps_per_tooth": axes.detail.steps_per_tooth,
        "records": [{name: _plain(values[k]) for name, values in labels.items()} for k in range(len(signals))],
        "overlay": source.overlay,
        "damage": source.damage,
        "flanks": source.flanks,
        "indicators": source.indicators,
        "signals": signals,
        "quantities": source.quantities,
        "internals": source.internals(axes.detail, fine),
        "measured": source.measured,
        "shafts": list(source.named.shafts),
        "called": dict(source.called),
        "beside": source.beside,
    }


def chosen_labels(dataset: Dataset, rows: np.ndarray) -> dict[str, np.ndarray]:
    """Return the labels that the page uses, (rows,) each; those that the set lacks are left out."""
    found = dataset.labels()
    columns = dict(zip(found.column_names, found.columns, strict=True))
    if gear_names(dataset).is_planetary:
        columns = as_pair(columns)
    further = (f"teeth_{mesh}_{gear}" for mesh in gear_names(dataset).meshes for gear in GEARS)
    present = [name for name in (*SHOWN, *teeth_labels(), *further) if name in columns]
    return {name: np.asarray(columns[name].to_pylist())[rows] for name in present}


def _plain(value: Any) -> Any:
    plain = value.item() if isinstance(value, np.generic) else value
    return plain if not isinstance(plain, float) or np.isfinite(plain) else None


def _axes(source: PageSource, *, full: bool) -> PageAxes:
    labels = source.labels
    samples, teeth = round(source.fs_hz * source.duration_s), labels["teeth_pinion"].astype(np.int64)
    both = int((teeth + labels["teeth_gear"]).max())
    detail = page_detail(teeth.size * (len(source.channels) + len(source.quantities)), samples, both, full=full)
    revolutions = int(labels["speed_hz"].max() * source.duration_s)
    last = max(highest_order(int(z), source.fs_hz, float(labels["speed_hz"].min())) for z in np.unique(teeth))
    return PageAxes(
        detail,
        order_axis(last, revolutions, detail.order_points),
        order_axis(min(1.5 * float(teeth.max()), last), revolutions, detail.envelope_points),
    )


def _damage(dataset: Dataset, ids: np.ndarray) -> dict[str, list[dict[str, Any]]]:
    """Return the outlines of damage by record, empty for a set without a table of damage."""
    if not hasattr(dataset, "damage"):
        return {}
    table, short = dataset.damage(), {own: gear for gear, own in words_of(dataset).names.gears}
    kept = table.filter(pc.is_in(table.column("record_id"), value_set=pa.array(ids.tolist(), pa.int64()))).to_pylist()
    by_record: dict[str, list[dict[str, Any]]] = {}
    for row in kept:
        row["gear"] = short.get(row["gear"], row["gear"])
        by_record.setdefault(str(row["record_id"]), []).append(row)
    return {record: outlines(found) for record, found in by_record.items()}


def _flanks(dataset: Dataset, labels: dict[str, np.ndarray], row: int) -> dict[str, Any]:
    names, known = words_of(dataset).names, gear_names(dataset)
    every = [*GEARS, *(f"{mesh}.{gear}" for mesh in known.meshes for gear in GEARS)]
    return {
        gear: flank_size(dataset.config, section, int(labels[f"teeth_{gear.replace('.', '_')}"][row]), names)
        for gear, section in (OF_PLANETS.items() if known.is_planetary else zip(every, every, strict=True))
    }


def _indicators(table: RecordTable, rows: np.ndarray, dataset: Dataset) -> list[dict[str, Any]]:
    """Return the indicators of a set in the user's names."""
    names, words, held = table.names(), words_of(dataset), channel_quantities(dataset)
    found = packed_indicators(names, table.values(names)[rows], table.settings, table.own, held, table.named)
    return [
        {**one, "name": words.column(one["name"])}
        | {key: words.about(one["name"].rpartition("__")[0], one[key]) for key in ("title", "definition")}
        for one in found
    ]


def packed_indicators(
    names: Sequence[str],
    values: np.ndarray,
    settings: IndicatorSettings,
    own: Collection[str] = (),
    held: Mapping[str, ShownQuantity] = MappingProxyType({}),
    named: GearNames = PAIR,
) -> list[dict[str, Any]]:
    """Return name, title, definition and packed values (records, names) of every indicator that some record defines."""
    units = {RECORDED.unit, *(one.unit for one in held.values())}
    titles = {unit: indicator_titles(settings, unit, named) for unit in units}
    definitions, found = indicator_definitions(settings, named), []
    for name, column in zip(names, values.T, strict=True):
        base, _, channel = name.rpartition("__") if name not in own else (name, "", "")
        if np.isfinite(column).any():
            facts = {
                "title": titles[held.get(channel, RECORDED).unit].get(base, name),
                "definition": definitions.get(base, "your own indicator"),
            }
            found.append({"name": name, "channel": channel, **facts, "data": packed_floats(column)})
    return found


def _signals(source: PageSource, axes: PageAxes, stage: Stage) -> list[dict[str, Any]]:
    place = {int(record): k for k, record in enumerate(source.labels["record_id"])}
    starts = source.labels.get("start_angle_rad")
    found: list[dict[str, Any]] = [{} for _ in place]
    with stage("signals and spectra", len(place)) as advance:
        for record in source.records():
            row = place.get(int(record.labels["record_id"]))
            if row is not None:
                found[row] = record_views(
                    record, axes, None if starts is None or starts[row] is None else float(starts[row])
                )
                advance()
    return found
