"""The page of a machine beside its simulation: recordings and the records of a set in one table, over each other.

Recordings of a machine and the records of a simulated set as one source: his machine beside its simulation.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.base.progress import Stage, silent_stage
from diagnostics.explore.look import RECORDS_WORDS, look_of, look_page
from diagnostics.explore.measured_page import ShownRecording, missing_sentences, recordings_source
from diagnostics.explore.payload import PageSource, RecordList, packed_column, unpacked_column
from diagnostics.explore.set_page import LookOptions, set_name
from diagnostics.explore.set_source import chosen_records, missing_parts, set_source
from diagnostics.indicators.table import record_table
from diagnostics.page.template import write_page
from diagnostics.recordings.in_rig import in_rig
from diagnostics.records.recording import Recording
from diagnostics.records.state_classes import HEALTHY
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

RECORDING, SIMULATED = "recording", "simulated"

COLUMNS = (
    *(("record_id", "Record"), ("kind", "Kind"), ("state", "State or verdict"), ("name", "File")),
    *(("damaged_area_mm2", "Area [mm²]"), ("speed_hz", "Speed [Hz]"), ("torque_nm", "Load [N m]")),
    ("specimen_id", "Gearbox"),
)
FILTERS = (("kind", "Kind"), ("state", "State or verdict"), ("specimen_id", "Gearbox"))


def beside_source(measured: PageSource, simulated: PageSource) -> PageSource:
    """Return recordings, then the records of a set; each is also laid over the nearest in speed of the other side.

    Recordings get the channels' names of the set, by name or else in their order, and numbers behind those of its
    records.

    Parameters
    ----------
    measured, simulated : PageSource

    Raises
    ------
    UsageError
        If rates, teeth or numbers of channels differ: nothing could be laid over anything.
    """
    named = channel_mapping(measured, simulated)
    _check_alike(measured, simulated)
    ours, theirs = measured.labels["record_id"].size, simulated.labels["record_id"].size
    first = int(simulated.labels["record_id"].max()) + 1
    numbers = {int(number): first + k for k, number in enumerate(measured.labels["record_id"])}
    labels = _labels(measured, simulated, first)
    return PageSource(
        labels=labels,
        overlay=[*measured.overlay, *(None if other is None else ours + other for other in simulated.overlay)],
        kept=np.concatenate([np.arange(ours), ours + simulated.kept]),
        records=lambda wanted: itertools.chain(
            _renamed(measured, named, numbers), simulated.records(wanted[wanted < first])
        ),
        channels=simulated.channels,
        fs_hz=simulated.fs_hz,
        duration_s=max(measured.duration_s, simulated.duration_s),
        indicators=_indicators(measured, simulated, named),
        teeth=simulated.teeth,
        named=simulated.named,
        damage=simulated.damage,
        quantities=simulated.quantities,
        held=simulated.held,
        internals=lambda wanted, detail, fine: [
            *({} for _ in range(ours)),
            *simulated.internals(wanted[ours:], detail, fine[ours:]),
        ],
        beside=nearest_of_the_others(labels, ours, theirs),
    )


def channel_mapping(measured: PageSource, simulated: PageSource) -> dict[str, str]:
    """Return the set's channel for every channel of the recordings: the same name, or the same place.

    Raises
    ------
    UsageError
        If there are more channels on one side.
    """
    if set(measured.channels) == set(simulated.channels):
        return {name: name for name in measured.channels}
    if len(measured.channels) != len(simulated.channels):
        raise UsageError(
            f"set beside: recordings have the channels {', '.join(measured.channels)}, the set "
            f"{', '.join(simulated.channels)}; allowed: as many on both sides. Choose: "
            f"{in_rig('channels: {NAME: COLUMN}')}"
        )
    return dict(zip(measured.channels, simulated.channels, strict=True))


def _check_alike(measured: PageSource, simulated: PageSource) -> None:
    rates = measured.fs_hz, simulated.fs_hz
    if abs(rates[0] / rates[1] - 1.0) > 1e-6:
        raise UsageError(
            f"set beside: recordings have {rates[0]:g} Hz, the set {rates[1]:g} Hz; allowed: one rate. Generate the "
            f"set again: siggen generate CONFIG --set fs_hz={rates[0]:g}"
        )
    teeth = [
        set(zip(*(side.labels[name].tolist() for name in side.teeth), strict=True)) for side in (measured, simulated)
    ]
    if not teeth[0] <= teeth[1]:
        said = [", ".join(":".join(map(str, pair)) for pair in sorted(side)) for side in teeth]
        raise UsageError(f"set beside: recordings are of {said[0]} teeth, the set of {said[1]}; allowed: the same")


def _labels(measured: PageSource, simulated: PageSource, first: int) -> dict[str, np.ndarray]:
    """Return the labels of both; what a recording does not have is None."""
    ours, theirs = measured.labels["record_id"].size, simulated.labels["record_id"].size
    known: dict[str, Any] = {
        **measured.labels,
        **dict(zip(simulated.teeth, (measured.labels[name] for name in measured.teeth), strict=True)),
        "record_id": range(first, first + ours),
        "specimen_id": [None] * ours,
        "operating_point_id": [None] * ours,
        "damaged_area_mm2": [None] * ours,
        "split": [RECORDING] * ours,
        "kind": [RECORDING] * ours,
    }
    other: dict[str, Any] = {**simulated.labels, "kind": [SIMULATED] * theirs, "name": [""] * theirs}
    labels = {}
    for name, values in other.items():
        both = np.empty(ours + theirs, dtype=object)
        both[:ours], both[ours:] = list(known.get(name, [None] * ours)), list(values)
        labels[name] = both
    return labels


def nearest_of_the_others(labels: Mapping[str, np.ndarray], ours: int, theirs: int) -> list[int | None]:
    """Return for every record the healthy one nearest in speed of the other side; any where none is healthy."""
    speed = labels["speed_hz"].astype(np.float64)
    healthy = labels["fault"] == HEALTHY
    sides = np.arange(ours), np.arange(ours, ours + theirs)
    nearest: list[int | None] = []
    for row in range(ours + theirs):
        others = sides[1] if row < ours else sides[0]
        rows = others[healthy[others]] if healthy[others].any() else others
        nearest.append(int(rows[np.abs(speed[rows] - speed[row]).argmin()]) if rows.size else None)
    return nearest


def _renamed(measured: PageSource, named: Mapping[str, str], numbers: Mapping[int, int]) -> Iterator[Recording]:
    for record in measured.records(measured.labels["record_id"]):
        channels = {named[name]: signal for name, signal in record.channels.items()}
        yield replace(
            record, channels=channels, labels={**record.labels, "record_id": numbers[int(record.labels["record_id"])]}
        )


def _indicators(measured: PageSource, simulated: PageSource, named: Mapping[str, str]) -> list[dict[str, Any]]:
    """Return the indicators of the set, with the values of recordings before them."""
    ours = measured.labels["record_id"].size
    values = {_renamed_column(one["name"], one["channel"], named): unpacked_column(one) for one in measured.indicators}
    none = np.full(ours, np.nan)
    return [
        {**one, **packed_column(np.concatenate([values.get(one["name"], none), unpacked_column(one)]))}
        for one in simulated.indicators
    ]


def _renamed_column(name: str, channel: str, named: Mapping[str, str]) -> str:
    return f"{name.removesuffix(f'__{channel}')}__{named[channel]}" if channel in named else name


def write_beside_page(
    name: str,
    shown: Sequence[ShownRecording],
    dataset: Dataset,
    path: Path,
    options: LookOptions | None = None,
    stage: Stage = silent_stage,
) -> Path:
    """Write the page of recordings beside a set and return its path.

    Parameters
    ----------
    name : str
        Of the machine.
    shown : sequence of ShownRecording
        At least one.
    dataset : siggen Dataset
        The simulated set.
    path : Path
        The HTML file.
    options : LookOptions, optional
        Limit (of simulated records), detail, workers.
    stage : Stage
        Told of every record.

    Raises
    ------
    UsageError
        If recordings and set differ in rate, teeth or number of channels.
    """
    chosen = options or LookOptions()
    measured = recordings_source(shown)
    labels = dataset.labels(columns=["record_id", "specimen_id"])
    with stage("indicators", labels.num_rows) as advance:
        table = record_table(dataset, own=chosen.own, workers=chosen.workers, advance=advance)
    kept = chosen_records({"specimen_id": np.asarray(labels.column("specimen_id"))}, chosen.limit)
    simulated = set_source(dataset, table, kept)
    said = RecordList(COLUMNS, FILTERS, _missing(shown, measured, simulated))
    look = look_of(beside_source(measured, simulated), said, stage, full=chosen.full)
    write_page(path, look_page(f"Recordings of {name} beside {set_name(dataset)}", look))
    return path


def _missing(shown: Sequence[ShownRecording], measured: PageSource, simulated: PageSource) -> list[str]:
    """Return which channel is taken for which, and what either side does not give."""
    named = {ours: theirs for ours, theirs in channel_mapping(measured, simulated).items() if ours != theirs}
    taken = [RECORDS_WORDS.taken_for(*names) for names in named.items()]
    labels = {name: simulated.labels[name] for name in ("fault", "specimen_id")}
    damaged = bool((labels["fault"] != HEALTHY).any())
    of_the_set = missing_parts(labels, simulated.overlay, damaged, bool(simulated.quantities), named=True)
    return [*taken, *missing_sentences(sum(recording.healthy for recording in shown)), *of_the_set]
