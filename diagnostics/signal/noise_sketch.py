"""A short fingerprint of the noise of a channel: spectral phases of what the averages of both shafts leave.

Two signals that hold the same noise samples, whatever their gain and gears, have the same phases; independent noise has
independent ones, so that the mean product of two sketches of k phases scatters around zero by about 1/sqrt(k). Source:
phase-only correlation, standard literature.
"""

from __future__ import annotations

import numpy as np

from diagnostics.signal.order_domain import AngleGrid
from diagnostics.signal.synchronous_average import synchronous_average, whole_revolutions

SEGMENT_SAMPLES = 4096
PHASES = 1024
_HANN = np.hanning(SEGMENT_SAMPLES)
SMALLEST_SHARE = 1e-5
"""What is left below this share of the signal's rms is rounding and interpolation, not noise."""
FEWEST_TURNS = 4
"""Of a shaft whose average is taken off: over m turns it takes 1/m of the noise along, and a copy keeps 1 - 1/m.

Both shafts over four turns leave at least 0.56 of the correlation of a copy; the audit accuses from 0.3 on.
"""


def noise_sketch(
    signal: np.ndarray, fs_hz: float, steps: np.ndarray, teeth: tuple[int, int], grid: AngleGrid
) -> np.ndarray:
    """Return unit phases (1024,) complex64 of the residual of 4096 samples of a channel, or empty.

    Parameters
    ----------
    signal : (n,) float64
        The channel.
    fs_hz : float
        Sampling frequency [Hz].
    steps : (steps,) float64
        The channel over pinion angle, whole mesh periods.
    teeth : (int, int)
        Teeth of pinion and gear.
    grid : AngleGrid
        Times of the angle steps.

    Notes
    -----
    The segment is cut at fixed samples, not at fixed angles, because copied noise has the same sample index. Empty
    where the record is too short or holds no noise. What is locked to the gear stays where it makes fewer than four
    turns: then two records of one gearbox that meet the segment with the gear at one angle look alike.
    """
    from scipy import fft

    first = int(0.25 * signal.size)
    piece = signal[first : first + SEGMENT_SAMPLES]
    time_s = (first + np.arange(piece.size)) / fs_hz
    if piece.size < SEGMENT_SAMPLES or time_s[0] < grid.time_s[0] or time_s[-1] > grid.time_s[-1]:
        return np.empty(0, dtype=np.complex64)
    if grid.revolutions < FEWEST_TURNS:
        return np.empty(0, dtype=np.complex64)
    left = piece - _locked(steps, teeth, grid, np.interp(time_s, grid.time_s, np.arange(grid.time_s.size)))
    if float(left.std()) < SMALLEST_SHARE * float(np.sqrt(np.mean(np.square(signal)))):
        return np.empty(0, dtype=np.complex64)
    # the upper half of the band, where what is locked to both gears is weakest
    spectrum = fft.rfft(left * _HANN)[-PHASES:]
    size = np.abs(spectrum)
    return np.asarray(spectrum / np.where(size > 0, size, 1.0), dtype=np.complex64)


def _locked(steps: np.ndarray, teeth: tuple[int, int], grid: AngleGrid, place: np.ndarray) -> np.ndarray:
    """Return what is locked to the pinion, and of the rest what is locked to the gear, at steps `place` (n,)."""
    per_tooth = grid.samples_per_revolution // teeth[0]
    pinion = synchronous_average(steps, teeth[0], per_tooth)
    found = _periodic(pinion.signal, place)
    if whole_revolutions(steps, teeth[1], per_tooth) < FEWEST_TURNS:
        return found
    rest = (steps.reshape(grid.revolutions, -1) - pinion.signal).ravel()
    return np.asarray(found + _periodic(synchronous_average(rest, teeth[1], per_tooth).signal, place))


def _periodic(average: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return an averaged revolution at places (n,) in steps, by a periodic cubic spline."""
    from scipy.ndimage import map_coordinates

    return np.asarray(map_coordinates(average, (place % average.size)[None, :], order=3, mode="grid-wrap"))
