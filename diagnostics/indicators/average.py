"""Indicators of a shaft's synchronous average and of its parts: regular, residual and difference signal."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.indicator import BOOK, CONDITION_METRICS, OF_CHANNEL, STILL, indicator
from diagnostics.indicators.level import UNDEFINED_BELOW, crest_factor, kurtosis, moment_ratio, rms

AT_ONCE = 16
"""Revolutions whose differences from the average stay in the second cache."""

NO_DIFFERENCE = "the difference signal is below 1e-9 of the average (perfect gears)"


@indicator(
    "mesh_amplitude_h{harmonic}",
    "Mesh amplitude",
    signal="average",
    formula="A(h z)",
    unit=OF_CHANNEL,
    known="A cos(h z θ): A",
    undefined="never",
    source=BOOK,
)
def mesh_amplitude(lines: np.ndarray, teeth: int, harmonic: int) -> float:
    """Return the amplitude of mesh harmonic h of the pinion's average; NaN above the band. Source: standard."""
    return float(lines[harmonic * teeth]) if harmonic * teeth < lines.size else math.nan


@indicator(
    "average_rms_{shaft}",
    "RMS of the average",
    signal="average",
    formula="sqrt(mean x²)",
    unit=OF_CHANNEL,
    known="sine A/√2",
    undefined="never",
    source=BOOK,
)
def average_rms(average: np.ndarray) -> float:
    """Return the rms of the average."""
    return rms(average)


@indicator(
    "average_kurtosis_{shaft}",
    "Kurtosis of the average",
    signal="average",
    formula="μ₄/μ₂²",
    known="Gaussian 3; sine 1.5",
    undefined=STILL,
    source=f"{BOOK}; {CONDITION_METRICS} takes the average too",
)
def average_kurtosis(average: np.ndarray) -> float:
    """Return the kurtosis of the average."""
    return kurtosis(average)


@indicator(
    "average_crest_factor_{shaft}",
    "Crest factor of the average",
    signal="average",
    formula="max|x|/rms",
    known="sine √2",
    undefined="the average is zero",
    source=f"{BOOK}; {CONDITION_METRICS} takes the average too",
)
def average_crest_factor(average: np.ndarray) -> float:
    """Return the crest factor of the average."""
    return crest_factor(average)


