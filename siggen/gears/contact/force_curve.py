"""ForceCurve: answers of a tooth pair at one position along approaches and tilts, each solved from the ones before."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.gears.contact.face_force import keep_rigid_sinks, solved_force
from siggen.gears.contact.face_slices import FaceSlices
from siggen.gears.contact.newton_matrix import SolverRoom
from siggen.gears.contact.stored_energy import stored_energy

TOLERANCE = 1e-3
"""Of the last Newton step: steps are squared from pass to pass, so what is left is 1e-6 of the force (tested)."""


class ForceCurve(NamedTuple):
    """Answers along a way, (k,) each, as in `FaceForce`, and the stored energy W [J]."""

    energy_j: FloatArray
    force_n: FloatArray
    moment_n_m: FloatArray
    stiffness_n_per_m: FloatArray
    turning_n: FloatArray
    tilting_n_m: FloatArray
    carrying_m: FloatArray
    on_damage: FloatArray


@entry(cache=True)
def force_curve(
    slices: FaceSlices,
    approach_m: FloatArray,
    tilt_rad: float,
    loads_m: FloatArray,
    room: SolverRoom,
    nodes: FloatArray,
    tolerance: float = TOLERANCE,
) -> ForceCurve:
    """Return the answers to ascending approaches (k,) [m] at one tilt; the rest as `curve_along`."""
    return curve_along(slices, approach_m, np.full(approach_m.size, tilt_rad), loads_m, room, nodes, tolerance)


@njit(cache=True)
def curve_along(
    slices: FaceSlices,
    approach_m: FloatArray,
    tilt_rad: FloatArray,
    loads_m: FloatArray,
    room: SolverRoom,
    nodes: FloatArray,
    tolerance: float = TOLERANCE,
) -> ForceCurve:
    """Return the answers to approaches (k,) [m] and tilts (k,) [rad] that lie on a straight way.

    `loads_m` (n,): guess at the first approach (zeros are allowed), the loads there afterwards. Every solution starts
    from the line through the two before it. `nodes`: of `energy_nodes`; with an empty (2, 0) no energy is computed (it
    costs up to as much as the rest where gaps carry) and `energy_j` is 0.

    Raises
    ------
    ValueError
        If an approach cannot be solved.
    """
    count = approach_m.size
    out = np.zeros((8, count))
    keep_rigid_sinks(slices, room)
    before = np.zeros(loads_m.size)
    last = np.zeros(loads_m.size)
    loads = loads_m.copy()
    for j in range(count):
        if j > 1:
            ratio = _step_ratio(approach_m, tilt_rad, j)
            for i in range(loads_m.size):
                if loads[i] > 0.0 and before[i] > 0.0:
                    loads[i] = max(loads[i] + ratio * (loads[i] - before[i]), 0.1 * loads[i])
        if j > 0:
            before[:] = last
        answer = solved_force(slices, approach_m[j], tilt_rad[j], loads, room, tolerance)
        if answer.passes < 0:
            raise ValueError("the contact across the face was not solved; allowed: finite slices and approaches")
        last[:] = loads
        if j == 0:
            loads_m[:] = loads
        if nodes.shape[1]:
            out[0, j] = stored_energy(slices, approach_m[j], tilt_rad[j], loads, room, nodes)
        out[1, j] = answer.force_n
        out[2, j] = answer.moment_n_m
        out[3, j] = answer.stiffness_n_per_m
        out[4, j] = answer.turning_n
        out[5, j] = answer.tilting_n_m
        out[6, j] = answer.carrying_m
        out[7, j] = answer.on_damage
    return ForceCurve(out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7])


@entry(cache=True)
def write_curves(
    slices: FaceSlices,
    approach_m: FloatArray,
    tilt_rad: FloatArray,
    room: SolverRoom,
    tolerance: float,
    out: FloatArray,
) -> None:
    """Write the answers (8, ways, k) along ways to approaches and tilts (ways, k), without the energy.

    Source: `curve_along`, from no guess.
    """
    nodes = np.zeros((2, 0))
    for way in range(approach_m.shape[0]):
        guess = np.zeros(slices.face_m.size)
        found = curve_along(slices, approach_m[way], tilt_rad[way], guess, room, nodes, tolerance)
        for j in range(approach_m.shape[1]):
            out[1, way, j], out[2, way, j] = found.force_n[j], found.moment_n_m[j]
            out[3, way, j], out[4, way, j] = found.stiffness_n_per_m[j], found.turning_n[j]
            out[5, way, j], out[6, way, j] = found.tilting_n_m[j], found.carrying_m[j]
            out[7, way, j] = found.on_damage[j]


@njit(cache=True)
def _step_ratio(approach_m: FloatArray, tilt_rad: FloatArray, j: int) -> float:
    """Return the step to place j over the one before it."""
    before = approach_m[j - 1] - approach_m[j - 2]
    if before != 0.0:
        risen: float = (approach_m[j] - approach_m[j - 1]) / before
        return risen
    turned = tilt_rad[j - 1] - tilt_rad[j - 2]
    ratio: float = (tilt_rad[j] - tilt_rad[j - 1]) / turned if turned != 0.0 else 0.0
    return ratio
