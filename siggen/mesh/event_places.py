"""Where along the path of contact the force of a pair at rest is no smooth function of its position (derived).

A step that is short beside the vibrations may still be long beside an edge of damage. Tables tell such edges before
any step is taken: at fixed approaches the force of a pair is asked for along its path, and its second difference over
half a step is compared with the force.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.mesh import pair_law as layout
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.pair_springs import placed_contact, row_places
from siggen.mesh.springs import PairPlace, pair_spring

MOST_DEPTHS = 16
"""Approaches at which forces are asked for, half a static approach apart, as deep as a flank sinks."""
LEAST_SHARE = 1e-2
"""Of the mean force at the same approach; healthy teeth stay below it at 36 steps per pitch."""


def event_places(law: PairLaw, approach_m: float, step_pitches: float) -> NDArray[np.bool_]:
    """Return (rows, points) whether a step that begins at a position of the law's tables meets an edge of damage.

    Parameters
    ----------
    law : PairLaw
    approach_m : float
        Static approach [m], above 0.
    step_pitches : float
        Length of a step in base pitches.
    """
    points, head = int(law.places[layout.POINTS]), law.places
    rows = int(law.places[head[layout.TABLE_AT] :][: head[layout.TEETH_1] * head[layout.TEETH_2]].max()) + 1
    reach = max(1, round(0.5 * step_pitches * law.scalars[layout.PER_PITCH]))
    edges = np.zeros((rows, points), dtype=np.bool_)
    sunk = approach_m + _deepest_m(law)
    for depth in np.linspace(0.0, sunk, max(2, min(MOST_DEPTHS, round(2.0 * sunk / approach_m))) + 1)[1:]:
        force = _forces(law, rows, float(depth))
        bend = force[:, 2 * reach :] - 2.0 * force[:, reach:-reach] + force[:, : -2 * reach]
        edges[:, reach:-reach] |= np.abs(bend) > LEAST_SHARE * force.max(axis=0).mean()
    return _widened(edges, 3 * reach, reach) | _path_ends(law, points, step_pitches)


def _path_ends(law: PairLaw, points: int, step_pitches: float) -> NDArray[np.bool_]:
    """Return (points,) from where a step takes a pair off the path of contact, or the next pair onto it.

    There a corner begins or ends to touch, from which on the errors of its flank stay as they are.
    """
    per_pitch = law.scalars[layout.PER_PITCH]
    ahead = np.array([points - 1.0, per_pitch])[:, np.newaxis] - np.arange(float(points))
    return np.asarray(((ahead >= 0.0) & (ahead <= step_pitches * per_pitch + 1.0)).any(axis=0))


def _deepest_m(law: PairLaw) -> float:
    """Return how far a flank sinks at most into damage [m]."""
    head = law.places
    if head[layout.CONTACT_NODES] > 0:
        return float(law.numbers[head[layout.TOUCH_AT] : head[layout.COLUMN_AT]].max())
    return 0.0


def _widened(edges: NDArray[np.bool_], before: int, after: int) -> NDArray[np.bool_]:
    """Return places from `before` points before an edge to `after` points behind it."""
    padded = np.pad(edges, ((0, 0), (after, before)))
    windows = np.lib.stride_tricks.sliding_window_view(padded, before + after + 1, axis=1)
    return np.ascontiguousarray(windows.any(axis=2))


@entry(cache=True, error_model="numpy")
def _forces(law: PairLaw, rows: int, depth_m: float) -> FloatArray:
    """Return the force (rows, points) at a depth below the whole flank."""
    points = law.places[layout.POINTS]
    force = np.empty((rows, points))
    for row in range(rows):
        stiffness_at, touch_at, columns_at = row_places(law, row)
        for k in range(points):
            cell, touch, curves, share = min(k, points - 2), 0.0, 0.0, 0.0
            if law.places[layout.CONTACT_NODES] > 0:
                touch, curves, share = placed_contact(law, touch_at, columns_at, cell, float(k - cell))
            place = PairPlace(depth_m, touch, curves, share, law.numbers[int(stiffness_at) + k])
            force[row, k] = pair_spring(law, place, 0.0, depth_m).force
    return force
