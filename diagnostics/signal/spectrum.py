"""Line amplitudes at whole shaft orders, and which sidebands of a shaft a record can resolve.

Source: standard literature; the resolution rule is derived from the half width of the Hann main lobe, two bins.

OrderSpectrum: amplitudes of a record over whole revolutions of a shaft.

Lines of a record in the order domain and the noise between them, from its Hann spectrum over whole revolutions.

A line is the largest amplitude within two bins of its order, so that lines near the noise come out too high, as they do
where the ranges of healthy gearboxes were measured. Source: standard literature; noise bandwidth of the Hann window
1.5 bins, derived.

Spectrum of the envelope of a record over shaft orders: what modulates the mesh lines and all that rings with them.

The envelope is the magnitude of the analytic signal of everything above half the mesh order. Of A (1 + m cos(angle))
cos(z angle) it is A (1 + m cos(angle)), so that the line at order 1 is A m. Source: standard literature (Randall 2011,
section 5.5.2 on envelope analysis); the band is ours.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from diagnostics.signal.order_domain import SAMPLES_PER_TOOTH, angle_grid, resample_to_angle
from diagnostics.signal.turn_spectrum import turn_lines

REACH_BINS = 2
HANN_NOISE_BINS = 1.5
NOISE_REACH_ORDERS = 8.0
FEWEST_NOISE_BINS = 16

HANN_HALF_WIDTH_BINS = 2.0


def envelope_spectrum(steps: np.ndarray, revolutions: int, teeth: int) -> np.ndarray:
    """Return single-sided amplitudes of the envelope at orders 0, 1/revolutions, 2/revolutions ...

    Parameters
    ----------
    steps : (n,) float64
        Record at equal angle steps over whole revolutions.
    revolutions : int
        Whole revolutions.
    teeth : int
        Teeth on the shaft; what lies below teeth / 2 orders is left out of the envelope.

    Returns
    -------
    (n // 2 + 1,) float64
        Hann amplitudes in the unit of the signal. The envelope's mean is taken away before.
    """
    from scipy import fft

    spectrum = fft.rfft(steps)
    spectrum[: teeth * revolutions // 2] = 0.0
    doubled = np.zeros(steps.size, dtype=np.complex128)
    doubled[: spectrum.size] = 2.0 * spectrum
    envelope = np.abs(fft.ifft(doubled))
    return hann_amplitude((envelope - envelope.mean()).reshape(revolutions, -1))


def hann_amplitude(steps: np.ndarray) -> np.ndarray:
    """Return single-sided amplitudes of a Hann-weighted signal, (n // 2 + 1,) float64 in its unit.

    Parameters
    ----------
    steps : (n,) or (turns, n / turns) float64
        In whole turns it costs less.
    """
    from scipy import fft

    # the window is a cosine: in the spectrum each line less half of its neighbours
    lines = fft.rfft(steps) if steps.ndim == 1 else turn_lines(steps).spectrum()
    beside = np.empty_like(lines)
    np.add(lines[:-2], lines[2:], out=beside[1:-1])
    beside[0] = 2.0 * lines[1].real
    beside[-1] = lines[-2] + lines[steps.size - lines.size].conj()  # of an odd length the last line itself
    beside *= 0.5
    lines -= beside
    found = power(lines)
    np.sqrt(found, out=found)
    found *= 2.0 / steps.size
    return found


def power(lines: np.ndarray) -> np.ndarray:
    """Return the squared magnitude of complex values; that of `numpy.abs`, safe from overflow, takes twice as long."""
    found = np.square(lines.real)
    found += np.square(lines.imag)
    return np.asarray(found)


@dataclass(frozen=True, slots=True)
class OrderSpectrum:
    """Hann spectrum of a record over whole pinion revolutions: pinion orders (n,) and amplitudes (n,) [m/s^2]."""

    order: np.ndarray
    amplitude_m_s2: np.ndarray
    revolutions: int


def order_spectrum(signal: np.ndarray, tacho_s: np.ndarray, fs_hz: float, teeth_pinion: int) -> OrderSpectrum:
    """Return the Hann spectrum of a record over all its whole pinion revolutions."""
    grid = angle_grid(tacho_s, teeth_pinion * SAMPLES_PER_TOOTH)
    amplitude = hann_amplitude(resample_to_angle(signal, fs_hz, grid).reshape(grid.revolutions, -1))
    return OrderSpectrum(np.arange(amplitude.size) / grid.revolutions, amplitude, grid.revolutions)


def strongest_harmonic(spectrum: OrderSpectrum, teeth_pinion: int) -> int:
    """Return the mesh harmonic with the largest line among those whose sidebands lie inside the band."""
    bins = np.arange(teeth_pinion, int(spectrum.order[-1]) - teeth_pinion, teeth_pinion) * spectrum.revolutions
    return int(spectrum.amplitude_m_s2[bins].argmax()) + 1


@dataclass(frozen=True, slots=True)
class OrderLines:
    """Hann amplitude spectrum over whole pinion revolutions.

    Attributes
    ----------
    amplitude : (bins,) float64
        Single-sided; a sine of amplitude a at a whole order gives a.
    revolutions : int
        Bins per pinion order.
    bin_hz : float
        Width of a bin at the mean speed [Hz].
    """

    amplitude: np.ndarray
    revolutions: int
    bin_hz: float

    def line(self, order: float) -> float:
        """Return the amplitude of the line at an order: the maximum within two bins; NaN outside the band."""
        centre = round(order * self.revolutions)
        if centre - REACH_BINS < 0 or centre + REACH_BINS >= self.amplitude.size:
            return math.nan
        return float(self.amplitude[centre - REACH_BINS : centre + REACH_BINS + 1].max())


def order_lines(turns: np.ndarray, duration_s: float) -> OrderLines:
    """Return the Hann spectrum of whole revolutions.

    Parameters
    ----------
    turns : (revolutions, steps) float64
        Signal at equal angle steps, one row per revolution.
    duration_s : float
        Time from the first to the last pulse [s].
    """
    return OrderLines(hann_amplitude(turns), turns.shape[0], 1.0 / duration_s)


def noise_density(lines: OrderLines, teeth: tuple[int, int], harmonic: int = 1) -> float:
    """Return the power density between the lines within 8 orders of a mesh line [unit^2/Hz]; NaN without such bins.

    Parameters
    ----------
    lines : OrderLines
        Spectrum of the record.
    teeth : (int, int)
        Teeth of pinion and gear. Bins within two of a pinion order are left out, and those of the gear's orders too
        where the record is long enough to leave at least 16 bins.
    harmonic : int
        Mesh harmonic, from 1.
    """
    centre = harmonic * teeth[0]
    first, last = (round((centre + side * NOISE_REACH_ORDERS) * lines.revolutions) for side in (-1, 1))
    bins = np.arange(max(first, 0), min(last, lines.amplitude.size - 1) + 1)
    order = bins / lines.revolutions
    between = _distance_bins(order, 1.0, lines.revolutions) > REACH_BINS
    fine = between & (_distance_bins(order, teeth[0] / teeth[1], lines.revolutions) > REACH_BINS)
    kept = fine if np.count_nonzero(fine) >= FEWEST_NOISE_BINS else between
    if not kept.any():
        return math.nan
    power = 0.5 * float(np.mean(np.square(lines.amplitude[bins[kept]])))
    return power / (HANN_NOISE_BINS * lines.bin_hz)


def _distance_bins(order: np.ndarray, spacing: float, revolutions: int) -> np.ndarray:
    """Return how many bins each order lies away from the nearest multiple of a spacing."""
    return np.asarray(np.abs(order - np.round(order / spacing) * spacing) * revolutions)


def line_amplitudes(average: np.ndarray) -> np.ndarray:
    """Return single-sided amplitudes at shaft orders 0, 1, 2 ... of one averaged revolution.

    Parameters
    ----------
    average : (n,) float64
        One revolution at equal angle steps.

    Returns
    -------
    (n // 2 + 1,) float64
        Amplitude in the unit of the signal; a sine of amplitude a at order k gives a at index k.
    """
    from scipy import fft

    amplitude = 2.0 * np.abs(fft.rfft(average)) / average.size
    amplitude[0] /= 2.0
    if average.size % 2 == 0:
        amplitude[-1] /= 2.0
    return np.asarray(amplitude)


def revolutions_needed(order: int, teeth: int, other_teeth: int) -> float:
    """Return the revolutions of a shaft from which its sideband `order` stands clear of the other shaft's sidebands.

    With Hann weighting two lines are apart from two bins on. The other shaft's sidebands lie at multiples of
    teeth / other_teeth orders (distance from the mesh line, counted in orders of this shaft), and the mesh line at
    zero.

    Parameters
    ----------
    order : int
        Sideband number, 1 or more.
    teeth : int
        Teeth on the shaft whose sideband is meant.
    other_teeth : int
        Teeth of the mating gear.

    Returns
    -------
    float
        Revolutions; infinite where both shafts have a line at this very order.
    """
    ratio = teeth / other_teeth
    nearest = abs(order - round(order / ratio) * ratio)
    if nearest < 1e-9:
        return np.inf
    return HANN_HALF_WIDTH_BINS / min(nearest, 1.0)


def resolved_lines(amplitude: np.ndarray, resolved: np.ndarray, teeth: int) -> np.ndarray:
    """Return the amplitudes with every unresolved sideband set to NaN.

    Parameters
    ----------
    amplitude : (orders,) float64
        Line amplitudes at whole shaft orders.
    resolved : (k,) bool
        Whether sidebands -+1 ... -+k of the mesh lines are resolved.
    teeth : int
        Teeth on the shaft; mesh lines lie at its multiples.
    """
    marked = amplitude.copy()
    order = np.arange(amplitude.size)
    distance = np.abs((order + teeth // 2) % teeth - teeth // 2)
    for k, fine in enumerate(resolved, start=1):
        if not fine:
            marked[distance == k] = np.nan
    return marked
