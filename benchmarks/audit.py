"""What the attackers of an audit cost on 1,000 records, beside the pass over them, which `indicators` measures."""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np

from benchmarks.row import Row
from diagnostics.audit.bank_detections import bank_detections, chance_limit
from diagnostics.audit.condition_traps import condition_traps
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.signal_attackers import signal_attackers
from diagnostics.base.single_thread import single_thread

GEARBOXES, STATES, CHANNELS, ORDERS, TEETH = 63, 16, 2, 362, 18


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the CPU time of every step; quick takes 200 records and states what 1,000 would cost by proportion."""
    share = 0.2 if quick else 1.0
    for what, seconds in _steps(round(GEARBOXES * share)).items():
        yield Row(f"audit of 1,000 records: {what}", f"{seconds / share:.0f} s of CPU")


@single_thread
def _steps(gearboxes: int) -> dict[str, float]:
    measured, found, start = measured_noise(gearboxes), {}, time.process_time()

    def lap(name: str) -> None:
        nonlocal start
        found[name] = time.process_time() - start
        start = time.process_time()

    bank = signal_attackers(measured, 0, _nothing)
    lap("preparing attackers")
    bank_detections(measured, bank, 0, _nothing)
    lap("attacking, networks among it")
    chance_limit(measured, bank, 0, _nothing)
    lap("permuted states")
    condition_traps(measured, 0)
    lap("attackers on conditions")
    return found


def _nothing() -> None:
    """Show no progress."""


def measured_noise(gearboxes: int) -> MeasuredSet:
    """Return a measured set of noise, two healthy and 14 damaged records a gearbox."""
    rng, count = np.random.default_rng(1), gearboxes * STATES
    specimen, state = np.repeat(np.arange(gearboxes), STATES), np.tile(np.arange(STATES), gearboxes)
    size = (count, CHANNELS, ORDERS)
    lines = (rng.standard_normal(size) + 1j * rng.standard_normal(size)).astype(np.complex64)
    healthy = state < 2
    labels = {
        "specimen_id": specimen,
        "state": np.array([f"state_{k}" for k in state.tolist()]),
        "fault": np.where(healthy, "healthy", "spalling"),
        "teeth_pinion": np.full(count, TEETH),
        "speed_hz": np.full(count, 30.0),
        "torque_nm": np.full(count, 40.0),
        "damaged_area_mm2": 1.0 * state,
    }
    values = {"pulses_per_s": np.full((count, CHANNELS), 30.0)}
    waveforms = [list(row) for row in lines]
    nothing = np.zeros((count, CHANNELS), np.int64)
    return MeasuredSet(labels, ("a", "b"), values, (), waveforms, [], nothing, {}, [])
