"""For every record another healthy record of the same specimen at the same operating point."""

from __future__ import annotations

import numpy as np

from diagnostics.audit.measured_set import MeasuredSet

TORQUE_TOLERANCE = 0.01
SPEED_TOLERANCE = 0.002


def reference_records(measured: MeasuredSet) -> np.ndarray:
    """Return the row of the reference of every record, (records,) int, or -1 where there is none.

    The reference is healthy, of the same specimen, not the record itself, within 1 % in torque and 0.2 % in speed (mean
    speed between the pulses where it is known); of several the one nearest in speed, then the first. Healthy records
    get references like all others, so that both classes are differences of two records.
    """
    labels = measured.labels
    speed = measured.values["pulses_per_s"][:, 0]
    speed = np.where(np.isfinite(speed), speed, labels["speed_hz"])
    torque = labels["torque_nm"].astype(np.float64)
    result = np.full(speed.size, -1, dtype=np.int64)
    for specimen in np.unique(labels["specimen_id"]):
        rows = np.flatnonzero(labels["specimen_id"] == specimen)
        references = rows[measured.healthy[rows]]
        if references.size == 0:
            continue
        apart = np.abs(speed[rows][:, None] / speed[references] - 1.0)
        load = np.abs(torque[rows][:, None] - torque[references])
        allowed = (apart <= SPEED_TOLERANCE) & (load <= TORQUE_TOLERANCE * np.abs(torque[references]))
        apart = np.where(allowed & (rows[:, None] != references), apart, np.inf)
        nearest = apart.argmin(axis=1)
        has_one = np.isfinite(apart[np.arange(rows.size), nearest])
        result[rows[has_one]] = references[nearest[has_one]]
    return result
