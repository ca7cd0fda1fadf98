"""Line amplitudes at whole shaft orders, and which sidebands of a shaft a record can resolve.

Source: standard literature; the resolution rule is derived from the half width of the Hann main lobe, two bins.
"""

from __future__ import annotations

import numpy as np

HANN_HALF_WIDTH_BINS = 2.0


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
