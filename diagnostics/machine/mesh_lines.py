"""Whether a recording shows the mesh lines of the teeth that its user gave; else orders mean other things."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import ShaftPulses
from diagnostics.signal.order_domain import SAMPLES_PER_TOOTH, angle_grid, resample_to_angle
from diagnostics.signal.order_lines import OrderLines, noise_density, order_lines
from siggen.errors import UsageError

HARMONICS = 5
OVER_NOISE = 10.0
"""Power of a line's largest bin over that of the noise beside it; noise alone reaches it in 1 of 20,000 bins."""


def check_mesh_lines(recording: MeasuredRecording, pulses: ShaftPulses, teeth: tuple[int, int]) -> None:
    """Check that one of the first five mesh lines stands 10 dB over the noise on a channel.

    Raises
    ------
    UsageError
        If none does; names the file.
    """
    grid = angle_grid(pulses.times_s, SAMPLES_PER_TOOTH * teeth[0])
    duration_s = float(pulses.times_s[-1] - pulses.times_s[0])
    for signal in recording.channels.values():
        turns = resample_to_angle(signal, recording.fs_hz, grid).reshape(grid.revolutions, -1)
        if strongest_mesh_line(order_lines(turns, duration_s), teeth) > OVER_NOISE:
            return
    raise UsageError(
        f"{recording.path}: no mesh line of {teeth[0]} teeth stands out at {pulses.speed_hz:.4g} Hz of the pinion; are "
        "these the teeth (--teeth PINION,GEAR), is the tacho on the pinion, and was the machine loaded?"
    )


def strongest_mesh_line(lines: OrderLines, teeth: tuple[int, int]) -> float:
    """Return the largest ratio of power between a mesh line's bin and the noise beside it."""
    found = [0.0]
    for h in range(1, HARMONICS + 1):
        noise = noise_density(lines, teeth, h) * 1.5 * lines.bin_hz
        line = lines.line(float(h * teeth[0]))
        if math.isfinite(line) and noise > 0.0:
            found.append(0.5 * line**2 / noise)
    return float(np.max(found))
