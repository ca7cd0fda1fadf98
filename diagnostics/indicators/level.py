"""Level and shape of a whole record: rms, kurtosis, crest factor, spectral kurtosis."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.indicator import BOOK, OF_CHANNEL, STILL, indicator, only_of
from diagnostics.records.channel_quantities import RECORDED

UNDEFINED_BELOW = 1e-9
"""A standard deviation below this share of the rms of the signal (or of a reference) is numerical dust."""


@indicator(
    "rms",
    "RMS",
    signal="record",
    formula="sqrt(mean x²)",
    unit=OF_CHANNEL,
    known="Gaussian σ; sine A/√2",
    undefined="never",
    source=BOOK,
)
def rms(signal: np.ndarray) -> float:
    """Return sqrt(mean(x^2)) in the unit of the signal.

    Gaussian: sigma; sine: amplitude / sqrt(2). MATLAB's `gearConditionMetrics` takes it of the synchronous average.
    Source: standard literature.
    """
    return math.sqrt(mean(np.square(signal)))


def mean(values: np.ndarray) -> float:
    """Return the mean of values (n,) as `numpy.mean` does, whose overhead is most of its time on one revolution."""
    return float(np.add.reduce(values)) / values.size


def moment_ratio(signal: np.ndarray, order: int, reference_rms: float | None = None) -> float:
    """Return mu_k / mu_2^(k/2); NaN ("undefined") where the signal does not vary.

    Parameters
    ----------
    signal : (n,) float64
        Signal.
    order : int
        k, even.
    reference_rms : float, optional
        What "does not vary" is measured by: a standard deviation below 1e-9 of it. Default: the rms of the signal.

    Notes
    -----
    k = 4, 6, 8: Gaussian 3, 15, 105; sine 1.5, 2.5, 4.375. Source: standard literature.
    """
    centred = signal - mean(signal)
    squared = centred * centred
    variance = mean(squared)
    reference = rms(signal) if reference_rms is None else reference_rms
    if not math.sqrt(variance) > UNDEFINED_BELOW * reference:
        return math.nan
    if order == 4:
        return mean(squared * squared) / variance**2
    scaled = centred / math.sqrt(variance)
    return mean((scaled * scaled) ** (order // 2))


@indicator(
    "kurtosis",
    "Kurtosis",
    signal="record",
    formula="μ₄/μ₂²",
    known="Gaussian 3; sine 1.5",
    undefined=STILL,
    source=BOOK,
)
def kurtosis(signal: np.ndarray, reference_rms: float | None = None) -> float:
    """Return mu_4 / mu_2^2 of a record, an average or a part of it; see `moment_ratio`.

    MATLAB's `gearConditionMetrics` takes it of the synchronous average.
    """
    return moment_ratio(signal, 4, reference_rms)


@only_of(RECORDED.word)  # of a speed it tells the mean alone
@indicator(
    "crest_factor",
    "Crest factor",
    signal="record",
    formula="max|x|/rms",
    known="sine √2",
    undefined="the signal is zero",
    source=BOOK,
)
def crest_factor(signal: np.ndarray) -> float:
    """Return max |x| / rms(x); NaN for a signal of zeros.

    Sine: sqrt(2). MATLAB's `gearConditionMetrics` takes it of the synchronous average. Source: standard literature.
    """
    level = rms(signal)
    return float(np.abs(signal).max()) / level if level > 0.0 else math.nan


@indicator(
    "spectral_kurtosis_maximum",
    "Largest spectral kurtosis",
    signal="record, Hann frames of 512 samples, half overlapping",
    formula="max over f of ⟨|X|⁴⟩/⟨|X|²⟩² − 2",
    known="Gaussian about 0; steady tone −1",
    undefined="no band holds power, or the record holds fewer than eight frames",
    source="Antoni 2006; MATLAB pkurtosis has the same formula, other frames",
)
def spectral_kurtosis_maximum(spectral_kurtosis: np.ndarray) -> float:
    """Return max SK(f) without the two outermost bins at either end; NaN where no band is defined.

    Parameters
    ----------
    spectral_kurtosis : (k,) float64
        SK over frequency; NaN where a band is empty.

    Notes
    -----
    Stationary Gaussian noise: about 0, a few 2/sqrt(frames) above; impulses raise it. It depends on the frame's length.
    The outermost bins hold the mean and the anti-alias edge, where spectra are real. Source: Antoni 2006.
    """
    inner = spectral_kurtosis[2:-2]
    defined = inner[np.isfinite(inner)]
    return float(defined.max()) if defined.size else math.nan
