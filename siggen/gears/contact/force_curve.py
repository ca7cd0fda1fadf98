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
    """Return the answers to ascending approaches (k,) [m] at one tilt.

    `loads_m` (n,): guess at the first approach (zeros are allowed), the loads at the last one afterwards. `nodes`: of
    `energy_nodes`; with an empty (2, 0) no energy is computed (it costs up to as much as the rest where gaps carry) and
    `energy_j` is 0.

    Raises
    ------
    ValueError
        If an approach cannot be solved.
    """
    out = np.zeros((8, 1, approach_m.size))
    tilts = np.full(approach_m.size, tilt_rad)
    if not _write_curve(slices, approach_m, tilts, loads_m, room, nodes, tolerance, out[:, 0]):
        raise ValueError("the contact across the face was not solved; allowed: finite slices and approaches")
    return ForceCurve(out[0, 0], out[1, 0], out[2, 0], out[3, 0], out[4, 0], out[5, 0], out[6, 0], out[7, 0])


@entry(cache=True, _nrt=False, error_model="numpy")
def write_curves(
    slices: FaceSlices,
    approach_m: FloatArray,
    tilt_rad: FloatArray,
    room: SolverRoom,
    nodes: FloatArray,
    tolerance: float,
    out: FloatArray,
) -> bool:
    """Write the answers (8, ways, k) along ways to approaches and tilts (ways, k) from no guess; False if one has none.

    Compiled code that allocates nothing need not count references.
    """
    for way in range(approach_m.shape[0]):
        room.loads[:] = 0.0
        if not _write_curve(
            slices, approach_m[way], tilt_rad[way], room.loads, room, nodes, tolerance, out[:, way]
        ):  # fmt: skip
            return False
    return True


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_curve(
    slices: FaceSlices,
    approach_m: FloatArray,
    tilt_rad: FloatArray,
    loads: FloatArray,
    room: SolverRoom,
    nodes: FloatArray,
    tolerance: float,
    out: FloatArray,
) -> bool:
    """Write the answers (8, k) to approaches and tilts (k,) on a straight way; False if one cannot be solved.

    Every solution starts from the line through the two before it.
    """
    before = room.before
    keep_rigid_sinks(slices, room)
    for j in range(approach_m.size):
        ratio = _step_ratio(approach_m, tilt_rad, j) if j > 1 else 0.0
        for i in range(loads.size):
            found = loads[i]
            if j > 1 and found > 0.0 and before[i] > 0.0:
                loads[i] = max(found + ratio * (found - before[i]), 0.1 * found)
            before[i] = found
        answer = solved_force(slices, approach_m[j], tilt_rad[j], loads, room, tolerance)
        if answer.passes < 0:
            return False
        if nodes.shape[1] > 0:
            out[0, j] = stored_energy(slices, approach_m[j], tilt_rad[j], loads, room, nodes)
        out[1, j] = answer.force_n
        out[2, j] = answer.moment_n_m
        out[3, j] = answer.stiffness_n_per_m
        out[4, j] = answer.turning_n
        out[5, j] = answer.tilting_n_m
        out[6, j] = answer.carrying_m
        out[7, j] = answer.on_damage
    return True


@njit(cache=True, _nrt=False, error_model="numpy")
def _step_ratio(approach_m: FloatArray, tilt_rad: FloatArray, j: int) -> float:
    """Return the step to place j over the one before it."""
    before = approach_m[j - 1] - approach_m[j - 2]
    if before != 0.0:
        risen: float = (approach_m[j] - approach_m[j - 1]) / before
        return risen
    turned = tilt_rad[j - 1] - tilt_rad[j - 2]
    ratio: float = (tilt_rad[j] - tilt_rad[j - 1]) / turned if turned != 0.0 else 0.0
    return ratio
