"""ForceCurve: answers of a tooth pair at one position along approaches and tilts, each solved from the ones before."""

from __future__ import annotations

from typing import NamedTuple

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.gears.contact.face_force import keep_rigid_sinks, solved_force
from siggen.gears.contact.face_slices import FaceSlices
from siggen.gears.contact.newton_matrix import SolverRoom


class ForceCurve(NamedTuple):
    """Answers along a way, (k,) each, as in `FaceForce`."""

    force_n: FloatArray
    moment_n_m: FloatArray
    stiffness_n_per_m: FloatArray
    turning_n: FloatArray
    tilting_n_m: FloatArray
    carrying_m: FloatArray
    on_rough: FloatArray


@entry(cache=True, _nrt=False, error_model="numpy")
def write_curves(
    slices: FaceSlices,
    approach_m: FloatArray,
    tilt_rad: FloatArray,
    room: SolverRoom,
    tolerance: float,
    out: FloatArray,
) -> bool:
    """Write the answers (7, ways, k) along ways to approaches and tilts (ways, k) from no guess; False if one has none.

    Compiled code that allocates nothing need not count references.
    """
    for way in range(approach_m.shape[0]):
        room.loads[:] = 0.0
        if not _write_curve(
            slices, approach_m[way], tilt_rad[way], room.loads, room, tolerance, out[:, way]
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
    tolerance: float,
    out: FloatArray,
) -> bool:
    """Write the answers (7, k) to approaches and tilts (k,) on a straight way; False if one cannot be solved.

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
        out[0, j] = answer.force_n
        out[1, j] = answer.moment_n_m
        out[2, j] = answer.stiffness_n_per_m
        out[3, j] = answer.turning_n
        out[4, j] = answer.tilting_n_m
        out[5, j] = answer.carrying_m
        out[6, j] = answer.on_rough
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
