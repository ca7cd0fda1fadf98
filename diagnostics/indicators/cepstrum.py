"""Indicators of the cepstrum: first rahmonic of a shaft, from its sidebands and harmonics in the order spectrum."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.indicator import indicator
from diagnostics.signal.cepstrum import cepstrum_at, log_amplitude, without_lines

BAND_SHARE = 0.8
"""Share of the band whose spectrum counts in the cepstrum; above, the anti-alias filter shapes it."""


def shaft_log_spectrum(amplitude: np.ndarray, revolutions: int, teeth: int, highest_order: int) -> np.ndarray:
    """Return the log spectrum over orders of the pinion, mesh lines and mean taken out.

    Parameters
    ----------
    amplitude : (bins,) float64
        Hann amplitudes over whole pinion revolutions, see `hann_amplitude`.
    revolutions : int
        Whole pinion revolutions.
    teeth : int
        Teeth of the pinion.
    highest_order : int
        Pinion orders up to which the spectrum counts; above the sampling band it holds nothing but rounding errors.

    Returns
    -------
    (highest_order revolutions + 1,) float64
        Nepers; its cepstrum has 2 highest_order steps per pinion revolution.
    """
    kept = log_amplitude(amplitude, highest_order * revolutions + 1)
    flat = without_lines(kept, teeth * revolutions)
    return np.asarray(flat - flat.mean())


@indicator(
    "cepstral_peak_{shaft}",
    "Cepstral peak",
    signal="record over angle, log spectrum up to 0.8 of the band, mesh lines taken out",
    formula="largest real cepstrum within one step of one revolution of the shaft",
    known="echo of share a after one revolution: a/2",
    undefined="the record holds no two revolutions of the shaft",
    source="Randall 2017",
)
def cepstral_peak(log_spectrum: np.ndarray, period_steps: float) -> float:
    """Return the largest cepstrum within one step of a quefrency; NaN where the cepstrum does not reach it.

    Parameters
    ----------
    log_spectrum : (k,) float64
        One-sided log amplitude; its cepstrum has 2 (k - 1) values.
    period_steps : float
        Quefrency of the shaft's revolution in steps of the cepstrum; both shafts differ by the tooth ratio.

    Notes
    -----
    An echo of share a at that delay: a/2. Dimensionless (nepers). Source: Randall 2017.
    """
    if period_steps < 2 or period_steps + 1 > log_spectrum.size - 1:
        return math.nan
    # not at whole steps: half a step beside a peak the cepstrum is down to 0.64 of it, differently at every speed
    return float(cepstrum_at(log_spectrum, period_steps + np.array([-1.0, 0.0, 1.0])).max())
