"""Spectrum of a record of whole turns: transforms over the turns at every step, then over the steps of a turn.

One transform of the whole length costs twice as much where the turns have a large prime factor, and as much again for
every new number of turns, whose roots of unity have to be found first. What is weighed alike in all turns shares the
first half. Source: Cooley and Tukey 1965.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np


@dataclass(frozen=True, slots=True)
class TurnLines:
    """What a record of whole turns holds at every step of a turn, by lines over the turns.

    Attributes
    ----------
    lines : (steps, turns // 2 + 1) complex128
        Of the turns of each step, as of `scipy.fft.rfft`.
    turns : int
    """

    lines: np.ndarray
    turns: int

    def spectrum(self, gate: np.ndarray | None = None) -> np.ndarray:
        """Return the lines of the record, (n // 2 + 1,) complex128, as of `scipy.fft.rfft` of its n samples.

        Parameters
        ----------
        gate : (steps,) float64, optional
            What every turn is multiplied by.
        """
        from scipy import fft

        steps, size = self.lines.shape[0], self.lines.shape[0] * self.turns
        turned = self.lines * _roots(self.turns, steps)
        if gate is not None:
            turned *= gate[:, None]
        inner = fft.fft(turned, axis=0, overwrite_x=True)
        # line k of the turns and line j of the steps: line k + turns j; the others are conjugates from the far end
        rows, known = size // 2 // self.turns + 1, self.lines.shape[1]
        found = np.empty((rows, self.turns), dtype=np.complex128)
        found[:, :known] = inner[:rows]
        np.conjugate(inner[::-1][:rows, (self.turns - 1) // 2 : 0 : -1], out=found[:, known:])
        return found.ravel()[: size // 2 + 1]


def turn_lines(turns: np.ndarray) -> TurnLines:
    """Return the lines over turns (turns, steps) float64 of a record."""
    from scipy import fft

    return TurnLines(fft.rfft(turns.T, axis=1), len(turns))


@lru_cache(maxsize=2)
def _roots(turns: int, steps: int) -> np.ndarray:
    """Return the phases that a line over the turns gains from step to step, (steps, turns // 2 + 1) complex128."""
    line, block = np.arange(turns // 2 + 1), math.isqrt(steps) + 1
    # phases of coarse and fine steps add up: some 2 sqrt(n) rows of exponentials instead of n
    angle = -2j * np.pi / (turns * steps) * line
    fine, coarse = (np.exp(np.arange(0, end, by)[:, None] * angle) for end, by in ((block, 1), (steps, block)))
    found = (coarse[:, None] * fine).reshape(-1, line.size)[:steps]
    found.flags.writeable = False
    return np.asarray(found)
