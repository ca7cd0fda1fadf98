"""Band of an average round one mesh harmonic, by zeroing of whole orders.

Source: standard literature (McFadden 1986 for its demodulation); orders as in the difference signal.

Amplitude and phase of one mesh harmonic over a revolution.

x = A (1 + a(angle)) cos(h z angle + phi(angle)), read off the analytic signal of the band round the harmonic. Source:
McFadden 1986, standard literature.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Modulation:
    """Amplitude (n,) in the unit of the signal and phase (n,) [rad] of a mesh harmonic over one revolution."""

    amplitude: np.ndarray
    phase_rad: np.ndarray


def demodulated(average: np.ndarray, teeth: int, harmonic: int, half_width: int) -> Modulation:
    """Return the modulation of mesh harmonic h; the phase is unwrapped and has its mean removed.

    Parameters
    ----------
    average : (n,) float64
        One revolution at equal angle steps.
    teeth, harmonic, half_width : int
        As of `mesh_band`.
    """
    from scipy.signal import hilbert

    # exact for one revolution, which is periodic
    carrier = np.exp(-2j * np.pi * harmonic * teeth * np.arange(average.size) / average.size)
    baseband = hilbert(mesh_band(average, teeth, harmonic, half_width)) * carrier
    phase = np.unwrap(np.angle(baseband))
    return Modulation(np.abs(baseband), phase - phase.mean())


def mesh_band(average: np.ndarray, teeth: int, harmonic: int, half_width: int) -> np.ndarray:
    """Return what the average holds within `half_width` orders of mesh harmonic h.

    Parameters
    ----------
    average : (n,) float64
        One revolution at equal angle steps.
    teeth : int
        Teeth on the shaft.
    harmonic : int
        h, from 1.
    half_width : int
        Sidebands kept on each side; below teeth / 2, so that bands of neighbouring harmonics do not meet.

    Returns
    -------
    (n,) float64

    Raises
    ------
    ValueError
        If the band reaches the next mesh harmonic's or leaves the spectrum.
    """
    from scipy import fft

    centre = harmonic * teeth
    kept = np.zeros(average.size // 2 + 1, dtype=np.complex128)
    kept[centre - half_width : centre + half_width + 1] = _lines(average, teeth, harmonic, half_width)
    return np.asarray(fft.irfft(kept, n=average.size))


def mesh_baseband(average: np.ndarray, teeth: int, harmonic: int, half_width: int) -> np.ndarray:
    """Return the analytic signal of the mesh band, shifted down to order zero: complex amplitude of the harmonic.

    Parameters
    ----------
    average, teeth, harmonic, half_width
        As of `mesh_band`.

    Returns
    -------
    (n,) complex128
        Its magnitude is the envelope of the band.

    Raises
    ------
    ValueError
        As of `mesh_band`.
    """
    from scipy import fft

    lines = 2.0 * _lines(average, teeth, harmonic, half_width)
    if 2 * (harmonic * teeth + half_width) == average.size:
        lines[-1] /= 2.0  # the last line of an even length is its own mirror image
    kept = np.zeros(average.size, dtype=np.complex128)
    kept[: half_width + 1] = lines[half_width:]
    kept[average.size - half_width :] = lines[:half_width]
    return np.asarray(fft.ifft(kept))


def _lines(average: np.ndarray, teeth: int, harmonic: int, half_width: int) -> np.ndarray:
    """Return the lines of the transform within a mesh band."""
    from scipy import fft

    spectrum = fft.rfft(average)
    centre = harmonic * teeth
    if not 0 <= 2 * half_width < teeth or centre + half_width >= spectrum.size:
        raise ValueError(
            f"band of {half_width} orders round {centre}: allowed are 0 <= half width < {teeth / 2:g} and orders "
            f"below {spectrum.size}"
        )
    return np.asarray(spectrum[centre - half_width : centre + half_width + 1])
