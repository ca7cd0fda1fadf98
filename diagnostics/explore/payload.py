"""Everything that the page's program needs of a set or of recordings, as values that JSON can hold.

Of all records their labels and indicators; of some of them, or of one at a time, signals, spectra and damage too.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from diagnostics.base.progress import Stage
from diagnostics.explore.detail import Detail, page_detail
from diagnostics.explore.packed import packed_column
from diagnostics.explore.page_labels import packed_labels, packed_rows
from diagnostics.explore.record_views import PageAxes, highest_order, order_axis, record_views
from diagnostics.indicators.registry import indicator_definitions, indicator_titles
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.channel_quantities import RECORDED, ShownQuantity
from diagnostics.records.gear_train import PAIR, GearNames, in_column
from diagnostics.records.recording import Recording

Columns = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class PageSource:
    """What a page is made of, whether of a set or of recordings.

    Attributes
    ----------
    labels : dict of str to (n,)
        What the page needs of every record.
    further : dict of str to (n,)
        What records can be chosen and drawn by besides.
    overlay : list of int or None
        Row of the healthy record that each is laid over.
    kept : (m,) int
        Rows whose signals the page holds.
    records : callable
        Yields records by their numbers, in any order; `record_id` in their labels says which.
    channels : tuple of str
    fs_hz, duration_s : float
    indicators : list of dict
        Name, channel, title, definition and packed values of each.
    damage : callable
        Returns outlines by record, of these numbers; nothing where unknown.
    flanks : callable
        Returns the size of the flanks of the gears of a row, None where unknown.
    quantities : list of dict
        What the source stores of what no sensor sees.
    internals : callable
        Returns these of records by their numbers, for a detail and the stretches that are kept whole.
    life : callable, optional
        Returns figure and caption of a gearbox over its life.
    measured : bool
        Whether these are recordings of one machine.
    beside : list of int or None, optional
        Row of the other side that each can be laid over, where there are recordings and simulated records.
    held : mapping
        What channels hold; those of recordings are not named.
    named : GearNames
        Gears whose averages are shown.
    teeth : tuple of str
        Labels with the teeth of the gears of the first mesh.
    """

    labels: dict[str, np.ndarray]
    overlay: list[int | None]
    kept: np.ndarray
    records: Callable[[np.ndarray], Iterable[Recording]]
    channels: tuple[str, ...]
    fs_hz: float
    duration_s: float
    indicators: list[dict[str, Any]]
    teeth: tuple[str, ...]
    further: dict[str, np.ndarray] = field(default_factory=dict)
    damage: Callable[[np.ndarray], Mapping[int, list[dict[str, Any]]]] = lambda _numbers: {}
    flanks: Callable[[int], dict[str, Any]] = lambda _row: {}
    quantities: Sequence[dict[str, str]] = ()
    internals: Callable[[np.ndarray, Detail, list[tuple[int, int]]], list[dict[str, Any]]] = (
        lambda numbers, _detail, _fine: [{} for _ in numbers]
    )
    life: Callable[[int], dict[str, str]] | None = None
    measured: bool = False
    beside: list[int | None] | None = None
    held: Mapping[str, ShownQuantity] = field(default_factory=dict)
    named: GearNames = PAIR

    def holds(self, channel: str) -> ShownQuantity:
        """Return what a channel holds."""
        return self.held.get(channel, RECORDED)


@dataclass(frozen=True, slots=True)
class RecordList:
    """How a page lists records: columns of the table and filters (key and title), and sentences on what is missing.

    `seen` says of how many records a model knows the gearbox; `code` computes an indicator, which it calls COLUMN;
    `ranked` are indicators, the best first.
    """

    columns: Columns
    filters: Columns
    missing: Sequence[str] = ()
    seen: str = ""
    code: str = ""
    ranked: Sequence[str] = ()


def page_axes(source: PageSource, *, full: bool) -> PageAxes:
    """Return points and orders that all records of a page share; `full` asks for all samples."""
    labels, kept = source.labels, max(source.kept.size, 1)
    samples, teeth = round(source.fs_hz * source.duration_s), labels[source.teeth[0]].astype(np.int64)
    both = int((teeth + labels[source.teeth[-1]]).max())
    detail = page_detail(kept * (len(source.channels) + len(source.quantities)), samples, both, full=full)
    revolutions = int(labels["speed_hz"].max() * source.duration_s)
    last = max(highest_order(int(z), source.fs_hz, float(labels["speed_hz"].min())) for z in np.unique(teeth))
    return PageAxes(
        detail,
        order_axis(last, revolutions, detail.order_points),
        order_axis(min(1.5 * float(teeth.max()), last), revolutions, detail.envelope_points),
    )


def page_head(source: PageSource, axes: PageAxes, shown: RecordList) -> dict[str, Any]:
    """Return what the page reads when it opens: labels and indicators of all records, and what they are called."""
    titles = dict((*shown.columns, *shown.filters))
    return {
        "fs_hz": source.fs_hz,
        "samples": round(source.fs_hz * source.duration_s),
        "channels": list(source.channels),
        "held": {name: source.holds(name)._asdict() for name in source.channels},
        "order_step": axes.orders.step,
        "envelope_step": axes.envelope_orders.step,
        "steps_per_tooth": axes.detail.steps_per_tooth,
        "count": int(source.labels["record_id"].size),
        "needed": list(source.labels),
        "labels": packed_labels({**source.labels, **source.further}, titles),
        "overlay": packed_rows(source.overlay),
        "beside": None if source.beside is None else packed_rows(source.beside),
        "indicators": source.indicators,
        "quantities": list(source.quantities),
        "measured": source.measured,
        "gears": list(source.named[0].gears),
        "planetary": source.named[0].planetary,
        "teeth": list(source.teeth),
        "table": shown.columns,
        "filters": shown.filters,
        "missing": list(shown.missing),
        "seen": shown.seen,
        "code": shown.code,
        "ranked": [*shown.ranked, f"fm4_{in_column(source.named[0].gears[0])}"],
        "lives": source.life is not None,
    }


def page_details(source: PageSource, axes: PageAxes, rows: np.ndarray, stage: Stage) -> dict[int, dict[str, Any]]:
    """Return signals, spectra, averages, damage and flanks by row.

    Parameters
    ----------
    source : PageSource
    axes : PageAxes
        Of the page.
    rows : (m,) int
    stage : Stage
        Told of every record.
    """
    numbers, starts = source.labels["record_id"][rows], source.labels.get("start_angle_rad")
    row_of = dict(zip((int(number) for number in numbers), (int(row) for row in rows), strict=True))
    views: dict[int, dict[str, Any]] = {}
    with stage("signals and spectra", len(row_of)) as advance:
        for record in source.records(numbers):
            row = row_of.get(int(record.labels["record_id"]))
            if row is not None:
                start = None if starts is None or starts[row] is None else float(starts[row])
                views[row] = record_views(record, axes, start)
                advance()
    fine = [next(iter(views[int(row)]["channels"].values()))["wave"]["fine"] for row in rows]
    damage, internals = source.damage(numbers), source.internals(numbers, axes.detail, fine)
    return {
        row: {**views[row], "damage": damage.get(number, []), "flanks": source.flanks(row), "internals": inner}
        for (number, row), inner in zip(row_of.items(), internals, strict=True)
    }


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
            facts: dict[str, Any] = {
                "title": titles[held.get(channel, RECORDED).unit].get(base, name),
                "definition": definitions.get(base, "your own indicator"),
            }
            found.append({"name": name, "channel": channel, **facts, **packed_column(column)})
    return found
