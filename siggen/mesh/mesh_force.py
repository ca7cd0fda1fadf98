"""MeshLaw: pair stiffness tables by position, and the mesh force of `law: linear`; `pair_law` is that of pairs.

Equations: F = K f(δ) + c δ̇ in contact with f the centred backlash function (reference: standard literature);
K = sum over the pairs in contact (paper A: Influence of Tooth Pitting on TVMS and Vibration Response of a Spur Gear
Pair), with coupled gear bodies the sum of their contributions (`siggen.mesh.body_coupling`, derived); phase
by the global engagement counter n (derived): pair n is at s = s_A + R_b1 Θ - n p_b. Positions are carried in base
pitches, φ = Θ z_1 / 2π: pair n is in contact while 0 <= φ - n < contact ratio, pinion tooth n mod z_1 on gear tooth n
mod z_2. The tables act on both flanks: K is that of the drive flank also where the back flank carries the load.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit

if TYPE_CHECKING:
    from siggen.mesh.mesh_tables import MeshTables


class MeshLaw(NamedTuple):
    """All that the compiled pair law needs (a named tuple, since compiled code takes no dataclass).

    `stiffness` (rows, points) [N/m]: what a pair adds over its engagement, `table_of_pair` (z_1, z_2) the row of each
    pair of teeth, `contact_ratio` and `intervals_per_pitch` locate the rows in base pitches.
    """

    stiffness: FloatArray
    table_of_pair: NDArray[np.int32]
    contact_ratio: float
    intervals_per_pitch: float
    damping_n_s_per_m: float
    half_backlash_m: float


def mesh_law(tables: MeshTables, damping_n_s_per_m: float, backlash_m: float) -> MeshLaw:
    """Return the law of these tables with a constant mesh damping [N s/m] and a total normal backlash [m]."""
    stiffness = read_only(tables.contributions_n_per_m, np.float64)
    # A pair of helical teeth begins and ends with nothing.
    length = tables.end_m - tables.start_m
    return MeshLaw(
        stiffness=stiffness,
        table_of_pair=read_only(tables.row_of_pair, np.int32),
        contact_ratio=float(length / tables.base_pitch_m),
        intervals_per_pitch=float((stiffness.shape[1] - 1) * tables.base_pitch_m / length),
        damping_n_s_per_m=float(damping_n_s_per_m),
        half_backlash_m=0.5 * float(backlash_m),
    )


def mean_mesh_stiffness(tables: MeshTables) -> float:
    """Return the mean over the angle of the healthy mesh stiffness [N/m]: the integral of row 0 over one base pitch."""
    healthy = np.asarray(tables.contributions_n_per_m)[0]
    step = (tables.end_m - tables.start_m) / (healthy.size - 1)
    return float((healthy.sum() - 0.5 * (healthy[0] + healthy[-1])) * step / tables.base_pitch_m)


def read_only(values: NDArray[Any], dtype: type) -> NDArray[Any]:
    """Return a contiguous read-only array: one type for all laws, hence one compilation of the kernels."""
    array: NDArray[Any] = np.ascontiguousarray(values, dtype=dtype)
    if array.flags.writeable:
        array = array.copy()
        array.setflags(write=False)
    return array


@entry(cache=True)
def table_row(law: MeshLaw, pair: int) -> int:
    """Return the row of the table of engagement `pair` (any integer; negative before angle 0)."""
    teeth_1, teeth_2 = law.table_of_pair.shape
    row: int = law.table_of_pair[pair % teeth_1, pair % teeth_2]
    return row


@njit(cache=True)
def row_stiffness(law: MeshLaw, row: int, pitches: float) -> float:
    """Return the stiffness [N/m] of a pair `pitches` base pitches after it entered contact, linear between points."""
    place = pitches * law.intervals_per_pitch
    index = min(max(int(place), 0), law.stiffness.shape[1] - 2)
    share = place - index
    stiffness: float = law.stiffness[row, index] * (1.0 - share) + law.stiffness[row, index + 1] * share
    return stiffness


@entry(cache=True)
def mesh_stiffness(law: MeshLaw, pitches: float) -> float:
    """Return the sum of pair stiffnesses [N/m] at the pinion angle `pitches` = Θ z_1 / 2π."""
    pair = int(np.floor(pitches))
    total = 0.0
    while pitches - pair < law.contact_ratio:
        total += row_stiffness(law, table_row(law, pair), pitches - pair)
        pair -= 1
    return total


@njit(cache=True)
def in_contact(law: MeshLaw, approach_m: float) -> bool:
    """Whether flanks touch: the approach is outside the backlash gap (always, without backlash)."""
    return law.half_backlash_m == 0.0 or abs(approach_m) > law.half_backlash_m


@entry(cache=True)
def mesh_force(law: MeshLaw, approach_m: float, approach_rate_m_s: float, pitches: float) -> float:
    """Return the mesh force [N] along the line of action, positive on the drive flank; the damper acts in contact."""
    if not in_contact(law, approach_m):
        return 0.0
    side = 1.0 if approach_m > 0.0 else -1.0
    penetration = approach_m - side * law.half_backlash_m
    return mesh_stiffness(law, pitches) * penetration + law.damping_n_s_per_m * approach_rate_m_s
