"""Universal files (.uff, .unv): time records of type 58, as text or binary; step and unit from their headers."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.base.extras import require_packages
from diagnostics.recordings.recorded_columns import Columns
from diagnostics.recordings.stated_signals import StatedSignal, rate_from_increment, stated_columns
from siggen.errors import UsageError

TYPE, TIME_RESPONSE, REAL, EVEN = 58, 1, (2, 4), 1
INCREMENT_DIGITS = 6
"""Of the step in type 58, which is written as E13.5."""
UNEVEN_STEP = 1e-3
"""Largest deviation from even steps; uneven files keep their times with six digits."""


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
