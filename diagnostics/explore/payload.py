"""Everything that the page's program needs of a set or of recordings, as values that JSON can hold.

Of all records their labels and indicators; of some of them, or of one at a time, signals, spectra and damage too.

Arrays are short texts: 16-bit integers with one step, or floats, in base 64 and little-endian. Fewer points of a long
signal by minimum and maximum of buckets, so that no impulse is lost: how many, so that a page stays below its size.
Source: standard. One axis of pinion orders for all records of a page, so that spectra can be subtracted point by point.
"""

from __future__ import annotations

import base64
import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from types import MappingProxyType
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.base.progress import Stage
from diagnostics.indicators.mesh_signals import mesh_signals
from diagnostics.indicators.registry import indicator_definitions, indicator_titles
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.channel_quantities import RECORDED, ShownQuantity
from diagnostics.records.gear_train import PAIR, GearNames, in_column, meshes_of
from diagnostics.records.recording import Recording
from diagnostics.signal.order_domain import SAMPLES_PER_TOOTH, AngleGrid, angle_grid, resample_to_angle
from diagnostics.signal.spectrum import envelope_spectrum
from diagnostics.signal.synchronous_average import hann_weights, synchronous_average, whole_revolutions
from siggen.dataset.reading import Dataset

SMALL_BYTES = 1_600_000
"""Signals of a page; with indicators, names, pictures and program a report stays below 3 MB."""

FULL_BYTES = 27_000_000
"""The same for all samples, below 30 MB."""

BYTES_PER_POINT = 8 / 3
"""A 16-bit number in base 64."""

LEAST_SCALE = 0.05
MOST_BUCKETS = 1_500
MOST_FINE_SAMPLES = 16_384


@dataclass(frozen=True, slots=True)
class Detail:
    """Points of a channel of one record.

    Attributes
    ----------
    buckets : int
        Stretches of the whole record that are drawn by their minimum and maximum.
    fine_samples : int
        Samples from the first pulse on that are all kept.
    order_points : int
        Points of the order spectrum.
    envelope_points : int
        Points of the envelope spectrum.
    steps_per_tooth : int
        Angle steps of averages.
    """

    buckets: int
    fine_samples: int
    order_points: int
    envelope_points: int
    steps_per_tooth: int

    def points(self, teeth: int) -> int:
        """Return the 16-bit numbers of a channel of a record; an extreme has a place and a value."""
        averages = teeth * self.steps_per_tooth
        return 4 * self.buckets + self.fine_samples + self.order_points + self.envelope_points + averages


WANTED = Detail(550, 1_000, 1_500, 400, 24)
WANTED_FULL = Detail(550, 0, 6_000, 1_000, 24)


