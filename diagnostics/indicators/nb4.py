"""NB4: NA4's form for the envelope of the average, band-passed round the dominant mesh harmonic."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnostics.indicators.na4 import na4
from diagnostics.signal.mesh_band import mesh_baseband


def nb4(averages: Sequence[np.ndarray], teeth: int, harmonic: int, half_width: int) -> float:
    """Return N sum (s_M - mean)^4 / {(1/M) sum_j sum (s_j - mean)^2}^2 with s = |b + j H(b)| of the mesh band b.

    Parameters
    ----------
    averages : sequence of (n,) float64
        Synchronous averages of one machine in chronological order, the last one judged.
    teeth : int
        Teeth on the shaft.
    harmonic : int
        The dominant mesh harmonic; the same for the whole history (`dominant_harmonic` of its first record).
    half_width : int
        Sidebands on each side in the band.

    Notes
    -----
    Envelope of band-passed Gaussian noise (Rayleigh): 3.245 at the first record. NaN where no envelope varies. Source:
    Zakrajsek, Handschuh & Decker 1994.
    """
    return na4([np.abs(mesh_baseband(average, teeth, harmonic, half_width)) for average in averages])


def dominant_harmonic(amplitude: np.ndarray, teeth: int, harmonics: int) -> int:
    """Return the mesh harmonic 1 ... harmonics of largest amplitude, from line amplitudes at whole shaft orders."""
    return 1 + int(np.argmax(amplitude[teeth : harmonics * teeth + 1 : teeth]))
