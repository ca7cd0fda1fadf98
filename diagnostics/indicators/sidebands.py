"""Indicators of lines of an average: sidebands, modulation, and the share of bands of orders."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.indicator import BOOK, NO_LINE, OF_CHANNEL, indicator
from diagnostics.indicators.level import UNDEFINED_BELOW, mean, moment_ratio, rms
from diagnostics.signal.mesh_band import Modulation
from diagnostics.signal.order_bands import localised_energy
from diagnostics.signal.spectrum import line_amplitudes, power

DEEPEST_RAD = 1.0

OUTSIDE = "the record carries less than half of the band, or the band is below 1e-9 of the average"


@indicator(
    "sideband_index_{shaft}_h1",
    "SI",
    signal="lines of the average",
    formula="[A(z − 1) + A(z + 1)]/2",
    unit=OF_CHANNEL,
    known="AM of index m: A m/2",
    undefined=NO_LINE,
    source="Szczepanik",
)
def sideband_index(sideband_lines: np.ndarray, teeth: int, harmonic: int = 1) -> float:
    """Return [A(h z - 1) + A(h z + 1)] / 2 in the unit of the signal, not divided by the mesh line.

    Parameters
    ----------
    sideband_lines : (orders,) float64
        Line amplitudes at whole orders of the shaft; NaN marks an unresolved line.
    teeth : int
        Teeth on the shaft.
    harmonic : int
        Mesh harmonic h; the usual index takes the first.

    Notes
    -----
    Modulation of index m of a mesh line of amplitude A: A m / 2. Source: Szczepanik, as in standard literature.
    """
    line = harmonic * teeth
    if line + 1 >= sideband_lines.size:
        return math.nan
    return 0.5 * float(sideband_lines[line - 1] + sideband_lines[line + 1])


@indicator(
    "sideband_level_factor_{shaft}_h1",
    "SLF",
    signal="lines of the average",
    formula="[A(z − 1) + A(z + 1)]/std(average)",
    known="AM of index m: √2 m/√(1 + m²/2)",
    undefined="the average does not vary",
    source="Szczepanik",
)
def sideband_level_factor(sideband_lines: np.ndarray, average: np.ndarray, teeth: int, harmonic: int = 1) -> float:
    """Return [A(h z - 1) + A(h z + 1)] / std(average); NaN where the average does not vary.

    Parameters
    ----------
    sideband_lines, teeth, harmonic
        As of `sideband_index`.
    average : (n,) float64
        Synchronous average of the same shaft.

    Notes
    -----
    One mesh line with modulation index m: sqrt(2) m / sqrt(1 + m^2 / 2). Source: Szczepanik, as in standard literature.
    """
    spread = float(average.std())
    return 2.0 * sideband_index(sideband_lines, teeth, harmonic) / spread if spread > 0.0 else math.nan


def relative_amplitude(sideband_lines: np.ndarray, teeth: int, harmonic: int, offset: int) -> float:
    """Return A(h z + offset) / A(h z).

    Parameters
    ----------
    sideband_lines : (orders,) float64
        Line amplitudes at whole orders of the shaft; NaN marks an unresolved line.
    teeth : int
        Teeth on the shaft.
    harmonic : int
        Mesh harmonic h, from 1.
    offset : int
        Sideband, negative below the mesh line; |offset| < teeth / 2, so that it belongs to this harmonic.

    Notes
    -----
    NaN where the sideband lies outside the band, nearer to another mesh line, is unresolved, or the mesh line is below
    1e-9 of the strongest line. Source: standard literature.
    """
    line, order = harmonic * teeth, harmonic * teeth + offset
    if 2 * abs(offset) >= teeth or order >= sideband_lines.size or line >= sideband_lines.size:
        return math.nan
    carrier = float(sideband_lines[line])
    strongest = float(
        np.fmax.reduce(sideband_lines)
    )  # of those that are no NaN, as `numpy.nanmax`, in a tenth of its time
    return float(sideband_lines[order]) / carrier if carrier > UNDEFINED_BELOW * strongest else math.nan


@indicator(
    "sideband_{shaft}_h{harmonic}_{side}{sideband}",
    "Sideband amplitude",
    signal="lines of the average",
    formula="A(h z ∓ k)/A(h z), k = 1 … 6 on each side",
    known="AM of index m by a sine: m/2",
    undefined=NO_LINE,
    source=BOOK,
)
def sideband_amplitude(sideband_lines: np.ndarray, teeth: int, harmonic: int, side: str, sideband: int) -> float:
    """Return the amplitude of one sideband over its mesh line; `side` is `lower` or `upper`.

    Amplitude modulation of index m by a sine gives m/2 on both sides; NaN as of `relative_amplitude`.
    """
    return relative_amplitude(sideband_lines, teeth, harmonic, sideband if side == "upper" else -sideband)


@indicator(
    "sideband_ratio_{shaft}_h{harmonic}_k{ratio_sidebands}",
    "SER",
    signal="lines of the average",
    formula="Σ A(h z ∓ k)/A(h z), k = 1 … 3",
    known="AM of index m: m",
    undefined=NO_LINE,
    source="Hanna et al. (trademark)",
)
def sideband_ratio(sideband_lines: np.ndarray, teeth: int, harmonic: int, ratio_sidebands: int = 3) -> float:
    """Return the sum of A(h z -+ k), k = 1 ... ratio_sidebands, over A(h z); NaN as of `relative_amplitude`.

    Three sidebands on each side (six lines) is the definition of Hanna et al.; others take six. Modulation by one sine
    of index m: m. "SER" is a trademark of its authors.
    """
    offsets = [sign * k for k in range(1, ratio_sidebands + 1) for sign in (-1, 1)]
    return float(sum(relative_amplitude(sideband_lines, teeth, harmonic, offset) for offset in offsets))


@indicator(
    "sideband_power_{shaft}_h{harmonics}_k{sideband}",
    "Sideband power",
    signal="lines of the average",
    formula="Σ_h [A²(h z − k) + A²(h z + k)]/Σ_h A²(h z), h = 1 … 5",
    known="AM of index m at order k: m²/2",
    undefined=NO_LINE,
    source="derived",
)
def sideband_power(sideband_lines: np.ndarray, teeth: int, sideband: int, harmonics: int) -> float:
    """Return sum_h [A(h z - k)^2 + A(h z + k)^2] / sum_h A(h z)^2, h = 1 ... harmonics.

    Parameters
    ----------
    sideband_lines : (orders,) float64
        Line amplitudes at whole orders of the shaft; NaN marks an unresolved line and makes the ratio undefined.
    teeth : int
        Teeth on the shaft.
    sideband : int
        k, below teeth / 2.
    harmonics : int
        Mesh harmonics in both sums; the value depends on it.

    Notes
    -----
    Amplitude modulation of index m at shaft order k: m^2 / 2. NaN where no mesh line stands above 1e-9 of the strongest
    line, or a sideband lies outside the band or nearer to another mesh line. Source: derived from Parseval's theorem.
    """
    mesh = teeth * np.arange(1, harmonics + 1)
    if 2 * sideband >= teeth or mesh[-1] + sideband >= sideband_lines.size:
        return math.nan
    carrier = float(np.sum(sideband_lines[mesh] ** 2))
    if not math.sqrt(carrier) > UNDEFINED_BELOW * float(np.fmax.reduce(sideband_lines)):
        return math.nan
    beside = sideband_lines[mesh - sideband] ** 2 + sideband_lines[mesh + sideband] ** 2
    return float(np.sum(beside)) / carrier


@indicator(
    "sideband_asymmetry_{shaft}_h{harmonic}",
    "Sideband asymmetry",
    signal="lines of the average",
    formula="20 lg A(h z + 1)/A(h z − 1)",
    unit="dB",
    known="AM or PM alone: 0",
    undefined=NO_LINE,
    source="derived",
)
def sideband_asymmetry_db(sideband_lines: np.ndarray, teeth: int, harmonic: int, order: int = 1) -> float:
    """Return 20 log10 A(h z + k) / A(h z - k), with k = order.

    Pure amplitude or pure phase modulation: 0 dB; both together, in phase or not, and any resonance nearby, tilt it.
    NaN where a sideband is zero, unresolved or outside the band. Source: derived.
    """
    lower, upper = (relative_amplitude(sideband_lines, teeth, harmonic, sign * order) for sign in (-1, 1))
    return 20.0 * math.log10(upper / lower) if lower > 0.0 and upper > 0.0 else math.nan


@indicator(
    "amplitude_modulation_{shaft}_h{demodulated_harmonic}",
    "AM depth",
    signal="average within six sidebands of h z, demodulated",
    formula="order 1 of the amplitude over its mean",
    known="1 + m cos θ: m",
    undefined="the mesh harmonic is zero or the sideband is unresolved",
    source="McFadden 1986",
)
def amplitude_modulation(modulation: Modulation, order: int = 1) -> float:
    """Return m of A (1 + m cos(k angle + ...)).

    Parameters
    ----------
    modulation : Modulation
        Amplitude and phase of a mesh harmonic over one revolution.
    order : int
        Shaft order k of the modulation.

    Notes
    -----
    1 + m cos: m for m <= 1. NaN where the harmonic is zero. Source: McFadden 1986.
    """
    lines = line_amplitudes(modulation.amplitude)
    return float(lines[order] / lines[0]) if lines[0] > 0.0 else math.nan


@indicator(
    "phase_modulation_{shaft}_h{demodulated_harmonic}",
    "PM depth",
    signal="average within six sidebands of h z, demodulated",
    formula="order 1 of the phase",
    unit="rad",
    known="β sin θ: β",
    undefined="the depth exceeds 1 rad (a mesh line weaker than its sidebands), or the sideband is unresolved",
    source="McFadden 1986",
)
def phase_modulation_rad(modulation: Modulation, order: int = 1) -> float:
    """Return beta of cos(h z angle + beta sin(k angle + ...)) [rad]; NaN where the phase swings beyond 1 rad.

    Parameters
    ----------
    modulation, order
        As of `amplitude_modulation`.

    Notes
    -----
    Undefined beyond 1 rad: such depths come from a mesh line weaker than its sidebands, whose phase then winds. Source:
    McFadden 1986; the limit is derived.
    """
    if not modulation.amplitude.max() > 0.0:
        return math.nan
    depth = float(line_amplitudes(modulation.phase_rad)[order])
    return depth if depth <= DEEPEST_RAD and np.ptp(modulation.phase_rad) < 2.0 * np.pi else math.nan


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
    if not math.sqrt(mean(power(residual_band))) > UNDEFINED_BELOW * rms(average):
        return math.nan
    return localised_energy(residual_band, teeth)
