"""How long the records of a set have to be, so that indicators can be taken of all of them."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.records.record_problems import FEWEST_REVOLUTIONS, is_rate
from diagnostics.signal.spectral_kurtosis import FEWEST_FRAMES
from siggen.dataset.reading import Dataset


def needed_duration(dataset: Dataset, frame_samples: int) -> tuple[float, float]:
    """Return the duration [s] that every record of a set has to have, and the speed [Hz] of the record that needs it.

    Whole revolutions lie between pulses, and the first pulse comes up to one revolution after the start: n of them are
    sure in n + 1 revolutions. Derived.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    frame_samples : int
        Samples per frame of the spectral kurtosis.
    """
    labels = dataset.labels(columns=["speed_hz", "teeth_pinion", "teeth_gear"])
    columns = np.array([labels.column(name).to_pylist() for name in labels.column_names], dtype=np.float64)
    speed_hz, pinion, gear = columns[:, (np.isfinite(columns) & (columns > 0.0)).all(axis=0)]
    if not speed_hz.size:
        return math.nan, math.nan
    turns = np.ceil(FEWEST_REVOLUTIONS * np.maximum(1.0, gear / pinion)) + 1.0
    needed_s = turns / speed_hz
    longest = int(np.argmax(needed_s))
    frames_s = (FEWEST_FRAMES + 1) * (frame_samples // 2) / dataset.fs_hz
    return max(float(needed_s[longest]), frames_s), float(speed_hz[longest])


def duration_advice(dataset: Dataset, frame_samples: int) -> str:
    """Return what to do about records that are too short, as a line of its own; nothing where they are long enough."""
    if not is_rate(dataset.fs_hz):
        return ""
    needed_s, speed_hz = needed_duration(dataset, frame_samples)
    if not dataset.duration_s < needed_s:
        return ""
    # rounded up, so that the number works as it is shown
    return (
        f"Records of this set last {dataset.duration_s:g} s; at its lowest speed, {speed_hz:.3g} Hz, they have to last "
        f"{np.ceil(100.0 * needed_s) / 100.0:.2f} s (duration_s).\n"
    )
