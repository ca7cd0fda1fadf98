"""Band of an average round one mesh harmonic, by zeroing of whole orders.

Source: standard literature (McFadden 1986 for its demodulation); orders as in the difference signal.
"""

from __future__ import annotations

import numpy as np


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

    spectrum = fft.rfft(average)
    centre = harmonic * teeth
    if not 0 <= 2 * half_width < teeth or centre + half_width >= spectrum.size:
        raise ValueError(
            f"band of {half_width} orders round {centre}: allowed are 0 <= half width < {teeth / 2:g} and orders "
            f"below {spectrum.size}"
        )
    kept = np.zeros_like(spectrum)
    kept[centre - half_width : centre + half_width + 1] = spectrum[centre - half_width : centre + half_width + 1]
    return np.asarray(fft.irfft(kept, n=average.size))
