"""HDF5 files: every vector or matrix of numbers; rate and unit from its attributes, or those of what it lies in."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.base.extras import require_packages
from diagnostics.recordings.recorded_columns import Columns, numbered
from diagnostics.recordings.stated_signals import StatedSignal, rate_from_increment, stated_columns

RATES = ("fs", "sampling_rate", "sample_rate", "sampling_frequency", "sample_frequency")
INCREMENTS = ("dt", "sampling_interval", "sample_interval", "wf_increment")
UNITS = ("unit", "units")


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
    rate_hz, unit = _rate_hz(stated), _unit(stated)
    return [
        StatedSignal((name, path), values, rate_hz, unit)
        for (name, values), path in zip(short.items(), whole, strict=True)
    ]


def _rate_hz(stated: dict[str, Any]) -> float | None:
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
