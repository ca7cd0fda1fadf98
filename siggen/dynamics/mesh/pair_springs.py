"""Elastic forces of tooth pairs, compiled: the spring of each by itself, and how pairs on one gear body share the load.

With coupling the penetrations solve p_n = d_n - Σ c_nm f_m(p_m) (derived): f is piecewise linear, so Newton's method
ends after a few steps with the exact solution; it exists and is unique while the coupling of a pair stays below its own
compliance, since then the energy is strictly convex.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from siggen.arrays import FloatArray, IntArray
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_places import (
    CELL,
    COUPLED,
    FLANK,
    MOST_APART,
    PENETRATION,
    POSITION,
    ROW,
    WEIGHT,
    WHOLE,
    between,
)
from siggen.dynamics.mesh.slice_law import grouped_force

ALONE, FORCE, SLOPE, RIGHT, MATRIX = range(5)
"""Columns of the solution: penetration by itself, force, slope, right side; the matrix, and behind it the coupling."""
MOST_STEPS = 50
"""Beyond half of these, pairs are solved one at a time; Newton's method was never seen to need more than 5."""


@njit(cache=True, inline="always")
def _spring(
    numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float, float]:
    """Return force [N], stiffness [N/m] and carrying share of the face of slot i on its drive flank."""
    whole = pairs[i, WHOLE]
    if penetration_m <= 0.0:
        return 0.0, 0.0, 0.0
    groups = index[layout.GROUPS]
    if groups > 0:
        cell, weight, points = int(pairs[i, CELL]), pairs[i, WEIGHT], index[layout.POINTS]
        corner = int(pairs[i, ROW]) * points + cell
        low = index[layout.SINK_AT] + corner * groups
        if numbers[low + groups - 1] != 0.0 or numbers[low + 2 * groups - 1] != 0.0:
            flush = between(numbers, index[layout.FLUSH_AT], corner, weight)
            contact = between(numbers, index[layout.CONTACT_AT], cell, weight)
            return grouped_force(numbers, low, groups, weight, flush, contact, whole, penetration_m)
        land = between(numbers, index[layout.LAND_AT], corner, weight)
        return whole * penetration_m, whole, land
    return whole * penetration_m, whole, 1.0


@njit(cache=True)
def least_sink(numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int) -> float:
    """Return how deep the mating flank of slot i lies before anything touches [m]; 0 where the face is flush."""
    groups = index[layout.GROUPS]
    if groups == 0:
        return 0.0
    cell, weight = int(pairs[i, CELL]), pairs[i, WEIGHT]
    corner = int(pairs[i, ROW]) * index[layout.POINTS] + cell
    if between(numbers, index[layout.FLUSH_AT], corner, weight) > 0.0:
        return 0.0
    low = index[layout.SINK_AT] + corner * groups
    sink: float = numbers[low] * (1.0 - weight) + numbers[low + groups] * weight
    return sink


@njit(cache=True, inline="always")
def spring_of_flank(
    numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float, float]:
    """Return the same on the flank of column FLANK; the back flank has no damage and pushes the other way."""
    if pairs[i, FLANK] >= 0.0:
        return _spring(numbers, index, pairs, i, penetration_m)
    if penetration_m >= 0.0:
        return 0.0, 0.0, 0.0
    return pairs[i, WHOLE] * penetration_m, pairs[i, WHOLE], 1.0


@njit(cache=True)
def _coupling(scalars: FloatArray, pairs: FloatArray, apart: int, i: int, j: int) -> float:
    """Return c of two slots [m/N]."""
    away = int(np.round((pairs[i, POSITION] - pairs[j, POSITION]) / scalars[layout.PITCH_M]))
    if away == 0 or abs(away) > apart:
        return 0.0
    # The pair that entered later has the smaller s.
    coupling: float = pairs[j, COUPLED + away - 1] if away > 0 else pairs[i, COUPLED - away - 1]
    return coupling


@njit(cache=True)
def _solve(work: FloatArray) -> None:
    """Write the solution of the system in the first columns into column RIGHT; dominant diagonal, without pivoting."""
    n = work.shape[0]
    for k in range(n):
        for i in range(k + 1, n):
            factor = work[i, MATRIX + k] / work[k, MATRIX + k]
            for j in range(k + 1, n):
                work[i, MATRIX + j] -= factor * work[k, MATRIX + j]
            work[i, RIGHT] -= factor * work[k, RIGHT]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            work[k, RIGHT] -= work[k, MATRIX + j] * work[j, RIGHT]
        work[k, RIGHT] /= work[k, MATRIX + k]


@njit(cache=True)
def share_coupled(scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray) -> None:
    """Replace the penetration of every pair by itself with that under the forces of the others."""
    slots, apart = pairs.shape[0], min(index[layout.APART], MOST_APART)
    coupling = MATRIX + slots
    work = np.zeros((slots, coupling + slots))  # one array: each costs as much as half a solution
    for i in range(slots):
        work[i, ALONE], work[i, SLOPE] = pairs[i, PENETRATION], -1.0
        for j in range(slots):
            if i != j and pairs[i, WHOLE] > 0.0 and pairs[j, WHOLE] > 0.0:
                work[i, coupling + j] = _coupling(scalars, pairs, apart, i, j)
    for step in range(MOST_STEPS):
        settled = True
        for i in range(slots):
            found, tangent = 0.0, 0.0
            if pairs[i, WHOLE] > 0.0:
                others = 0.0
                for j in range(slots):
                    others += work[i, coupling + j] * work[j, FORCE]
                pairs[i, PENETRATION] = work[i, ALONE] - others
                found, tangent, _ = spring_of_flank(numbers, index, pairs, i, pairs[i, PENETRATION])
            settled = settled and tangent == work[i, SLOPE]
            work[i, SLOPE], work[i, RIGHT] = tangent, found - work[i, FORCE]
            if step > MOST_STEPS // 2:
                # Pieces that alternate, which strong couplings could make: one pair at a time always ends.
                work[i, FORCE], work[i, RIGHT] = found, 0.0
        # One at a time, the same pieces twice are no proof: all steps are taken, each far nearer than the one before.
        if settled and step <= MOST_STEPS // 2:
            return
        for i in range(slots):
            for j in range(slots):
                work[i, MATRIX + j] = work[i, SLOPE] * work[i, coupling + j]
            work[i, MATRIX + i] += 1.0
        _solve(work)
        for i in range(slots):
            work[i, FORCE] += work[i, RIGHT]
