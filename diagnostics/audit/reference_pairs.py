"""For every record a healthy record of the same specimen at the same operating point, and which records are alike."""

from __future__ import annotations

import numpy as np

from diagnostics.audit.measured_set import MeasuredSet

TORQUE_TOLERANCE = 0.01
SPEED_TOLERANCE = 0.002


def reference_records(measured: MeasuredSet) -> np.ndarray:
    """Return the row of the reference of every record, (records,) int, or -1 where there is none.

    The reference is healthy, of the same specimen, within 1 % in torque and 0.2 % in speed (mean speed between the
    pulses where it is known); of several the one nearest in speed, then the first. All records at an operating point
    stand beside the same reference, the first healthy one, which has none itself. So healthy and damaged ones of a
    gearbox without damage could be exchanged: two healthy records beside each other would be one difference, counted
    twice. A reference beside which no other healthy record stands does not count.
    """
    labels = measured.labels
    speed = measured.values["pulses_per_s"][:, 0]
    speed = np.where(np.isfinite(speed), speed, labels["speed_hz"])
    torque = labels["torque_nm"].astype(np.float64)
    result = np.full(speed.size, -1, dtype=np.int64)
    for specimen in np.unique(labels["specimen_id"]):
        rows = np.flatnonzero(labels["specimen_id"] == specimen)
        result[rows] = _references(rows, measured.healthy[rows], speed[rows], torque[rows])
    return result


def _references(rows: np.ndarray, healthy: np.ndarray, speed: np.ndarray, torque: np.ndarray) -> np.ndarray:
    """Return the references of the records of one specimen, rows of the set or -1."""
    apart = np.abs(speed[:, None] / speed - 1.0)
    allowed = (apart <= SPEED_TOLERANCE) & (np.abs(torque[:, None] - torque) <= TORQUE_TOLERANCE * np.abs(torque))
    chosen: list[int] = []
    for place in np.flatnonzero(healthy).tolist():
        if not allowed[place, chosen].any():
            chosen.append(place)
    found = np.full(rows.size, -1, dtype=np.int64)
    if not chosen:
        return found
    nearest = np.where(allowed[:, chosen], apart[:, chosen], np.inf)
    place = np.asarray(chosen)[nearest.argmin(axis=1)]
    beside = np.isfinite(nearest.min(axis=1)) & ~np.isin(np.arange(rows.size), chosen)
    beside &= np.isin(place, place[beside & healthy])
    found[beside] = rows[place[beside]]
    return found


def exchange_blocks(measured: MeasuredSet) -> np.ndarray:
    """Return a number for every record, (records,) int: records of one number are alike but for the state.

    They are of one specimen and operating point and stand beside one reference; the reference stands alone.
    """
    reference, every = reference_records(measured), np.arange(len(measured.healthy))
    point = measured.labels.get("operating_point_id", np.zeros(every.size, dtype=np.int64))
    beside = np.where(np.isin(every, reference), every.size + every, reference)
    keys = np.stack([measured.labels["specimen_id"], point, beside]).astype(np.int64)
    return np.asarray(np.unique(keys, axis=1, return_inverse=True)[1]).ravel()
