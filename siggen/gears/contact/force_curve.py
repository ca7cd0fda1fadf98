"""ForceCurve: answers of a tooth pair at one position to ascending approaches, each solved from the ones before."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from siggen.gears.contact.face_force import face_force
from siggen.gears.contact.face_slices import FaceSlices
from siggen.gears.contact.newton_matrix import SolverRoom

FloatArray = NDArray[np.float64]

TOLERANCE = 1e-3
"""Of the last Newton step: steps are squared from pass to pass, so what is left is 1e-6 of the force (tested)."""


class ForceCurve(NamedTuple):
    """Answers to ascending approaches, (k,) each, as in `FaceForce`."""

    force_n: FloatArray
    moment_n_m: FloatArray
    stiffness_n_per_m: FloatArray
    carrying_m: FloatArray
    on_damage: FloatArray


@njit(cache=True)
def force_curve(
    slices: FaceSlices, approach_m: FloatArray, tilt_rad: float, loads_m: FloatArray, room: SolverRoom
) -> ForceCurve:
    """Return the answers to ascending approaches (k,) [m] at one tilt.

    `loads_m` (n,): guess at the first approach (zeros are allowed), the loads at the last one afterwards. Every
    solution starts from the line through the two before it.

    Raises
    ------
    ValueError
        If an approach cannot be solved.
    """
    count = approach_m.size
    out = np.zeros((5, count))
    before = np.zeros(loads_m.size)
    last = np.zeros(loads_m.size)
    for j in range(count):
        if j > 1:
            ratio = (approach_m[j] - approach_m[j - 1]) / (approach_m[j - 1] - approach_m[j - 2])
            for i in range(loads_m.size):
                if loads_m[i] > 0.0 and before[i] > 0.0:
                    loads_m[i] = max(loads_m[i] + ratio * (loads_m[i] - before[i]), 0.1 * loads_m[i])
        if j > 0:
            before[:] = last
        answer = face_force(slices, approach_m[j], tilt_rad, loads_m, room, TOLERANCE)
        if answer.passes < 0:
            raise ValueError("the contact across the face was not solved; allowed: finite slices and approaches")
        last[:] = loads_m
        out[0, j] = answer.force_n
        out[1, j] = answer.moment_n_m
        out[2, j] = answer.stiffness_n_per_m
        out[3, j] = answer.carrying_m
        out[4, j] = answer.on_damage
    return ForceCurve(out[0], out[1], out[2], out[3], out[4])