@indicator(
    "noise_share_{shaft}",
    "Noise share of the average",
    signal="revolutions and their average",
    formula="variance between revolutions/(M variance of the average)",
    known="nothing locked to the shaft: 1",
    undefined="fewer than two revolutions",
    source="derived",
)
def noise_share(revolutions: np.ndarray, average: np.ndarray) -> float:
    """Return the share of the variance of the synchronous average that is left-over noise; NaN below two revolutions.

    Estimated as the variance between revolutions at equal angle (unbiased, M - 1), mean over the angle, over M, by the
    variance of the average. It is 1 where nothing is locked to the shaft. Source: derived.

    Parameters
    ----------
    revolutions : (M, n) float64
        Whole revolutions at equal angle steps, one row each.
    average : (n,) float64
        Their mean.
    """
    count = len(revolutions)
    if count < 2:
        return math.nan
    variance = float(average.var())
    squares = (float(np.square(some - average).sum()) for some in np.array_split(revolutions, -(-count // AT_ONCE)))
    left = sum(squares) / (revolutions.size - average.size) / count
    return min(left / variance, 1.0) if variance > 0.0 else math.nan


@indicator(
    "residual_rms_{shaft}",
    "RMS of the residual",
    signal="residual",
    formula="sqrt(mean r²)",
    unit=OF_CHANNEL,
    known="sine A/√2",
    undefined="never",
    source="Lebold 2000",
)
def residual_rms(residual: np.ndarray) -> float:
    """Return the rms of the average without shaft orders and mesh harmonics. Source: Lebold et al. 2000."""
    return rms(residual)


@indicator(
    "difference_rms_{shaft}",
    "RMS of the difference",
    signal="difference",
    formula="sqrt(mean d²)",
    unit=OF_CHANNEL,
    known="sine A/√2",
    undefined="never",
    source="Lebold 2000",
)
def difference_rms(difference: np.ndarray) -> float:
    """Return the rms of the residual without first-order sidebands. Source: Lebold et al. 2000."""
    return rms(difference)


@indicator(
    "fm0_{shaft}_h{harmonics}",
    "FM0",
    signal="average",
    formula="(max x − min x)/Σ A(h z), h = 1 … 5",
    known="single mesh line: 2",
    undefined="the mesh lines are below 1e-9 of the peak-to-peak",
    source=f"Stewart 1977; {CONDITION_METRICS} takes average and regular signal, so its sum may differ",
)
def fm0(average: np.ndarray, lines: np.ndarray, teeth: int, harmonics: int) -> float:
    """Return (max x - min x) / sum of A(h z), h = 1 ... harmonics.

    Parameters
    ----------
    average : (n,) float64
        Synchronous average, one revolution.
    lines : (orders,) float64
        Its line amplitudes at whole shaft orders.
    teeth : int
        Teeth on the shaft.
    harmonics : int
        Mesh harmonics in the sum; the value depends on it.

    Notes
    -----
    One mesh line alone: 2. NaN where the lines are below 1e-9 of the peak-to-peak. MATLAB's `gearConditionMetrics`
    takes average and regular signal; how it forms the sum was not found stated, so its values may differ. Source:
    Stewart 1977.
    """
    swing = float(average.max() - average.min())
    total = float(lines[teeth : harmonics * teeth + 1 : teeth].sum())
    return swing / total if total > UNDEFINED_BELOW * swing else math.nan


@indicator(
    "fm4_{shaft}",
    "FM4",
    signal="difference",
    formula="μ₄/μ₂²",
    known="Gaussian 3; sine 1.5",
    undefined=NO_DIFFERENCE,
    source=f"Stewart 1977; {CONDITION_METRICS} takes the difference too",
)
def fm4(difference: np.ndarray, average: np.ndarray) -> float:
    """Return mu_4(d) / mu_2(d)^2; NaN ("undefined") where the difference signal is below 1e-9 of the average.

    Parameters
    ----------
    difference : (n,) float64
        Average without shaft orders, mesh harmonics and their first-order sidebands.
    average : (n,) float64
        The average itself, which sets the guard: perfect gears make FM4 a ratio of rounding errors.

    Notes
    -----
    Gaussian: 3. Not monotone in severity: pitting over many teeth lowers it again. Source: Stewart 1977.
    """
    return moment_ratio(difference, 4, rms(average))


@indicator(
    "m6a_{shaft}",
    "M6A",
    signal="difference",
    formula="N² Σd⁶/(Σd²)³",
    known="Gaussian 15; sine 2.5",
    undefined=NO_DIFFERENCE,
    source=f"Martin 1989; {CONDITION_METRICS} takes the difference too",
)
def m6a(difference: np.ndarray, average: np.ndarray) -> float:
    """Return N^2 sum (d - mean)^6 / (sum (d - mean)^2)^3; signals and guard as of `fm4`.

    Gaussian: 15; sine: 2.5. More sensitive to single peaks than FM4. Source: Martin 1989.
    """
    return moment_ratio(difference, 6, rms(average))


@indicator(
    "m8a_{shaft}",
    "M8A",
    signal="difference",
    formula="N³ Σd⁸/(Σd²)⁴",
    known="Gaussian 105; sine 4.375",
    undefined=NO_DIFFERENCE,
    source=f"Martin 1989; {CONDITION_METRICS} takes the difference too",
)
def m8a(difference: np.ndarray, average: np.ndarray) -> float:
    """Return N^3 sum (d - mean)^8 / (sum (d - mean)^2)^4; signals and guard as of `fm4`.

    Gaussian: 105; sine: 4.375. The factor is N^3; with N^2, as some code has it, the value falls with the number of
    samples. Source: Martin 1989.
    """
    return moment_ratio(difference, 8, rms(average))


@indicator(
    "energy_ratio_{shaft}",
    "Energy ratio",
    signal="difference and regular",
    formula="std(d)/std(g)",
    known="known parts: their ratio",
    undefined="the regular signal does not vary",
    source=f"Swansson; {CONDITION_METRICS} takes the same ratio",
)
def energy_ratio(difference: np.ndarray, regular: np.ndarray) -> float:
    """Return std(d) / std(g); NaN where the regular signal does not vary.

    Below 1 in a serviceable gearbox as a rule. Source: Swansson, as in standard literature.
    """
    kept = float(regular.std())
    return float(difference.std()) / kept if kept > 0.0 else math.nan


def teager_energy(signal: np.ndarray) -> np.ndarray:
    """Return x_i^2 - x_(i-1) x_(i+1) of a periodic signal, (n,); of A cos(w i) it is A^2 sin^2(w)."""
    return np.asarray(signal * signal - np.roll(signal, 1) * np.roll(signal, -1))


@indicator(
    "energy_operator_teager_{shaft}",
    "Energy operator (Teager)",
    signal="residual",
    formula="kurtosis of x_i² − x_(i−1) x_(i+1)",
    known="undefined for a tone",
    undefined="the energy does not vary",
    source="Ma 1995; Kaiser 1990",
)
def energy_operator_teager(residual: np.ndarray) -> float:
    """Return the kurtosis of the Teager energy of a residual signal; NaN where that energy does not vary.

    Parameters
    ----------
    residual : (n,) float64
        One revolution without shaft orders and mesh harmonics; periodic, so that no sample is lost at its ends.

    Notes
    -----
    A single tone has constant energy, so the value is undefined. It depends on the angle steps per revolution. Source:
    Ma 1995; Teager's operator after Kaiser 1990.
    """
    return kurtosis(teager_energy(residual))


@indicator(
    "energy_operator_lebold_{shaft}",
    "Energy operator (Lebold)",
    signal="residual",
    formula="kurtosis of x_(i+1)² − x_i²",
    known="sine 1.5",
    undefined="the difference does not vary",
    source="Lebold 2000",
)
def energy_operator_lebold(residual: np.ndarray) -> float:
    """Return the kurtosis of x_(i+1)^2 - x_i^2 of a residual signal; NaN where that difference does not vary.

    This is the operator as the review's text states it, not Teager's. Sine: 1.5 (the difference is a sine of twice the
    order). Source: Lebold et al. 2000.
    """
    squared = residual * residual
    return kurtosis(np.roll(squared, -1) - squared)