def page_detail(channel_records: int, samples: int, teeth: int, *, full: bool) -> Detail:
    """Return the detail of a page.

    Parameters
    ----------
    channel_records : int
        Channels times records.
    samples : int
        Samples of a record.
    teeth : int
        Teeth of pinion and gear together.
    full : bool
        Whether all samples are wanted; so many as fit are kept.
    """
    room = (FULL_BYTES if full else SMALL_BYTES) / BYTES_PER_POINT / max(channel_records, 1)
    if full:
        rest = int(room - WANTED_FULL.points(teeth))
        return replace(WANTED_FULL, fine_samples=min(samples, max(rest, WANTED.fine_samples)))
    scale = min(1.0, max(room / WANTED.points(teeth), LEAST_SCALE))
    spare = max(int(room) - WANTED.points(teeth), 0)
    # first to the whole record, so that it looks as dense as the stretch that is kept whole
    more = min(spare // 4, MOST_BUCKETS - WANTED.buckets)
    return Detail(
        int(WANTED.buckets * scale) + more,
        min(int(WANTED.fine_samples * scale) + spare - 4 * more, MOST_FINE_SAMPLES, samples),
        int(WANTED.order_points * scale),
        int(WANTED.envelope_points * scale),
        max(int(WANTED.steps_per_tooth * scale), 4),
    )


LARGEST = 32_767
UNDEFINED = -32_768
MOST_EXACT = 2_000
"""Records whose indicators have all digits of 32-bit floats."""


def packed_steps(values: np.ndarray, step: float | None = None) -> dict[str, Any]:
    """Return values as whole multiples of a step: `{"step": step, "data": base 64 of int16}`.

    Parameters
    ----------
    values : (n,) float
        What is not finite becomes -32768, which the page reads as undefined.
    step : float, optional
        Default: the largest magnitude / 32767, so that the error is at most 1.6e-5 of it.
    """
    finite = np.isfinite(values)
    if step is None:
        step = float(np.abs(values[finite]).max(initial=0.0)) / LARGEST or 1.0
    counts = np.clip(np.round(np.where(finite, values, 0.0) / step), -LARGEST, LARGEST)
    whole = np.where(finite, counts, UNDEFINED).astype("<i2")
    return {"step": step, "data": base64.b64encode(whole.tobytes()).decode("ascii")}


def packed_floats(values: np.ndarray) -> str:
    """Return values (n,) as base 64 of 32-bit floats."""
    return base64.b64encode(np.ascontiguousarray(values, "<f4").tobytes()).decode("ascii")


def packed_column(values: np.ndarray) -> dict[str, str]:
    """Return a column of all records, kind and data: 32-bit floats, or of many records their upper 16 bits.

    Rounded to those a value errs by at most 0.4 %; a page of 10,000 records is half as large.
    """
    if values.size <= MOST_EXACT:
        return {"kind": "float", "data": packed_floats(values)}
    bits = np.ascontiguousarray(values, "<f4").view("<u4")
    upper = ((bits + np.uint32(0x8000)) >> np.uint32(16)).astype("<u2")
    return {"kind": "short", "data": base64.b64encode(upper.tobytes()).decode("ascii")}


def unpacked_column(packed: Mapping[str, Any]) -> np.ndarray:
    """Return what `packed_column` packed, (n,) float32."""
    data = base64.b64decode(packed["data"])
    if packed["kind"] == "float":
        return np.frombuffer(data, "<f4")
    return (np.frombuffer(data, "<u2").astype("<u4") << np.uint32(16)).view("<f4")


def packed_places(values: np.ndarray) -> dict[str, Any]:
    """Return ascending whole numbers (n,) as differences: `{"bits": 16 or 32, "data": base 64}`, the first from 0."""
    steps = np.diff(values, prepend=0)
    bits = 16 if steps.max(initial=0) <= np.iinfo(np.uint16).max else 32
    return {"bits": bits, "data": base64.b64encode(steps.astype(f"<u{bits // 8}").tobytes()).decode("ascii")}


MOST_NAMES = 65_535
"""Texts of a column, in 16 bits; a column of more is no choice of anything."""


def packed_labels(labels: Mapping[str, np.ndarray], titles: Mapping[str, str]) -> list[dict[str, Any]]:
    """Return name, title, kind and packed values of every column.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Numbers, texts, or objects of either with None where there is none.
    titles : mapping of str to str
        Of columns that are not shown by their own names.
    """
    return [{"name": name, "title": titles.get(name, name), **_packed(values)} for name, values in labels.items()]


def _packed(values: np.ndarray) -> dict[str, Any]:
    given = [value for value in values.tolist() if value is not None]
    if any(isinstance(value, str) for value in given):
        return _packed_texts(values.tolist())
    whole = len(given) == values.size and all(isinstance(value, int) for value in given)
    if whole and all(abs(value) < 2**31 for value in given):
        return {"kind": "whole", "data": _base64(np.asarray(given, "<i4"))}
    numbers = np.array([np.nan if value is None else float(value) for value in values.tolist()])
    return {"kind": "float", "data": _base64(numbers.astype("<f4"))}


def _packed_texts(values: list[Any]) -> dict[str, Any]:
    names = list(dict.fromkeys(str(value) for value in values if value is not None))
    code = {name: number for number, name in enumerate(names, start=1)}
    codes = np.array([0 if value is None else code[str(value)] for value in values], dtype="<u2")
    return {"kind": "text", "names": names, "data": _base64(codes)}


def _base64(values: np.ndarray) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")


def packed_rows(rows: Iterable[int | None]) -> str:
    """Return rows as base 64 of 32-bit numbers, -1 where there is none."""
    return _base64(np.array([-1 if row is None else row for row in rows], dtype="<i4"))


def further_labels(dataset: Dataset, shown: Iterable[str]) -> dict[str, np.ndarray]:
    """Return the label columns of a set with one number or text a record, of which two differ, besides those shown."""
    table, known = dataset.labels(), set(shown)
    signals = {channel.column for channel in dataset.channels}
    further = {}
    for name, column in zip(table.column_names, table.columns, strict=True):
        if name in known | signals or pa.types.is_nested(column.type):
            continue
        differing = len(column.unique())
        if differing > 1 and (differing <= MOST_NAMES or not pa.types.is_string(column.type)):
            further[name] = np.array([_plain(value) for value in column.to_pylist()], dtype=object)
    return further


def _plain(value: Any) -> Any:
    return str(value).lower() if isinstance(value, bool) else value


MESH_HARMONICS = 8.5
FLOOR = 1e-9

DECIBEL_STEP = 0.01


@dataclass(frozen=True, slots=True)
class Drawn:
    """Points of a signal to draw: sample numbers (n,), ascending, and values (n,)."""

    sample: np.ndarray
    value: np.ndarray


def extreme_points(signal: np.ndarray, buckets: int) -> Drawn:
    """Return the smallest and the largest sample of every bucket, at their own places.

    Parameters
    ----------
    signal : (n,) float
    buckets : int
        Number of equal stretches; a signal of at most twice as many samples comes back whole.
    """
    samples = signal.size
    if samples <= 2 * buckets:
        return Drawn(np.arange(samples), np.asarray(signal))
    edges = np.linspace(0, samples, buckets + 1).astype(np.int64)
    places = [
        low + place
        for low, high in pairwise(edges)
        for place in sorted((int(signal[low:high].argmin()), int(signal[low:high].argmax())))
    ]
    sample = np.unique(places)  # a bucket that does not vary has one extreme
    return Drawn(sample, np.asarray(signal)[sample])


def drawn_signal(signal: np.ndarray, buckets: int, fine: tuple[int, int]) -> Drawn:
    """Return extremes of a signal with every sample of one stretch.

    Parameters
    ----------
    signal : (n,) float
    buckets : int
        As of `extreme_points`.
    fine : (int, int)
        First sample of the stretch, and the one after its last.
    """
    sample = np.union1d(outside(extreme_points(signal, buckets).sample, fine), np.arange(*fine))
    return Drawn(sample, np.asarray(signal)[sample])


def outside(sample: np.ndarray, fine: tuple[int, int]) -> np.ndarray:
    """Return the sample numbers that do not lie in a stretch."""
    return np.asarray(sample[(sample < fine[0]) | (sample >= fine[1])])


@dataclass(frozen=True, slots=True)
class OrderAxis:
    """Points at orders 0, step, 2 step ...; each stands for the orders nearest to it."""

    step: float
    points: int

    def largest(self, amplitude: np.ndarray, revolutions: int) -> np.ndarray:
        """Return the largest amplitude about every point (points,); the nearest one where none lies there.

        Parameters
        ----------
        amplitude : (bins,) float64
            At orders 0, 1/revolutions ...; NaN beyond its end.
        revolutions : int
        """
        place = np.round(np.arange(amplitude.size) / (revolutions * self.step)).astype(np.int64)
        largest = np.full(self.points, -np.inf)
        inside = place < self.points
        np.maximum.at(largest, place[inside], amplitude[inside])
        empty = np.flatnonzero(np.isneginf(largest))
        nearest = np.round(empty * self.step * revolutions).astype(np.int64)
        largest[empty] = np.where(nearest < amplitude.size, amplitude[np.minimum(nearest, amplitude.size - 1)], np.nan)
        return largest


def order_axis(highest_order: float, revolutions: int, points: int) -> OrderAxis:
    """Return the axis up to an order: as fine as the longest record resolves, or as the points allow."""
    step = max(1.0 / max(revolutions, 1), highest_order / max(points - 1, 1))
    return OrderAxis(step, int(highest_order / step) + 1)


def highest_order(teeth: int, fs_hz: float, slowest_hz: float) -> float:
    """Return the last pinion order shown: 8.5 mesh harmonics, or the end of the band of the slowest record."""
    return min(MESH_HARMONICS * teeth, SAMPLES_PER_TOOTH * teeth / 2, fs_hz / 2.0 / slowest_hz)


def decibels(amplitude: np.ndarray) -> np.ndarray:
    """Return levels over one unit of the channel; what is below 1e-9 of it counts as that."""
    return np.asarray(20.0 * np.log10(np.maximum(amplitude, FLOOR)))


@dataclass(frozen=True, slots=True)
class PageAxes:
    """What all records of a page share: points, orders of spectra and of envelope spectra."""

    detail: Detail
    orders: OrderAxis
    envelope_orders: OrderAxis


def record_views(record: Recording, axes: PageAxes, start_rad: float | None) -> dict[str, Any]:
    """Return the views of a record: pulse times, and by channel what can be shown; `missing` says what cannot.

    Parameters
    ----------
    record : Recording
    axes : PageAxes
    start_rad : float, optional
        Pinion angle at the first sample over the hunting period, 0 where the pair of teeth 0 enters contact; without
        it the gear's teeth cannot be told apart.
    """
    grid, missing = _grid(record)
    return {
        "pulses": packed_floats(np.asarray(record.tacho_s)[np.isfinite(record.tacho_s)]),
        "missing": missing,
        "channels": {name: _channel(signal, record, grid, axes, start_rad) for name, signal in record.channels.items()},
    }


def _grid(record: Recording) -> tuple[AngleGrid | None, str]:
    try:
        return angle_grid(record.tacho_s, record.teeth[0] * SAMPLES_PER_TOOTH), ""
    except ValueError as error:
        return None, f"No orders, averages or envelope: {error}."


def _channel(
    signal: np.ndarray, record: Recording, grid: AngleGrid | None, axes: PageAxes, start_rad: float | None
) -> dict[str, Any]:
    finite = np.isfinite(signal)
    clean = np.where(finite, signal, 0.0)
    views: dict[str, Any] = {
        "wave": packed_wave(clean, axes.detail, _fine(record, axes.detail, clean.size)),
        "undefined": int(signal.size - np.count_nonzero(finite)),
    }
    return views if grid is None else views | _of_angle(clean, record, grid, axes, start_rad)


def packed_wave(signal: np.ndarray, detail: Detail, fine: tuple[int, int]) -> dict[str, Any]:
    """Return a signal (n,) packed: places of its extremes, the stretch that is kept whole, values of both in order."""
    drawn = drawn_signal(signal, detail.buckets, fine)
    return {"sample": packed_places(outside(drawn.sample, fine)), "fine": fine, **packed_steps(drawn.value)}


def _fine(record: Recording, detail: Detail, samples: int) -> tuple[int, int]:
    """Return the stretch that is kept whole: from the first pulse on, all of it where there is room."""
    if detail.fine_samples >= samples:
        return 0, samples
    first = int(np.ceil(record.tacho_s[0] * record.fs_hz)) if len(record.tacho_s) else 0
    first = min(max(first, 0), samples - detail.fine_samples)
    return first, first + detail.fine_samples


def _of_angle(
    signal: np.ndarray, record: Recording, grid: AngleGrid, axes: PageAxes, start_rad: float | None
) -> dict[str, Any]:
    from scipy import fft

    steps = resample_to_angle(signal, record.fs_hz, grid)
    teeth = record.teeth
    amplitude = 4.0 * np.abs(fft.rfft(steps * hann_weights(steps.size))) / steps.size
    envelope = envelope_spectrum(steps, grid.revolutions, teeth[0])
    spectrum = decibels(axes.orders.largest(amplitude, grid.revolutions))
    first = None if start_rad is None else first_gear_tooth(start_rad, teeth)
    wanted = axes.detail.steps_per_tooth
    return {
        "spectrum": packed_steps(spectrum, DECIBEL_STEP),
        "envelope": packed_steps(axes.envelope_orders.largest(envelope, grid.revolutions)),
        "averages": _of_members(signal, record, wanted)
        or [_average(steps, teeth[0], wanted, 0), _average(steps, teeth[1], wanted, first)],
    }


def _of_members(signal: np.ndarray, record: Recording, steps_per_tooth: int) -> list[dict[str, Any] | None]:
    """Return the averages of sun, planet and ring against the carrier; none of a gearbox that is no planetary set."""
    train = meshes_of(record.train)
    if train[0].planets is None:
        return []
    settings = IndicatorSettings()
    (set_of_planets,) = mesh_signals({"": signal}, np.asarray(record.tacho_s), record.fs_hz, train, settings)
    channel = set_of_planets.channels[""]
    return [
        _packed_average(channel.shaft(shaft.name).average, shaft.teeth, shaft.revolutions, steps_per_tooth, None)
        if shaft.revolutions
        else None
        for shaft in set_of_planets.shafts
    ]


def first_gear_tooth(start_rad: float, teeth: tuple[int, int]) -> int:
    """Return the gear tooth whose pair enters contact at the first pulse: pair n is gear tooth n mod z2. Derived."""
    return math.ceil(start_rad / (2.0 * math.pi)) * teeth[0] % teeth[1]


def _average(steps: np.ndarray, teeth: int, steps_per_tooth: int, first: int | None) -> dict[str, Any] | None:
    """Return an averaged revolution, exact up to the orders that its fewer steps carry; None for no whole revolution.

    It begins at tooth 0 where `first`, the tooth at the first pulse, is known; `numbered` says so.
    """
    turns = whole_revolutions(steps, teeth, SAMPLES_PER_TOOTH)
    if turns < 1:
        return None
    average = synchronous_average(steps, teeth, SAMPLES_PER_TOOTH).signal
    return _packed_average(average, teeth, turns, steps_per_tooth, first)


def _packed_average(
    average: np.ndarray, teeth: int, turns: int, steps_per_tooth: int, first: int | None
) -> dict[str, Any]:
    from scipy.signal import resample

    turned = np.roll(resample(average, teeth * steps_per_tooth), (first or 0) * steps_per_tooth)
    return {"turns": turns, "numbered": first is not None, **packed_steps(np.asarray(turned))}


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
    """Return signals, spectra, averages and damage by row.

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
        row: {**views[row], "damage": damage.get(number, []), "internals": inner}
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
    units = {RECORDED.unit, *(quantity.unit for quantity in held.values())}
    titles = {unit: indicator_titles(settings, unit, named) for unit in units}
    definitions, packed = indicator_definitions(settings, named), []
    for name, column in zip(names, values.T, strict=True):
        base, _, channel = name.rpartition("__") if name not in own else (name, "", "")
        if np.isfinite(column).any():
            facts: dict[str, Any] = {
                "title": titles[held.get(channel, RECORDED).unit].get(base, name),
                "definition": definitions.get(base, "your own indicator"),
            }
            packed.append({"name": name, "channel": channel, **facts, **packed_column(column)})
    return packed
