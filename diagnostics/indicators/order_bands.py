"""Indicators of the residual in bands of shaft orders: how much a short event stands out of each of them."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.indicator import indicator
from diagnostics.indicators.level import UNDEFINED_BELOW, moment_ratio, rms
from diagnostics.signal.order_bands import localised_energy

OUTSIDE = "the record carries less than half of the band, or the band is below 1e-9 of the average"


@indicator(
    "band_kurtosis_{shaft}_{band}",
    "Kurtosis in a band of orders",
    signal="residual, shaft orders of one octave; octaves overlap by half",
    formula="μ₄/μ₂²",
    known="Gaussian 3 (less in narrow bands); sine 1.5",
    undefined=OUTSIDE,
    source="Antoni 2006 for kurtosis by band; bands in orders derived",
)
def band_kurtosis(residual_band: np.ndarray, average: np.ndarray) -> float:
    """Return mu_4 / mu_2^2 of a band of the residual.

    Parameters
    ----------
    residual_band : (n,) complex128
        Analytic signal of the band, see `diagnostics.signal.order_bands.band_signal`.
    average : (n,) float64
        The average itself, which sets the guard against rounding errors.
    """
    return moment_ratio(residual_band.real, 4, rms(average))


@indicator(
    "band_localised_energy_{shaft}_{band}",
    "Localised energy in a band of orders",
    signal="residual, shaft orders of one octave; octaves overlap by half",
    formula="largest energy within one tooth pitch over the mean energy of a pitch; energy: squared envelope",
    known="sine 1; burst within one pitch: z",
    undefined=OUTSIDE,
    source="derived",
)
def band_localised_energy(residual_band: np.ndarray, average: np.ndarray, teeth: int) -> float:
    """Return the localised energy of a band of the residual, with the guard of `band_kurtosis`."""
    if not rms(np.abs(residual_band)) > UNDEFINED_BELOW * rms(average):
        return math.nan
    return localised_energy(residual_band, teeth)
