"""Elastic forces of tooth pairs, compiled: the spring of each by itself, and how pairs on one gear body share the load.

With coupling the penetrations solve p_n = d_n - Σ c_nm f_m(p_m) (derived): f is piecewise linear, or smooth and
monotone, so Newton's method ends after a few steps with the solution; it exists and is unique while the coupling of a
pair stays below its own compliance, since then the energy is strictly convex.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.contact_spring import contact_spring
from siggen.dynamics.mesh.pair_columns import (
    COLUMNS,
    COUPLED,
    FLANK,
    MOST_APART,
    NORMAL,
    PENETRATION,
    POSITION,
    WHOLE,
)

ALONE, FORCE, SLOPE, RIGHT, MATRIX = range(5)
"""Columns of the solution: penetration by itself, force, slope, right side; the matrix, and behind it the coupling."""
SETTLED_CHANGE = 1e-5
"""Of smooth forces: Newton's error is the square of the last step, so that less than 1e-9 of the force is left."""
MOST_STEPS = 50
"""Beyond half of these, pairs are solved one at a time; Newton's method was never seen to need more than 5."""


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def _spring(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float]:
    """Return force [N] and stiffness [N/m] of slot i on its drive flank."""
    if penetration_m <= 0.0:
        return 0.0, 0.0
    if index[layout.CONTACT_NODES] > 0:
        return contact_spring(scalars, numbers, index, pairs, i, penetration_m)
    return pairs[i, WHOLE] * penetration_m, pairs[i, WHOLE]


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def spring_of_flank(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, penetration_m: float
) -> tuple[float, float]:
    """Return the same on the flank of column FLANK; the back flank has no damage and pushes the other way."""
    if pairs[i, FLANK] >= 0.0:
        return _spring(scalars, numbers, index, pairs, i, penetration_m)
    if penetration_m >= 0.0:
        return 0.0, 0.0
    return pairs[i, WHOLE] * penetration_m, pairs[i, WHOLE]


@njit(cache=True, _nrt=False)
def coupling_of(scalars: FloatArray, pairs: FloatArray, apart: int, i: int, j: int) -> float:
    """Return c of two slots [m/N]."""
    away = int(np.round((pairs[i, POSITION] - pairs[j, POSITION]) / scalars[layout.PITCH_M]))
    if away == 0 or abs(away) > apart:
        return 0.0
    # The pair that entered later has the smaller s.
    coupling: float = pairs[j, COUPLED + away - 1] if away > 0 else pairs[i, COUPLED - away - 1]
    return coupling


@njit(cache=True, _nrt=False)
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


@njit(cache=True, _nrt=False)
def share_coupled(scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray) -> None:
    """Replace the penetration of every pair by itself with that under the forces of the others."""
    slots, apart = pairs.shape[0], min(index[layout.APART], MOST_APART)
    coupling = MATRIX + slots
    work = pairs[:, COLUMNS:]  # of the table itself: code that allocates nothing need not count references
    for i in range(slots):
        for column in range(coupling + slots):
            work[i, column] = 0.0
    _prepare(scalars, pairs, work, apart)
    for step in range(MOST_STEPS):
        settled = True
        for i in range(slots):
            found, tangent = 0.0, 0.0
            if pairs[i, WHOLE] > 0.0:
                pairs[i, PENETRATION] = _under_others(work, coupling, i)
                found, tangent = spring_of_flank(scalars, numbers, index, pairs, i, pairs[i, PENETRATION])
            settled = settled and tangent == work[i, SLOPE]
            work[i, SLOPE], work[i, RIGHT] = tangent, found - work[i, FORCE]
            if step > MOST_STEPS // 2:
                # Pieces that alternate, which strong couplings could make: one pair at a time always ends.
                work[i, FORCE], work[i, RIGHT] = found, 0.0
        # One at a time, the same pieces twice are no proof: all steps are taken, each far nearer than the one before.
        if settled and step <= MOST_STEPS // 2:
            return
        if _newton_step(work, coupling) <= SETTLED_CHANGE:
            for i in range(slots):
                pairs[i, PENETRATION] = _under_others(work, coupling, i)
            return


@njit(cache=True, _nrt=False, inline="always")
def _prepare(scalars: FloatArray, pairs: FloatArray, work: FloatArray, apart: int) -> None:
    """Write penetrations by themselves, first guesses and couplings."""
    slots = pairs.shape[0]
    for i in range(slots):
        work[i, ALONE], work[i, SLOPE] = pairs[i, PENETRATION], -1.0
        if pairs[i, WHOLE] == 0.0:
            continue
        work[i, FORCE] = pairs[i, NORMAL]  # of the evaluation before, a near guess
        for j in range(slots):
            if i != j and pairs[j, WHOLE] > 0.0:
                work[i, MATRIX + slots + j] = coupling_of(scalars, pairs, apart, i, j)


@njit(cache=True, _nrt=False, inline="always")
def _newton_step(work: FloatArray, coupling: int) -> float:
    """Add Newton's step to the forces; return the largest step over the largest force."""
    slots = work.shape[0]
    for i in range(slots):
        for j in range(slots):
            work[i, MATRIX + j] = work[i, SLOPE] * work[i, coupling + j]
        work[i, MATRIX + i] += 1.0
    _solve(work)
    change, force = 0.0, 1e-300
    for i in range(slots):
        work[i, FORCE] += work[i, RIGHT]
        change, force = max(change, abs(work[i, RIGHT])), max(force, abs(work[i, FORCE]))
    return change / force


@njit(cache=True, _nrt=False, inline="always")
def _under_others(work: FloatArray, coupling: int, i: int) -> float:
    """Return the penetration of a slot under the forces of the others [m]."""
    left: float = work[i, ALONE]
    others = 0.0
    for j in range(work.shape[0]):
        others += work[i, coupling + j] * work[j, FORCE]
    return left - others
