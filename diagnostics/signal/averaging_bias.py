"""What an average over M revolutions still holds that is not locked to its shaft.

Noise of variance s^2 leaves s^2/M, so the variance of an average is biased up by that much; a line at a fraction of the
shaft's order leaves its comb gain. Indicators of averages over different M are therefore not comparable where noise
matters. Source: McFadden 1987; standard literature.
"""

from __future__ import annotations

import numpy as np


def comb_gain(order: np.ndarray, revolutions: int) -> np.ndarray:
    """Return |sin(pi M o) / (M sin(pi o))|: what averaging over M revolutions leaves of a line at order o.

    Parameters
    ----------
    order : (n,) float64
        Orders of the averaged shaft; 1 at whole orders.
    revolutions : int
        M.
    """
    off = np.asarray(order, dtype=np.float64) - np.rint(order)
    return np.asarray(np.abs(np.sinc(revolutions * off) / np.sinc(off)))
