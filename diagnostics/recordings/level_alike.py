"""Whether recordings of one machine have levels that one machine can have; else one of them has another unit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnostics.recordings.measured_recording import MeasuredRecording
from siggen.errors import UsageError

MOST_DB = 25.0
"""Of all channels alike: more than load or damage does, so a wrong unit or gain."""
PLAUSIBLE_RMS_M_S2 = (1e-4, 1e4)


def check_levels_alike(read: Sequence[MeasuredRecording]) -> None:
    """Check that no recording stands out from the others by its level on all channels.

    Raises
    ------
    UsageError
        If one does; names the file that is farthest off.
    """
    if len(read) < 2:
        return
    level = np.array([[20.0 * np.log10(float(signal.std())) for signal in one.channels.values()] for one in read])
    off = np.array([row - np.median(np.delete(level, k, axis=0), axis=0) for k, row in enumerate(level)])
    least = np.where((off > 0.0).all(axis=1) | (off < 0.0).all(axis=1), np.abs(off).min(axis=1), 0.0)
    worst = int(least.argmax())
    if least[worst] > MOST_DB:
        raise UsageError(
            f"{read[worst].path}: all channels are {np.sign(off[worst, 0]) * least[worst]:+.0f} dB off the other "
            "recordings; are unit, sensitivity and gain alike in all of them?"
        )


def level_note(recording: MeasuredRecording) -> str:
    """Return what is implausible in the level of a recording, or an empty text."""
    low, high = PLAUSIBLE_RMS_M_S2
    found = [
        f"rms of {name} is {signal.std():.3g} m/s2, usual: {low:g} to {high:g}; is `unit` of the rig file true?"
        for name, signal in recording.channels.items()
        if not low < float(signal.std()) < high
    ]
    return "; ".join(found)
