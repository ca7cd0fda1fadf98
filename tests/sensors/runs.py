"""Records of small gearboxes with any sensors, for tests of kinds of sensors."""

from __future__ import annotations

from typing import Any

import numpy as np

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from tests.config.minimal import by_name, minimal
from tests.simulated import simulate

GEAR_RATIO = 18 / 47


def loaded(*sensors: dict[str, Any], **changes: Any) -> SetDesign:
    """Return a configuration of two gears on two shafts that do not bend; `changes` as of `minimal`."""
    plain = {"dynamics__model": "8dof", "duration_s": 0.2, "fs_hz": 25_600.0, "mesh_harmonics": 5, "specimens": 2}
    return load_config(minimal(sensors=by_name(sensors), **{**plain, **changes}))


def record(config: SetDesign, record_id: int = 0) -> SimulatedRecord:
    """Return a record that was simulated."""
    (result,) = simulate(config, [record_id])
    assert isinstance(result, SimulatedRecord), result
    return result


def problems(*sensors: dict[str, Any], **changes: Any) -> dict[str, str]:
    """Return path -> what was received and what is allowed of a configuration that is refused."""
    try:
        loaded(*sensors, **changes)
    except ConfigError as refused:
        return {p.path: f"{p.received}; {p.allowed}" for p in refused.problems}
    raise AssertionError("nothing was refused")


def line(signal: np.ndarray, fs_hz: float, frequency_hz: float) -> float:
    """Return the amplitude of a line at any frequency, by least squares with a Hann window."""
    times = np.arange(signal.size) / fs_hz
    weight = np.hanning(signal.size)
    turned = 2 * np.pi * frequency_hz * times
    basis = np.array([np.cos(turned), np.sin(turned), np.ones(signal.size)])
    found, *_ = np.linalg.lstsq((basis * weight).T, signal.astype(np.float64) * weight, rcond=None)
    return float(np.hypot(found[0], found[1]))
