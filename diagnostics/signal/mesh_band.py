"""Bands of an average round its mesh harmonics, by zeroing of whole orders; amplitude and phase of these harmonics.

x = A (1 + a(angle)) cos(h z angle + phi(angle)), read off the analytic signal of the band round the harmonic. Source:
McFadden 1986, standard literature.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.signal.spectrum import power


@dataclass(frozen=True, slots=True)
class Modulation:
    """Amplitude (n,) in the unit of the signal and phase (n,) [rad] of a mesh harmonic over one revolution."""

    amplitude: np.ndarray
    phase_rad: np.ndarray


def demodulated(average: np.ndarray, teeth: int, harmonics: int, half_width: int) -> tuple[Modulation, ...]:
    """Return the modulation of every mesh harmonic; phases are unwrapped and have their mean removed.

    Parameters
    ----------
    average, teeth, harmonics, half_width
        As of `mesh_basebands`.
    """
    basebands = mesh_basebands(average, teeth, harmonics, half_width)
    phase = np.unwrap(np.angle(basebands), axis=1)
    phase -= phase.mean(axis=1, keepdims=True)
    return tuple(map(Modulation, np.sqrt(power(basebands)), phase))


def mesh_basebands(average: np.ndarray, teeth: int, harmonics: int, half_width: int) -> np.ndarray:
    """Return the analytic signals of bands round mesh harmonics 1 ... h, each shifted down to order zero.

    Parameters
    ----------
    average : (n,) float64
        One revolution at equal angle steps.
    teeth : int
        Teeth on the shaft.
    harmonics : int
        h.
    half_width : int
        Sidebands kept on each side; below teeth / 2, so that bands of neighbouring harmonics do not meet.

    Returns
    -------
    (h, n) complex128
        Complex amplitudes of the harmonics; their magnitudes are the envelopes of the bands.

    Raises
    ------
    ValueError
        If a band reaches the next mesh harmonic's or leaves the spectrum.
    """
    from scipy import fft

    spectrum, last = 2.0 * fft.rfft(average), harmonics * teeth + half_width
    if not 0 <= 2 * half_width < teeth or last >= spectrum.size:
        raise ValueError(
            f"bands of {half_width} orders up to order {last}: allowed are 0 <= half width < {teeth / 2:g} and orders "
            f"below {spectrum.size}"
        )
    if average.size % 2 == 0:
        spectrum[-1] /= 2.0  # the last line of an even length is its own mirror image
    kept = np.zeros((harmonics, average.size), dtype=np.complex128)
    for row, centre in zip(kept, range(teeth, harmonics * teeth + 1, teeth), strict=True):
        row[: half_width + 1] = spectrum[centre : centre + half_width + 1]
        row[average.size - half_width :] = spectrum[centre - half_width : centre]
    return np.asarray(fft.ifft(kept, axis=1))
