"""Files of recorders, which state rate and unit: HDF5, TDMS and universal files.

HDF5 files: every vector or matrix of numbers; rate and unit from its attributes, or those of what it lies in.

TDMS files of LabVIEW: scaled values of all channels of numbers; step and unit from the channels' properties.

Universal files (.uff, .unv): time records of type 58, as text or binary; step and unit from their headers.

Columns of formats that state rate, unit and name of every signal in the file itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from diagnostics.base.extras import require_packages
from diagnostics.recordings.recorded_columns import Columns, numbered
from siggen.errors import UsageError

TYPE, TIME_RESPONSE, REAL, EVEN = 58, 1, (2, 4), 1
INCREMENT_DIGITS = 6
"""Of the step in type 58, which is written as E13.5."""
UNEVEN_STEP = 1e-3
"""Largest deviation from even steps; uneven files keep their times with six digits."""

RATES = ("fs", "sampling_rate", "sample_rate", "sampling_frequency", "sample_frequency")
INCREMENTS = ("dt", "sampling_interval", "sample_interval", "wf_increment")
UNITS = ("unit", "units")


class StatedSignal(NamedTuple):
    """One signal: its possible names, the shortest first; values (n,); rate [Hz] and unit where stated."""

    names: tuple[str, ...]
    values: np.ndarray
    fs_hz: float | None = None
    unit: str | None = None


def stated_columns(signals: Sequence[StatedSignal]) -> Columns:
    """Return the signals of the highest stated rate, and those without one, under the shortest names that differ.

    A recorder that samples a temperature slowly beside the vibration writes several rates into one file. One recording
    has one rate, so slower signals are left out.
    """
    rates = [signal.fs_hz for signal in signals if signal.fs_hz]
    highest = max(rates, default=None)
    kept = [s for s in signals if not s.fs_hz or highest is None or math.isclose(s.fs_hz, highest, rel_tol=1e-9)]
    names = _names([signal.names for signal in kept])
    values = {name: signal.values for name, signal in zip(names, kept, strict=True)}
    units = {name: signal.unit for name, signal in zip(names, kept, strict=True) if signal.unit}
    return Columns(values, highest, units=units)


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
            signals.append(StatedSignal(names, values.astype(np.float64), rate_hz, str(unit) if unit else None))
    return stated_columns(signals)


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
    found = [file.read_sets(place) for place in places]
    times = [one for one in found if one["func_type"] == TIME_RESPONSE and one["ord_data_type"] in REAL]
    if not times:
        raise UsageError(
            f"{path}: holds no time record: {len(found)} data sets of type 58, none of them function type 1 with real "
            "values; export the time signals"
        )
    return stated_columns([_signal(path, one) for one in times])


def _signal(path: Path, found: dict[str, Any]) -> StatedSignal:
    values = np.asarray(found["data"], dtype=np.float64)
    if values.size != found["num_pts"]:
        raise UsageError(f"{path}: a record states {found['num_pts']} values and holds {values.size}; export it again")
    first = found["id1"].strip()
    place = f"{found['rsp_node']}:{found['rsp_dir']}"
    unit = found["ordinate_axis_units_lab"].strip()
    names = ("" if first.upper() == "NONE" else first, place)
    return StatedSignal(names, values, _rate_hz(path, found), None if unit.upper() == "NONE" else unit)


def _rate_hz(path: Path, found: dict[str, Any]) -> float | None:
    if found["abscissa_spacing"] == EVEN:
        return rate_from_increment(found["abscissa_inc"], INCREMENT_DIGITS)
    steps = np.diff(np.asarray(found["x"], dtype=np.float64))
    mean = float(steps.mean()) if steps.size else math.nan
    if not mean > 0.0 or np.abs(steps - mean).max() > UNEVEN_STEP * mean:
        raise UsageError(f"{path}: a record has uneven steps of time; resample it to one rate")
    return rate_from_increment(mean)


def read_hdf5(path: Path) -> Columns:
    """Read the vectors and matrices of numbers, called as there, with their groups before them where names repeat.

    Attributes are looked for at the data, then at its groups, then at the file: a rate as one of `RATES` (also with
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
        for data in held:
            own = not data.is_virtual and not data.external
            if own and data.dtype.kind in "biuf" and data.ndim in (1, 2) and data.size > 1:
                signals += _signals(data)
    return stated_columns(signals)


def _signals(data: Any) -> list[StatedSignal]:
    stated: dict[str, Any] = {}
    place = data
    while True:
        stated = {name.lower(): value for name, value in place.attrs.items()} | stated
        if place.name == "/":
            break
        place = place.parent
    long = data.name.lstrip("/")
    short = numbered(data[()], long.rpartition("/")[2])
    whole = numbered(data[()], long)
    rate_hz, unit = _stated_rate_hz(stated), _unit(stated)
    return [
        StatedSignal((name, path), values, rate_hz, unit)
        for (name, values), path in zip(short.items(), whole, strict=True)
    ]


def _stated_rate_hz(stated: dict[str, Any]) -> float | None:
    for name in RATES:
        number = _number(stated.get(name, stated.get(f"{name}_hz")))
        if number is not None and np.isfinite(number) and number > 0.0:
            return number
    steps = (rate_from_increment(_number(stated.get(name, stated.get(f"{name}_s")))) for name in INCREMENTS)
    return next((rate_hz for rate_hz in steps if rate_hz), None)


def _number(value: Any) -> float | None:
    array = np.asarray(value)
    return float(array.reshape(-1)[0]) if array.size == 1 and array.dtype.kind in "iuf" else None


def _unit(stated: dict[str, Any]) -> str | None:
    found = next((stated[name] for name in UNITS if name in stated), None)
    text = found.decode("utf-8", "replace") if isinstance(found, bytes) else found
    return text if isinstance(text, str) else None
