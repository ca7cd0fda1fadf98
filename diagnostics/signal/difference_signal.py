"""Regular, residual and difference signal of a synchronous average, by zeroing of whole orders.

residual = average minus shaft orders and ALL mesh harmonics (sidebands kept); difference = residual minus the first-
order sidebands; regular = average minus difference. Orders are whole bins of one revolution, so nothing rings and
nothing depends on speed, unlike notch filters in Hz. Source: Lebold et al. 2000 for the separation of residual and
difference; all mesh harmonics below the band edge are removed unless `harmonics` says how many. MATLAB's `tsaresidual`,
`tsadifference` and `tsaregular` separate alike (help page on filtered averages): the first shaft order always counts,
and so do so many harmonics of it and of the mesh, two in their worked example; here that is `shaft_orders=2,
harmonics=2`. With harmonics 3 to 5 strong, as in most measured gearboxes, two are too few.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SHAFT_ORDERS = 2
SIDEBANDS = 1


@dataclass(frozen=True, slots=True)
class SeparatedAverage:
    """One averaged revolution (n,), separated; `regular + difference` is the average."""

    regular: np.ndarray
    residual: np.ndarray
    difference: np.ndarray


def separated_average(
    average: np.ndarray,
    teeth: int,
    shaft_orders: int = SHAFT_ORDERS,
    sidebands: int = SIDEBANDS,
    harmonics: int | None = None,
) -> SeparatedAverage:
    """Separate one averaged revolution.

    Parameters
    ----------
    average : (n,) float64
        One revolution at equal angle steps.
    teeth : int
        Teeth on the shaft.
    shaft_orders : int
        Shaft orders 0 ... `shaft_orders` count as regular.
    sidebands : int
        Sidebands on each side of every mesh harmonic that count as regular.
    harmonics : int, optional
        Mesh harmonics that count as regular; default all up to the band edge.
    """
    from scipy import fft

    spectrum = fft.rfft(average)
    order = np.arange(spectrum.size)
    harmonic = np.round(order / teeth)
    last = np.inf if harmonics is None else harmonics
    distance = np.where((harmonic > 0) & (harmonic <= last), np.abs(order - harmonic * teeth), np.inf)
    shaft = order <= shaft_orders
    residual = fft.irfft(np.where(shaft | (distance == 0), 0.0, spectrum), n=average.size)
    difference = fft.irfft(np.where(shaft | (distance <= sidebands), 0.0, spectrum), n=average.size)
    return SeparatedAverage(average - difference, residual, difference)
