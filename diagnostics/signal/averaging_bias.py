"""What an average over M revolutions still holds that is not locked to its shaft.

Noise of variance s^2 leaves s^2/M, so the variance of an average is biased up by that much; a line at a fraction of the
shaft's order leaves its comb gain. Indicators of averages over different M are therefore not comparable where noise
matters. Source: McFadden 1987; standard literature.
"""

from __future__ import annotations

import math

import numpy as np


def comb_gain(order: np.ndarray, revolutions: int) -> np.ndarray:
    """Return |sin(pi M o) / (M sin(pi o))|: what averaging over M revolutions leaves of a line at order o.

    Parameters
    ----------
    order : (n,) float64
        Orders of the averaged shaft; 1 at whole orders.
    revolutions : int
        M.
    """
    off = np.asarray(order, dtype=np.float64) - np.rint(order)
    gain: np.ndarray = np.abs(np.sinc(revolutions * off) / np.sinc(off))
    return gain


def noise_share(angle_signal: np.ndarray, samples_per_revolution: int) -> float:
    """Return the share of the variance of the synchronous average that is left-over noise; NaN below two revolutions.

    Estimated as the variance between revolutions at equal angle (unbiased, M - 1), mean over the angle, over M, by the
    variance of the average. It is 1 where nothing is locked to the shaft.

    Parameters
    ----------
    angle_signal : (n,) float64
        Record at equal angle steps.
    samples_per_revolution : int
        Angle steps per revolution of the averaged shaft.
    """
    count = angle_signal.size // samples_per_revolution
    if count < 2:
        return math.nan
    turns = angle_signal[: count * samples_per_revolution].reshape(count, samples_per_revolution)
    variance = float(turns.mean(axis=0).var())
    left = float(turns.var(axis=0, ddof=1).mean()) / count
    return min(left / variance, 1.0) if variance > 0.0 else math.nan
