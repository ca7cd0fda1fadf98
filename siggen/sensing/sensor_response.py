"""Frequency responses of an accelerometer: resonance on its mounting or of itself, coupling capacitor.

Sources: second-order resonator 1 / (1 - x² + 2 i ζ x), x = f/f_0, and first-order high-pass i x / (1 + i x), x = f/f_c
(reference: standard literature).
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import ComplexArray, FloatArray


def resonance_response(frequency_hz: FloatArray, natural_hz: float, damping_ratio: float) -> ComplexArray:
    """Return reading over base motion (k,) of a mass on a spring at frequencies (k,).

    Raises
    ------
    ValueError
        If natural frequency or damping ratio are not positive.
    """
    if not (natural_hz > 0.0 and damping_ratio > 0.0):
        raise ValueError(f"resonance: received {natural_hz} Hz, {damping_ratio}; allowed are values above 0")
    x = frequency_hz / natural_hz
    return np.asarray(1.0 / (1.0 - x**2 + 2j * damping_ratio * x), dtype=np.complex128)


def high_pass_response(frequency_hz: FloatArray, corner_hz: float) -> ComplexArray:
    """Return the response (k,) of a coupling capacitor: 0 at frequency 0, -3 dB at the corner.

    Raises
    ------
    ValueError
        If the corner is not positive.
    """
    if not corner_hz > 0.0:
        raise ValueError(f"corner_hz: received {corner_hz}; allowed are values above 0")
    x = 1j * frequency_hz / corner_hz
    return x / (1.0 + x)
