"""What a channel's samples say about its recorder: the smallest step, and the largest value."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnostics.calibration.healthy_blocks import Block

LARGEST_BITS = 24
HEADROOM = 4.0
SEEN = 20_000


@dataclass(frozen=True, slots=True)
class SensorFit:
    """Smallest step [m/s²], 0 where values lie on no grid; range [m/s²] and bits that give it, None without one."""

    step_m_s2: float
    range_m_s2: float
    bits: int | None


def sensor_fit(blocks: Sequence[Block], channel: str) -> SensorFit:
    """Return the resolution of a channel; its range is not seen, only that it is larger than all values."""
    peak = max(float(np.abs(block.channels[channel]).max()) for block in blocks)
    step = smallest_step(np.concatenate([block.channels[channel][:SEEN] for block in blocks]))
    if not step:
        return SensorFit(0.0, HEADROOM * peak, None)
    # the simulated step is the smallest power of two above 2 range / 2^bits
    power = 2.0 ** math.floor(math.log2(step) + 1e-9)
    bits = min(max(math.ceil(math.log2(2.0 * HEADROOM * peak / power)), 4), LARGEST_BITS)
    return SensorFit(step, power * 2.0 ** (bits - 1), bits)


def smallest_step(values: np.ndarray) -> float:
    """Return the step of the grid on which values (n,) lie, 0 if on none."""
    levels = np.unique(values)
    gaps = np.diff(levels)
    if gaps.size < 2:
        return 0.0
    step = float(gaps.min())
    # values that were scaled carry rounding errors: gaps that are no multiple of the smallest one mean no grid
    steps = gaps / step
    on_grid = float(np.abs(steps - np.round(steps)).max()) < 0.05 and step > 1e-9 * float(np.abs(levels).max())
    return float(np.median(gaps / np.round(steps))) if on_grid and levels.size < 0.98 * values.size else 0.0
