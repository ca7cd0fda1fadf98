"""How far the lines of a shaft stand above what lies midway between them: the evidence that a speed is the shaft's own.

Every tooth differs, so that a gear's signal has lines at all orders of its shaft, however weak; midway between them
there are none. At two thirds or twice of the speed, or where a sideband passes for a mesh line, lines fall midway as
well; at half of the speed every second order is empty. Source: derived.
"""

from __future__ import annotations

import numpy as np

from diagnostics.signal.order_spectrum import order_spectrum

SMALLEST = 1e-12
"""Of the largest amplitude: keeps the logarithm of an empty spectrum finite."""


def shaft_contrast(signal: np.ndarray, pulses_s: np.ndarray, fs_hz: float, teeth: int, highest_hz: float) -> float:
    """Return the mean log amplitude at orders of the shaft minus that half an order above, mesh orders left out.

    Parameters
    ----------
    signal : (n,) float
        The record.
    pulses_s : (k,) float64
        Pulse times of the shaft [s].
    fs_hz : float
        Sampling frequency [Hz].
    teeth : int
        Teeth on the shaft.
    highest_hz : float
        Up to where; the same for all speeds that are compared.

    Returns
    -------
    float
        0: no line at all, or as many between the orders; noise scatters by 0.1.
    """
    spectrum = order_spectrum(signal, pulses_s, fs_hz, teeth)
    speed_hz = (pulses_s.size - 1) / (pulses_s[-1] - pulses_s[0])
    orders = np.array([order for order in range(1, int(highest_hz / speed_hz)) if order % teeth])
    level = np.log(spectrum.amplitude_m_s2 + SMALLEST * spectrum.amplitude_m_s2.max() + 1e-300)
    whole = orders * spectrum.revolutions
    between = whole + spectrum.revolutions // 2
    inside = between < level.size
    return float(np.mean(level[whole[inside]] - level[between[inside]])) if inside.any() else 0.0
