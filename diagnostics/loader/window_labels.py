"""Labels of windows on request: any number of the set's labels, the damaged tooth, its outline, and the shaft's angle.

A tacho pulse passes where the pair of tooth 0 enters contact, so pulses alone tell angles. Source: the convention of
`siggen` (angle 0: tooth 0 enters contact), the rest derived.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pyarrow as pa

from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

TEETH = {"tooth_pinion": "faulty_teeth_pinion", "tooth_gear": "faulty_teeth_gear"}
"""Lowest index of the damaged teeth, -1 where there is none."""

OUTLINE = "outline_mm"
ANGLES = ("start_angle_rad", "tooth_0_entry_sample")
OWN = (*TEETH, OUTLINE, *ANGLES)


def record_labels(dataset: Dataset, split: str, names: Sequence[str]) -> dict[str, np.ndarray]:
    """Return labels of the records of a split, (records, ...) each.

    Parameters
    ----------
    dataset : siggen Dataset
        The set.
    split : str
        Its split.
    names : sequence of str
        Numbers among the set's labels (`speed_hz`, `torque_nm`, `damaged_area_share` ...) as float64 or int64;
        `tooth_pinion`, `tooth_gear`: lowest index of the damaged teeth, -1 for none; `outline_mm`: the box round all
        damage of that tooth, (4,): from and to across the face, from and to in height [mm], NaN without damage.

    Raises
    ------
    UsageError
        If a name is none of these.
    """
    return {name: _label(dataset, split, name) for name in names if name not in ANGLES}


def _label(dataset: Dataset, split: str, name: str) -> np.ndarray:
    if name in TEETH:
        return _lowest_teeth(dataset, split, TEETH[name])
    if name == OUTLINE:
        return _outlines(dataset, split)
    schema = dataset.labels(split).schema
    numbers = [field.name for field in schema if pa.types.is_integer(field.type) or pa.types.is_floating(field.type)]
    if name not in numbers:
        raise UsageError(f"labels: received {name!r}; allowed are {', '.join((*OWN, *numbers))}")
    kind = np.int64 if pa.types.is_integer(schema.field(name).type) else np.float64
    column = dataset.labels(split, [name]).column(name)
    return np.asarray(column.to_numpy(zero_copy_only=False)).astype(kind)


def _lowest_teeth(dataset: Dataset, split: str, column: str) -> np.ndarray:
    rows = dataset.labels(split, [column]).column(column).to_pylist()
    return np.array([min(row) if row else -1 for row in rows], dtype=np.int64)


def _outlines(dataset: Dataset, split: str) -> np.ndarray:
    """Return the box round all damage of the lowest damaged tooth, the pinion's first, (records, 4) float64."""
    place = {number: k for k, number in enumerate(dataset.labels(split, ["record_id"]).column("record_id").to_pylist())}
    pinion, gear = (_lowest_teeth(dataset, split, column) for column in TEETH.values())
    found = np.tile([np.inf, -np.inf, np.inf, -np.inf], (len(place), 1))
    for row in dataset.damage(split).to_pylist():
        k = place[row["record_id"]]
        tooth = ("pinion", int(pinion[k])) if pinion[k] >= 0 else ("gear", int(gear[k]))
        if (row["gear"], row["tooth"]) == tooth:
            face, height = row["semi_axis_face_mm"], row["semi_axis_profile_mm"]
            box = (row["face_mm"] - face, row["face_mm"] + face, row["height_mm"] - height, row["height_mm"] + height)
            found[k, ::2] = np.minimum(found[k, ::2], box[::2])
            found[k, 1::2] = np.maximum(found[k, 1::2], box[1::2])
    return np.where(np.isfinite(found), found, np.nan)


def window_angles(
    pulses: np.ndarray, turn: int, start: int, fs_hz: float, samples_per_revolution: int | None
) -> tuple[float, float]:
    """Return the pinion's angle at a window's first sample, 0 to 2 pi, and the sample at which tooth 0 next enters.

    Parameters
    ----------
    pulses : (k,) float64
        Pulse times of the record [s].
    turn : int
        Pulse at or before the start of the window.
    start : int
        First sample of the window in the record, as taken.
    fs_hz : float
        Sampling rate [Hz].
    samples_per_revolution : int or None
        Where windows are resampled to angle they start on a pulse: both values are 0.
    """
    if samples_per_revolution is not None:
        return 0.0, 0.0
    time_s = start / fs_hz
    share = (time_s - pulses[turn]) / (pulses[turn + 1] - pulses[turn])
    entry_s = pulses[turn] if time_s <= pulses[turn] else pulses[turn + 1]
    return float(2.0 * np.pi * (share % 1.0)), float((entry_s - time_s) * fs_hz)
