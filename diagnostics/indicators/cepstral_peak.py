"""Cepstral peak: first rahmonic of a shaft, from its sidebands and harmonics in the whole order spectrum."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.signal.cepstrum import log_amplitude, real_cepstrum, without_lines


def shaft_cepstrum(angle_signal: np.ndarray, revolutions: int, teeth: int, highest_order: int) -> np.ndarray:
    """Return the real cepstrum over pinion angle, mesh lines taken out of the log spectrum first.

    Parameters
    ----------
    angle_signal : (n,) float64
        Record in equal steps of pinion angle over `revolutions` whole pinion revolutions.
    revolutions : int
        Whole pinion revolutions.
    teeth : int
        Teeth of the pinion.
    highest_order : int
        Pinion orders up to which the spectrum counts; above the sampling band it holds nothing but rounding errors.

    Returns
    -------
    (2 highest_order revolutions,) float64
        Quefrency in steps of 1 / (2 highest_order) pinion revolutions.
    """
    kept = log_amplitude(angle_signal)[: highest_order * revolutions + 1]
    flat = without_lines(kept, teeth * revolutions)
    return real_cepstrum(flat - flat.mean())


def cepstral_peak(cepstrum: np.ndarray, period_steps: float) -> float:
    """Return the largest value within one step of a quefrency; NaN where the cepstrum does not reach it.

    Parameters
    ----------
    cepstrum : (n,) float64
        Real cepstrum.
    period_steps : float
        Quefrency of the shaft's revolution in steps of the cepstrum; both shafts differ by the tooth ratio.

    Notes
    -----
    An echo of share a at that delay: a/2. Dimensionless (nepers). Source: Randall 2017.
    """
    middle = round(period_steps)
    if middle < 2 or 2 * (middle + 1) > cepstrum.size:
        return math.nan
    return float(cepstrum[middle - 1 : middle + 2].max())
