"""Speed from the mesh lines in ranges so wide that half and twice the speed lie in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import range_parts, shaft_pulses
from siggen.errors import UsageError

FS_HZ, TEETH = 12_800.0, (18, 47)


def recording(speed_hz: float, tacho_s: np.ndarray | None = None) -> MeasuredRecording:
    rng = np.random.default_rng(2)
    time_s = np.arange(round(2.0 * FS_HZ)) / FS_HZ
    turns = speed_hz * time_s + 0.002 * np.sin(2 * np.pi * 0.7 * time_s)
    mesh = sum(np.cos(2 * np.pi * h * TEETH[0] * turns + h) * a for h, a in enumerate((1.0, 1.5, 0.4, 0.6), start=1))
    signal = (1.0 + 0.2 * np.cos(2 * np.pi * turns)) * mesh + 0.3 * rng.standard_normal(time_s.size)
    return MeasuredRecording(Path("run.npz"), {"vertical": signal}, FS_HZ, tacho_s)


@pytest.mark.parametrize("speed_hz", [24.0, 33.0, 45.0])
@pytest.mark.parametrize("limits", [(20.0, 50.0), (14.0, 70.0)])
def test_the_speed_is_found_not_half_or_twice_of_it(speed_hz: float, limits: tuple[float, float]) -> None:
    found = shaft_pulses(recording(speed_hz), TEETH, limits)
    assert found.speed_hz == pytest.approx(speed_hz, rel=1e-3)  # the drift itself is 0.03 %
    assert found.source == "vertical"


def test_parts_cover_the_range_and_hold_one_harmonic_each() -> None:
    parts = range_parts((10.0, 90.0))
    assert parts[0][0] == 10.0
    assert parts[-1][1] == 90.0
    for (low, high), (following, _) in zip(parts, [*parts[1:], (90.0, 0.0)], strict=True):
        assert high < 2.0 * low
        assert high >= following


def test_without_tacho_and_range_and_with_too_few_turns_the_file_is_named() -> None:
    with pytest.raises(UsageError, match=r"run.npz: neither tacho nor speed"):
        shaft_pulses(recording(30.0), TEETH, None)
    with pytest.raises(UsageError, match=r"run.npz: 4 whole pinion revolutions; averages of both shafts need 6"):
        shaft_pulses(recording(30.0, np.arange(5) / 30.0), TEETH, None)
    with pytest.raises(UsageError, match="speed range"):
        shaft_pulses(recording(30.0), TEETH, (40.0, 30.0))
