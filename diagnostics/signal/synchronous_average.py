"""Average of a record over whole revolutions of the pinion shaft or of the gear shaft.

A mesh period holds a fixed number of angle steps, so one grid serves both shafts: a pinion revolution is z1 mesh
periods, a gear revolution z2 (gear angle = pinion angle z1/z2). Source: synchronous averaging, standard literature
(McFadden 1987).

What the averages of both shafts leave of a record in equal steps of pinion angle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

GEAR_BINS = 2048


def asynchronous_part(turns: np.ndarray, gear_order: float) -> np.ndarray:
    """Return the record less the averages of pinion and gear, (revolutions * steps,) float64.

    Parameters
    ----------
    turns : (revolutions, steps) float64
        One row per pinion revolution.
    gear_order : float
        Revolutions of the gear per pinion revolution. Its average is taken in 2048 bins of its angle.

    Notes
    -----
    Of noise a share of one over the revolutions goes with each average. Source: standard literature.
    """
    rest = (turns - turns.mean(axis=0)).ravel()
    place = np.arange(rest.size) * (gear_order / turns.shape[1])
    bins = ((place - np.floor(place)) * GEAR_BINS).astype(np.int64)
    mean = np.bincount(bins, rest, GEAR_BINS) / np.maximum(np.bincount(bins, minlength=GEAR_BINS), 1)
    return np.asarray(rest - mean[bins])


def band_signal(spectrum: np.ndarray, low: int, high: int) -> np.ndarray:
    """Return the complex envelope of the bins low <= k < high, as few samples as hold it, of rfft lines.

    Parameters
    ----------
    spectrum : (bins,) complex128
        As of `scipy.fft.rfft`.
    low, high : int
        Bins; the envelope has `high - low` samples over the record, and the rms of the analytic signal.
    """
    from scipy import fft

    kept = spectrum[low:high]
    return np.asarray(fft.ifft(kept) * kept.size if kept.size else np.empty(0, np.complex128))


@dataclass(frozen=True, slots=True)
class SynchronousAverage:
    """One revolution of a shaft, averaged.

    Attributes
    ----------
    signal : (teeth * samples_per_tooth,) float64
        Average over `revolutions` revolutions of the shaft that carries `teeth` teeth.
    teeth : int
        Teeth of the averaged gear; mesh harmonic h is shaft order h * teeth.
    revolutions : int
        Whole revolutions averaged. What is locked to the other shaft cancels exactly only if this is a multiple of the
        other gear's tooth number (over their common divisor), and falls about as 1/revolutions otherwise.
    """

    signal: np.ndarray
    teeth: int
    revolutions: int


def whole_revolutions(angle_signal: np.ndarray, teeth: int, samples_per_tooth: int) -> int:
    """Return how many whole revolutions of a shaft the angle signal holds."""
    return angle_signal.size // (teeth * samples_per_tooth)


def synchronous_average(
    angle_signal: np.ndarray, teeth: int, samples_per_tooth: int, weights: np.ndarray | None = None
) -> SynchronousAverage:
    """Average an angle signal over all whole revolutions of the shaft with the given number of teeth.

    Parameters
    ----------
    angle_signal : (n,) float64
        Record at equal angle steps, `samples_per_tooth` per mesh period.
    teeth : int
        Teeth on the shaft.
    samples_per_tooth : int
        Angle steps per mesh period.
    weights : (revolutions * teeth * samples_per_tooth,) float64, optional
        Window over the averaged stretch, divided by its mean; with a Hann window the spectrum of the result is the Hann
        spectrum of the stretch at whole shaft orders.

    Raises
    ------
    ValueError
        If the signal is shorter than one revolution.
    """
    revolutions = whole_revolutions(angle_signal, teeth, samples_per_tooth)
    if revolutions < 1:
        raise ValueError(f"received {angle_signal.size} angle steps; one revolution needs {teeth * samples_per_tooth}")
    stretch = angle_signal[: revolutions * teeth * samples_per_tooth]
    if weights is not None:
        stretch = stretch * (weights / weights.mean())
    return SynchronousAverage(stretch.reshape(revolutions, -1).mean(axis=0), teeth, revolutions)


def hann_weights(samples: int) -> np.ndarray:
    """Return the periodic Hann window of the given length."""
    # cos(a + b) of coarse and fine steps: some 2 sqrt(n) cosines instead of n, within 1e-15 of them
    fine = math.isqrt(samples) + 1
    coarse_angle = 2.0 * np.pi * np.arange(0, samples, fine)[:, None] / samples
    fine_angle = 2.0 * np.pi * np.arange(fine) / samples
    cosine = np.cos(coarse_angle) * np.cos(fine_angle)
    cosine -= np.sin(coarse_angle) * np.sin(fine_angle)
    weights: np.ndarray = cosine.ravel()[:samples]
    weights *= -0.5
    weights += 0.5
    np.maximum(weights, 0.0, out=weights)
    return weights
