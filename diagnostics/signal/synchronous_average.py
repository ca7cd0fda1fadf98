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


def asynchronous_part(turns: np.ndarray, teeth: tuple[int, int]) -> np.ndarray:
    """Return the record less the averages of pinion and gear, (revolutions * steps,) float64.

    Parameters
    ----------
    turns : (revolutions, steps) float64
        One row per pinion revolution.
    teeth : (int, int)
        Teeth of pinion and gear. The average of the gear is taken in 2048 bins of its angle.

    Notes
    -----
    Of noise a share of one over the revolutions goes with each average. Source: standard literature.
    """
    rest = (turns - turns.mean(axis=0)).ravel()
    # in whole numbers: which bin a step on a border belongs to is then no matter of rounding, and bins come back
    steps = turns.shape[1] * teeth[1]
    period = min(steps // math.gcd(steps, teeth[0]), rest.size)
    bins = np.arange(period) * (teeth[0] * GEAR_BINS) // steps % GEAR_BINS
    whole = rest.size // period
    periods, left = rest[: whole * period].reshape(whole, period), rest[whole * period :]
    total, count = periods.sum(axis=0), np.full(period, float(whole))
    total[: left.size] += left
    count[: left.size] += 1.0
    mean = np.bincount(bins, total, GEAR_BINS) / np.maximum(np.bincount(bins, count, GEAR_BINS), 1.0)
    locked = mean[bins]
    periods -= locked
    left -= locked[: left.size]
    return np.asarray(rest)


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
    angle_signal: np.ndarray, teeth: int, samples_per_tooth: int, *, hann: bool = False
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
    hann : bool
        Average under a Hann window over all revolutions, divided by its mean: the spectrum of the result is the Hann
        spectrum of the stretch at whole shaft orders.

    Raises
    ------
    ValueError
        If the signal is shorter than one revolution.
    """
    revolutions = whole_revolutions(angle_signal, teeth, samples_per_tooth)
    if revolutions < 1:
        raise ValueError(f"received {angle_signal.size} angle steps; one revolution needs {teeth * samples_per_tooth}")
    turns = angle_signal[: revolutions * teeth * samples_per_tooth].reshape(revolutions, -1)
    average = turns.mean(axis=0)
    return SynchronousAverage(average - _cosine_average(turns) if hann else average, teeth, revolutions)


def _cosine_average(turns: np.ndarray) -> np.ndarray:
    """Return the average of turns (m, n) times one period of a cosine over all of them, (n,) float64."""
    # cos(a + b) of turn and step: sums over turns alone, and m + n cosines
    turn = 2.0 * np.pi * np.arange(len(turns)) / len(turns)
    step = 2.0 * np.pi * np.arange(turns.shape[1]) / turns.size
    found = np.cos(step) * np.einsum("ij,i->j", turns, np.cos(turn))
    found -= np.sin(step) * np.einsum("ij,i->j", turns, np.sin(turn))
    found /= len(turns)
    return np.asarray(found)


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
