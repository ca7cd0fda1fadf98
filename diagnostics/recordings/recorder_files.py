"""Files of recorders, which state rate and unit: HDF5, TDMS, universal files and MDF.

HDF5 files: every vector or matrix of numbers; rate and unit from its attributes, or those of what it lies in.

TDMS files of LabVIEW: scaled values of all channels of numbers; step and unit from the channels' properties.

Universal files (.uff, .unv): time records of type 58, as text or binary; step and unit from their headers.

Columns of formats that state rate, unit and name of every signal in the file itself.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from diagnostics.base.extras import require_packages
from diagnostics.recordings.recorded_columns import Columns, numbered
from diagnostics.recordings.sample_times import OFF_STEPS
from siggen.errors import UsageError

TYPE, TIME_RESPONSE, REAL, EVEN = 58, 1, (2, 4), 1
INCREMENT_DIGITS = 6
"""Of the step in type 58, which is written as E13.5."""
UNEVEN_STEP = 1e-3
"""Largest deviation from even steps; uneven files keep their times with six digits."""

RATES = (
    *("fs", "sr", "sampling_rate", "sample_rate", "sampling_frequency", "sample_frequency"),
    *("samplerate", "samplingrate", "fsample", "sampling_freq"),
)
INCREMENTS = ("dt", "sampling_interval", "sample_interval", "wf_increment")
UNITS = ("unit", "units")


class StatedSignal(NamedTuple):
    """One signal: its possible names, the shortest first; values (n,); rate [Hz] and unit where stated; its start."""

    names: tuple[str, ...]
    values: np.ndarray
    fs_hz: float | None = None
    unit: str | None = None
    start_s: float = 0.0


def stated_columns(signals: Sequence[StatedSignal], kind: str, *, full_scale: bool = False) -> Columns:
    """Return the signals of the highest stated rate, and those without one, under the shortest names that differ.

    A recorder that samples a temperature slowly beside the vibration writes several rates into one file. One recording
    has one rate, so slower signals are left out.
    """
    rates = [signal.fs_hz for signal in signals if signal.fs_hz]
    highest = max(rates, default=None)
    kept = [s for s in signals if not s.fs_hz or highest is None or math.isclose(s.fs_hz, highest, rel_tol=1e-9)]
    names = _names([signal.names for signal in kept])
    notes = [
        f"{signal.names[0]} at {signal.fs_hz:g} Hz left out: a recording has one rate, here {highest:g} Hz"
        for signal in signals
        if not any(signal is one for one in kept)
    ]
    cut, said = _common_span(kept, names, highest)
    values = dict(zip(names, cut, strict=True))
    units = {name: signal.unit for name, signal in zip(names, kept, strict=True) if signal.unit}
    return Columns(values, highest, full_scale, units=units, layout={"format": kind}, notes=(*notes, *said))


def _common_span(
    kept: Sequence[StatedSignal], names: Sequence[str], fs_hz: float | None
) -> tuple[list[np.ndarray], list[str]]:
    """Return the signals from where all have begun to where the first ends, where their starts differ, and say so."""
    starts = np.array([signal.start_s for signal in kept])
    if fs_hz is None or not kept or np.ptp(starts) * fs_hz < 0.5:
        return [signal.values for signal in kept], []
    skip = np.rint((starts.max() - starts) * fs_hz).astype(int)
    left = min(signal.values.size - int(k) for signal, k in zip(kept, skip, strict=True))
    if left < 2:
        raise UsageError(
            f"channels do not overlap: their starts lie {np.ptp(starts):.6g} s apart; record them together"
        )
    notes = [
        f"{name} begins {start - starts.min():.6g} s later than the first: all cut to the common span"
        for name, start in zip(names, starts.tolist(), strict=True)
        if (start - starts.min()) * fs_hz >= 0.5
    ]
    return [signal.values[k : k + left] for signal, k in zip(kept, skip.tolist(), strict=True)], notes


def rate_from_increment(increment_s: object, digits: int = 15) -> float | None:
    """Return the rate [Hz] of a time step [s]; None if it is no step.

    Parameters
    ----------
    increment_s : object
        What the file holds.
    digits : int
        Decimal digits that the format keeps of the step. A whole number of hertz whose step has the same digits is
        taken, since recorders have such rates: type 58 keeps 1/51200 s as 1.95313e-05.
    """
    step = float(increment_s) if isinstance(increment_s, (int, float, np.number)) else math.nan
    if not (math.isfinite(step) and 0.0 < step < 1e6 and 1.0 / step < 1e12):
        return None
    whole = round(1.0 / step)
    same = whole > 0 and f"{1.0 / whole:.{digits - 1}e}" == f"{step:.{digits - 1}e}"
    return float(whole) if same else 1.0 / step


def _names(known: list[tuple[str, ...]]) -> list[str]:
    for level in range(min((len(names) for names in known), default=0)):
        chosen = [names[level] for names in known]
        if len(set(chosen)) == len(chosen) and all(chosen):
            return chosen
    return [str(number) for number in range(1, len(known) + 1)]


def read_tdms(path: Path) -> Columns:
    """Read the channels of a TDMS file, called as there, with their group before them where names repeat.

    Raises
    ------
    UsageError
        If npTDMS is missing, or the last segment is incomplete.
    """
    require_packages(f"{path}: reading TDMS", "nptdms")
    from nptdms import TdmsFile

    file = TdmsFile.read(path)
    if file.file_status.incomplete_final_segment:
        raise UsageError(f"{path}: ends early: its last segment is incomplete. Copy the file again, or save it again.")
    signals = []
    for channel in (channel for group in file.groups() for channel in group.channels()):
        values = channel[:]
        if values.dtype.kind in "biuf" and values.size > 1:
            rate_hz = rate_from_increment(channel.properties.get("wf_increment"))
            unit = channel.properties.get("unit_string") or channel.properties.get("NI_UnitDescription")
            names = (channel.name, f"{channel.group_name}/{channel.name}")
            start_s = _start_s(channel.properties)
            signals.append(
                StatedSignal(names, values.astype(np.float64), rate_hz, str(unit) if unit else None, start_s)
            )
    earliest = min((signal.start_s for signal in signals), default=0.0)
    return stated_columns([one._replace(start_s=one.start_s - earliest) for one in signals], "TDMS")


def _start_s(properties: Mapping[str, Any]) -> float:
    """Return when a channel begins [s]: its start time, and its offset from that."""
    offset = properties.get("wf_start_offset", 0.0)
    start = properties.get("wf_start_time")
    ticks = start.astype("datetime64[ns]").astype(np.int64) if isinstance(start, np.datetime64) else 0
    # whole seconds of all times since 1970 have few digits behind the point: ten minutes of a day are kept exactly
    seconds = float(int(ticks) % 86_400_000_000_000) * 1e-9
    return seconds + (float(offset) if isinstance(offset, (int, float)) else 0.0)


def read_universal(path: Path) -> Columns:
    """Read the time records, called by their first line, or else by node and direction.

    Raises
    ------
    UsageError
        If pyuff is missing, the file ends early, or holds no time record, or one with uneven steps.
    """
    require_packages(f"{path}: reading universal files", "pyuff")
    import pyuff

    if not path.read_bytes().rstrip().endswith(b"    -1"):
        raise UsageError(f"{path}: ends early: the last line of a universal file is -1. Copy or export it again.")
    file = pyuff.UFF(str(path))
    places = [place for place, kind in enumerate(file.get_set_types()) if kind == TYPE]
    records = [file.read_sets(place) for place in places]
    times = [record for record in records if record["func_type"] == TIME_RESPONSE and record["ord_data_type"] in REAL]
    if not times:
        raise UsageError(
            f"{path}: holds no time record: {len(records)} data sets of type 58, none of them function type 1 with "
            "real values; export the time signals"
        )
    return stated_columns([_signal(path, record) for record in times], "UFF 58")


def _signal(path: Path, record: dict[str, Any]) -> StatedSignal:
    values = np.asarray(record["data"], dtype=np.float64)
    if values.size != record["num_pts"]:
        raise UsageError(f"{path}: a record states {record['num_pts']} values and holds {values.size}; export it again")
    first = record["id1"].strip()
    place = f"{record['rsp_node']}:{record['rsp_dir']}"
    unit = record["ordinate_axis_units_lab"].strip()
    names = ("" if first.upper() == "NONE" else first, place)
    return StatedSignal(names, values, _rate_hz(path, record), None if unit.upper() == "NONE" else unit)


def _rate_hz(path: Path, record: dict[str, Any]) -> float | None:
    if record["abscissa_spacing"] == EVEN:
        return rate_from_increment(record["abscissa_inc"], INCREMENT_DIGITS)
    steps = np.diff(np.asarray(record["x"], dtype=np.float64))
    mean = float(steps.mean()) if steps.size else math.nan
    if not mean > 0.0 or np.abs(steps - mean).max() > UNEVEN_STEP * mean:
        raise UsageError(f"{path}: a record has uneven steps of time; resample it to one rate")
    return rate_from_increment(mean)


def read_hdf5(path: Path) -> Columns:
    """Read the vectors and matrices of numbers, called as there, with their groups before them where names repeat.

    In files of MATLAB single numbers count as attributes. These
    are looked for at the data, then at its groups, then at the file: a rate as one of `RATES` (also with
    `_hz` after it), or a step as one of `INCREMENTS` (also with `_s`), and a unit as one of `UNITS`. Data that lies in
    other files is passed over, so that a file cannot make others be read.

    Raises
    ------
    UsageError
        If h5py is missing.
    """
    require_packages(f"{path}: reading HDF5", "h5py")
    import h5py

    signals: list[StatedSignal] = []
    with h5py.File(path, "r") as file:
        held: list[Any] = []
        file.visititems(lambda _, item: held.append(item) if isinstance(item, h5py.Dataset) else None)
        about = _scalars(held)
        for data in held:
            if data.name.startswith("/#") or data.attrs.get("MATLAB_class") in (b"char", b"cell", b"function_handle"):
                continue
            is_stored_here = not data.is_virtual and not data.external
            if is_stored_here and data.dtype.kind in "biuf" and data.ndim in (1, 2) and data.size > 1:
                signals += _signals(data, about)
    return stated_columns(signals, "HDF5")


def _scalars(held: Sequence[Any]) -> dict[str, dict[str, float]]:
    """Return single numbers by the group they lie in, as MAT files of version 7.3 hold rates."""
    scalars: dict[str, dict[str, float]] = {}
    for data in held:
        if not data.is_virtual and not data.external and data.size == 1 and data.dtype.kind in "iuf":
            scalars.setdefault(data.parent.name, {})[data.name.rpartition("/")[2].lower()] = _number(data[()]) or 0.0
    return scalars


def _signals(data: Any, about: Mapping[str, Mapping[str, float]]) -> list[StatedSignal]:
    stated: dict[str, Any] = {}
    place = data
    while True:
        stated = {**about.get(place.name, {}), **{name.lower(): value for name, value in place.attrs.items()}} | stated
        if place.name == "/":
            break
        place = place.parent
    long = data.name.lstrip("/")
    short = numbered(data[()], long.rpartition("/")[2])
    whole = numbered(data[()], long)
    rate_hz, unit = stated_rate_hz(stated), _unit(stated)
    return [
        StatedSignal((name, path), values, rate_hz, unit)
        for (name, values), path in zip(short.items(), whole, strict=True)
    ]


def stated_rate_hz(stated: Mapping[str, Any]) -> float | None:
    """Return the rate [Hz] that facts by lower-case names state: one of `RATES`, else a step of `INCREMENTS`."""
    for name in (*RATES, *INCREMENTS):
        for key in (name, f"{name}_hz", f"{name}_s"):
            number = _number(stated.get(key))
            if number is not None and math.isfinite(number) and number > 0.0:
                return number if name in RATES else rate_from_increment(number)
    return None


def _number(value: Any) -> float | None:
    array = np.asarray(value)
    return float(array.reshape(-1)[0]) if array.size == 1 and array.dtype.kind in "iuf" else None


def _unit(stated: dict[str, Any]) -> str | None:
    unit = next((stated[name] for name in UNITS if name in stated), None)
    text = unit.decode("utf-8", "replace") if isinstance(unit, bytes) else unit
    return text if isinstance(text, str) else None


def read_mdf(path: Path) -> Columns:
    """Read the channels of numbers of the groups with the highest rate.

    Raises
    ------
    UsageError
        If asammdf is missing, or groups of one rate have uneven times that differ.
    """
    require_packages(f"{path}: reading MDF", "asammdf")
    from asammdf import MDF

    signals: list[StatedSignal] = []
    times: list[np.ndarray] = []
    with MDF(path) as file:
        for index, group in enumerate(file.groups):
            masters = {file.masters_db.get(index)}
            for number, channel in enumerate(group.channels):
                if number in masters:
                    continue
                found = file.get(group=index, index=number)
                stamps = np.asarray(found.timestamps, dtype=np.float64)
                if found.samples.ndim != 1 or found.samples.dtype.kind not in "biuf" or found.samples.size < 2:
                    continue
                span = float(stamps[-1] - stamps[0])
                rate = rate_from_increment(span / (stamps.size - 1))
                names = (channel.name, f"{index}/{channel.name}")
                values = found.samples.astype(np.float64)
                signals.append(StatedSignal(names, values, rate, str(found.unit) or None, float(stamps[0])))
                times.append(stamps)
    highest = max((one.fs_hz for one in signals if one.fs_hz), default=0.0)
    kept = [k for k, one in enumerate(signals) if one.fs_hz and math.isclose(one.fs_hz, highest, rel_tol=1e-6)]
    if not kept:
        raise UsageError(f"{path}: holds no channel of numbers over time")
    first = times[kept[0]]
    if all(np.array_equal(times[k], first) for k in kept):
        # even or not: the times are judged as those of any other file
        found = stated_columns([signals[k]._replace(fs_hz=None, start_s=0.0) for k in kept], "MDF")
        left = [f"{one.names[0]} left out: at another rate" for k, one in enumerate(signals) if k not in kept]
        units = {**found.units, "time": "s"}
        return replace(found, values={"time": first, **found.values}, units=units, notes=(*found.notes, *left))
    for k in kept:
        steps = np.diff(times[k])
        if np.abs(steps - steps.mean()).max() > OFF_STEPS * steps.mean():
            raise UsageError(f"{path}: groups of one rate have uneven times that differ; export them on one time")
    alike = [one._replace(fs_hz=highest) if k in kept else one for k, one in enumerate(signals)]
    return stated_columns(alike, "MDF")
