"""Sideband energy ratio (SER): sum of the first sidebands of a mesh harmonic over its mesh line."""

from __future__ import annotations

import numpy as np

from diagnostics.indicators.sideband_amplitude import sideband_amplitude


def sideband_ratio(amplitude: np.ndarray, teeth: int, harmonic: int, sidebands: int = 3) -> float:
    """Return the sum of A(h z -+ k), k = 1 ... sidebands, over A(h z).

    Parameters
    ----------
    amplitude : (orders,) float64
        Line amplitudes at whole orders of the shaft; NaN marks an unresolved line and makes the ratio undefined.
    teeth : int
        Teeth on the shaft.
    harmonic : int
        Mesh harmonic h, from 1.
    sidebands : int
        Sidebands on each side: three (six lines) in the definition of Hanna et al.; others take six.

    Notes
    -----
    Modulation by one sine of index m: m. "SER" is a trademark of its authors.
    """
    offsets = [sign * k for k in range(1, sidebands + 1) for sign in (-1, 1)]
    return float(sum(sideband_amplitude(amplitude, teeth, harmonic, offset) for offset in offsets))
