"""FaceShares: how the slices of a helical pair share its load, and what the pair sees of what each slice meets.

Derived. The loads f_i of slices are derivatives of one energy, so that ∂F/∂e_i = -∂f_i/∂d. Missing material e_i, small
beside the deflection, moves a pair that carries F apart by Σ y_i e_i: y_i are the shares of a little more load, not of
the load itself, which differ where some slices have just come to touch. Slices before and behind the pitch
point slide against each other, so that friction needs two places with the moments of their loads about it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray

FINER = 2
"""Points of what slices meet per point of what the pair sees."""


class FaceShares(NamedTuple):
    """Shares of the load at positions of the middle of the face, evenly from `start_m` to `end_m` [m].

    `shift_m` (n,): how far slices are ahead of the middle [m]; `share` (k, n): of the load; `yielding` (k, n): of a
    little more load. Every row adds up to 1.
    """

    start_m: float
    end_m: float
    shift_m: FloatArray
    share: FloatArray
    yielding: FloatArray

    def _at(self, rows: FloatArray, position_m: FloatArray) -> FloatArray:
        """Return rows (k, n) at positions (p,), (p, n); beyond both ends those there."""
        last = len(rows) - 1
        place = np.clip((position_m - self.start_m) / (self.end_m - self.start_m), 0.0, 1.0) * last
        first = np.minimum(place.astype(np.int64), last - 1)
        weight = (place - first)[:, np.newaxis]
        return np.asarray(rows[first] * (1.0 - weight) + rows[first + 1] * weight)

    def mean(self, position_m: FloatArray, met: Callable[[FloatArray], FloatArray]) -> FloatArray:
        """Return what the pair sees (rows, p) at even positions (p,) of what a slice meets at its place.

        Parameters
        ----------
        position_m : (p,)
        met : callable
            Places (q,) of slices on their path -> (rows, q).
        """
        from scipy.sparse import csr_array

        reach = float(np.abs(self.shift_m).max())
        step = (position_m[-1] - position_m[0]) / (FINER * (position_m.size - 1))
        beyond = int(np.ceil(reach / step)) + 1
        count = FINER * (position_m.size - 1) + 2 * beyond + 1
        low = position_m[0] - beyond * step
        place = (position_m[:, np.newaxis] + self.shift_m - low) / step
        first = np.clip(place.astype(np.int64), 0, count - 2)
        weight, share = place - first, self._at(self.yielding, position_m)
        rows = np.repeat(np.arange(position_m.size), self.shift_m.size)
        values = np.concatenate([(share * (1.0 - weight)).ravel(), (share * weight).ravel()])
        where = np.concatenate([rows, rows]), np.concatenate([first.ravel(), first.ravel() + 1])
        seen = csr_array((values, where), shape=(position_m.size, count))
        return np.asarray((seen @ met(low + step * np.arange(count)).T).T)

    def about(self, pitch_point_m: float, position_m: FloatArray) -> FloatArray:
        """Return the load about the pitch point at positions (p,) of the middle of the face, (3, p).

        The share before it, and how far the means of both parts are ahead of the middle [m]; a slice lies evenly over
        its part of the path.
        """
        share = self._at(self.share, position_m)
        half = 0.5 * abs(float(self.shift_m[1] - self.shift_m[0]))
        place = position_m[:, np.newaxis] + self.shift_m
        low, high = place - half, place + half
        cut = np.clip(pitch_point_m, low, high)
        part = np.clip((pitch_point_m - low) / np.maximum(high - low, 1e-15), 0.0, 1.0)
        before, behind = share * part, share * (1.0 - part)
        whole = before.sum(axis=1)
        arms = (before * 0.5 * (low + cut)).sum(axis=1), (behind * 0.5 * (cut + high)).sum(axis=1)
        ahead = [
            np.where(size > 0.0, arm / np.where(size > 0.0, size, 1.0), pitch_point_m) - position_m
            for arm, size in zip(arms, (whole, behind.sum(axis=1)), strict=True)
        ]
        return np.stack([whole, *ahead])
