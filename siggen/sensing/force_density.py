"""ForceDensity: one-sided densities of force noise over frequency, and noise that has them.

Sources: noise behind |H|² = 1/(1 + (f/f_c)²)^m, the filter of a contact of finite width, whose power over all
frequencies is f_c (√π/2) Γ(m - 1/2)/Γ(m) times its density at 0 (derived); D_0 √(1 + (f_r/f)^q) of machines and
foundations below f_r (model).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from siggen.arrays import FloatArray


def contact_filter(frequency_hz: FloatArray, corner_hz: float, steepness: float) -> FloatArray:
    """Return |H| (k,) = (1 + (f/f_c)²)^(-m/2).

    Raises
    ------
    ValueError
        If the corner is not positive, or the steepness leaves infinite power (m <= 1/2).
    """
    if not (corner_hz > 0.0 and steepness > 0.5):
        raise ValueError(f"contact filter: received {corner_hz} Hz, m = {steepness}; allowed: above 0, m above 0.5")
    return np.asarray((1.0 + (frequency_hz / corner_hz) ** 2) ** (-0.5 * steepness))


def contact_bandwidth_hz(corner_hz: float, steepness: float) -> float:
    """Return ∫ |H|² df from 0 to infinity."""
    return corner_hz * 0.5 * math.sqrt(math.pi) * math.gamma(steepness - 0.5) / math.gamma(steepness)


def rising_floor(frequency_hz: FloatArray, corner_hz: float, exponent: float) -> FloatArray:
    """Return √(1 + (f_r/f)^q) (k,); at frequency 0 as at the first one above."""
    from_first = np.maximum(frequency_hz, frequency_hz[1])
    return np.asarray(np.sqrt(1.0 + (corner_hz / from_first) ** exponent))


def tabulated(frequency_hz: FloatArray, knots_hz: Sequence[float], density: Sequence[float]) -> FloatArray:
    """Return densities (k,) between knots, straight in log-log; beyond the first and last knot they stay.

    Raises
    ------
    ValueError
        If frequencies do not ascend from above 0, or densities are not positive and as many.
    """
    knots, values = np.asarray(knots_hz, dtype=float), np.asarray(density, dtype=float)
    if not (knots.size == values.size > 1 and knots[0] > 0.0 and (np.diff(knots) > 0.0).all() and (values > 0.0).all()):
        raise ValueError(f"density: received {list(knots)} Hz, {list(values)}; allowed: as many, ascending, above 0")
    safe = np.maximum(frequency_hz, knots[0])
    return np.asarray(np.exp(np.interp(np.log(safe), np.log(knots), np.log(values))))
