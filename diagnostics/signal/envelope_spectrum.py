"""Spectrum of the envelope of a record over shaft orders: what modulates the mesh lines and all that rings with them.

The envelope is the magnitude of the analytic signal of everything above half the mesh order. Of A (1 + m cos(angle))
cos(z angle) it is A (1 + m cos(angle)), so that the line at order 1 is A m. Source: standard literature (Randall 2011,
section 5.5.2 on envelope analysis); the band is ours.
"""

from __future__ import annotations

import numpy as np

from diagnostics.signal.synchronous_average import hann_weights


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
    weighted = (envelope - envelope.mean()) * hann_weights(steps.size)
    return np.asarray(4.0 * np.abs(fft.rfft(weighted)) / steps.size)
