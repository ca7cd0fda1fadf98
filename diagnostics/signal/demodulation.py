"""Amplitude and phase of one mesh harmonic over a revolution.

x = A (1 + a(angle)) cos(h z angle + phi(angle)), read off the analytic signal of the band round the harmonic. Source:
McFadden 1986, standard literature.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.signal.mesh_band import mesh_band


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
