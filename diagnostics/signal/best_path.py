"""The best path through gains by time and cell, where every step from cell to cell has a price: dynamic programming.

Source: standard literature (Viterbi).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

NOWHERE = -1e9
"""Gain of what no path may come from."""


def path_totals(gains: np.ndarray, price: np.ndarray) -> np.ndarray:
    """Return, by time and cell, the most that a path which ends there collects, (m, cells).

    Parameters
    ----------
    gains : (m, cells) float
    price : (2 reach + 1,) float
        Of steps by -reach ... reach cells; further ones are not taken.
    """
    from scipy.ndimage import grey_dilation

    totals = gains.copy()
    for n in range(1, len(totals)):
        totals[n] += grey_dilation(totals[n - 1], structure=-price, mode="constant", cval=NOWHERE)
    return totals


def path_cells(totals: np.ndarray, price: np.ndarray, cell: int) -> Iterator[int]:
    """Yield the cells of the best path beside a cell, from totals (m, cells) next to it on, one by one."""
    reach = price.size // 2
    for total in totals:
        low = max(0, cell - reach)
        near = total[low : cell + reach + 1]
        first = low - (cell - reach)
        cell = low + int(np.argmax(near - price[first : first + near.size]))
        yield cell
