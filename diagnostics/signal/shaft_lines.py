"""Lines of both shafts in a record over angle, each by itself, and the band of orders between shafts and mesh.

The Hann spectrum over M whole revolutions of a shaft has bins 1/M of its order wide; two lines stand apart from two
bins on, and what lies further off leaks below -31 dB. White noise of standard deviation s over n steps gives a line an
rms amplitude of s sqrt(6/n): the window's noise bandwidth is 1.5 bins. Source: standard literature (Harris 1978).
"""

from __future__ import annotations

import numpy as np

from diagnostics.signal.spectrum import HANN_HALF_WIDTH_BINS, line_amplitudes
from diagnostics.signal.synchronous_average import hann_weights, synchronous_average, whole_revolutions

LINE_ORDERS = (1, 2, 3)
"""Runout, misalignment and what couplings do show in the first orders of a shaft."""


def shaft_lines(steps: np.ndarray, teeth: int, other_teeth: int, samples_per_tooth: int) -> np.ndarray:
    """Return the amplitudes at orders 0 to 3 of a shaft, (4,) float64; NaN where a line is not resolved.

    Parameters
    ----------
    steps : (n,) float64
        Record at equal angle steps, at least one revolution of the shaft.
    teeth, other_teeth : int
        Teeth on the shaft and on the other one.
    samples_per_tooth : int
        Angle steps per mesh period.

    Notes
    -----
    A line is resolved if the mean and orders 1 to 3 of the other shaft lie two bins off, 2/M orders over M revolutions.
    Where both shafts have a line at one order, no record resolves it.
    """
    turns = whole_revolutions(steps, teeth, samples_per_tooth)
    average = synchronous_average(steps, teeth, samples_per_tooth, hann=True).signal
    found = line_amplitudes(average)[: LINE_ORDERS[-1] + 1]
    others = np.array([0, *LINE_ORDERS]) * (teeth / other_teeth)
    for order in LINE_ORDERS:
        if turns * np.abs(order - others).min() < HANN_HALF_WIDTH_BINS:
            found[order] = np.nan
    return found


def ripple_bins(turns: float, teeth: tuple[int, int]) -> tuple[int, int]:
    """Return the first bin, and the one after the last, from half the slower shaft's order to half the mesh order.

    Parameters
    ----------
    turns : float
        Pinion revolutions that the record holds.
    teeth : (int, int)
        Teeth of pinion and gear.
    """
    slower = min(1.0, teeth[0] / teeth[1])
    return int(0.5 * slower * turns), int(np.ceil(0.5 * teeth[0] * turns))


def band_rms(signal: np.ndarray, bins: tuple[int, int]) -> float:
    """Return the rms of a signal without its mean in a band of bins of its Hann spectrum.

    Parameters
    ----------
    signal : (n,) float64
    bins : (int, int)
        First bin, at least 2, and the one after the last. A sine counts whole from two bins inside the band on.
    """
    from scipy import fft

    weights = hann_weights(signal.size)
    spectrum = fft.rfft((signal - signal.mean()) * weights)[bins[0] : bins[1]]
    power = 2.0 * float(np.sum(spectrum.real**2 + spectrum.imag**2))
    return float(np.sqrt(power / (signal.size * float(np.sum(weights * weights)))))
