"""Whether intervals of a calibration hold what recordings show that were not fitted."""

from __future__ import annotations

import numpy as np

from diagnostics.calibration.calibration import Calibration
from diagnostics.calibration.healthy_blocks import HealthyBlocks
from diagnostics.calibration.order_record import HIGHEST_SHARE, group_levels, line_groups, order_record
from diagnostics.statistics.evaluation import Interval


def interval_coverage(found: Calibration, held_out: HealthyBlocks) -> tuple[int, int]:
    """Return how many intervals of lines and noise hold the mean of other recordings, and how many there are."""
    drive = found.rig.drive
    fastest = max(block.speed_hz for block in (*found.blocks.blocks, *held_out.blocks))
    top = HIGHEST_SHARE * held_out.fs_hz / fastest
    groups = line_groups(drive, top)
    held = []
    for channel in found.channels:
        records = [order_record(one.channels[channel.name], one.fs_hz, one.pulses_s, drive) for one in held_out.blocks]
        energy = np.array([group_levels(record, groups)[0] for record in records])
        noise = np.array([record.floor.sum() for record in records])
        levels = dict(zip((group.name for group in found.library.groups), channel.levels, strict=True))
        lines = [levels[group.name] for group in groups]
        held += [
            _holds(fitted, column)
            for fitted, column in zip((*lines, channel.noise.level_db), (*energy.T, noise), strict=True)
        ]
    known = [one for one in held if one is not None]
    return sum(known), len(known)


def _holds(fitted: Interval, power: np.ndarray) -> bool | None:
    """Return whether an interval holds the mean level of other powers (recordings,); None where there is none."""
    if not np.isfinite([fitted.low, fitted.high]).all() or not (power > 0.0).all():
        return None
    return bool(fitted.low <= float(np.mean(10.0 * np.log10(power))) <= fitted.high)
