"""PairLaw: the mesh force as a sum over tooth pairs, each with its own stiffness, missing material and friction.

Equations (reference: standard literature; load sharing and friction as paper B names them: Luo, Baddour, Liang, MSSP
119 (2019) 155-181): with the approach x along the line of action and d_n = x - e_n

    drive flank, d_n > 0:          N_n = max(0, k_n d_n + c_n ẋ)
    back flank, x - e_p < -j:      N_n = min(0, k_n (x - e_p + j) + c_n ẋ)      e_p: place of the teeth alone
    c_n = 2 ζ √(Σk m_e) k_n/Σk     over the pairs that touch (Kasuba and Evans 1981: constant ratio)
    F_n = μ_n N_n tanh(v_n/v_0)    on the drive flank, v_n = sliding of the pinion's flank on the gear's (`friction`)

Between flanks that approach without touching a squeezed film may act: N_n = 12 π η L (R_e/2h)^1.5 ẋ (rigid cylinders,
iso-viscous; derived). Positions are in base pitches, as in `mesh_force`; outside the path of contact the stiffness is
that of its end. Load sharing is N_n/ΣN and needs no formula of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from siggen.dynamics.friction import FrictionLaw, constant_friction, friction_force
from siggen.dynamics.mesh_force import read_only

if TYPE_CHECKING:
    from siggen.gears.missing_material import MissingMaterial
    from siggen.gears.tables import MeshTables

FloatArray = NDArray[np.float64]

NORMAL, FRICTION, PENETRATION, STIFFNESS, SLIDING, POSITION, FLANK = range(7)
"""Columns of the table of pairs: forces [N], penetration [m], stiffness [N/m], sliding speed [m/s], position s [m], and
+1, -1, 0 for the drive flank, the back flank and no contact."""
COLUMNS = 7


class PairLaw(NamedTuple):
    """All that the compiled pair law needs (a named tuple, since compiled code takes no dataclass)."""

    stiffness: FloatArray  # (tables, points) over the path of contact
    table_of_pair: NDArray[np.int32]  # (z_1, z_2)
    contact_ratio: float
    intervals_per_pitch: float
    missing_1: FloatArray  # (kinds, points) over the path of contact and the reach of the corners
    kind_of_tooth_1: NDArray[np.int32]  # (z_1,)
    offset_1: FloatArray  # (z_1,)
    missing_2: FloatArray
    kind_of_tooth_2: NDArray[np.int32]
    offset_2: FloatArray
    missing_intervals_per_pitch: float
    reach_before: float
    reach_after: float
    start_m: float
    base_pitch_m: float
    line_of_action_m: float
    damping_root_kg: float  # 2 ζ √m_e, in √kg
    backlash_m: float
    film_n_s_per_m: float  # 12 π η L, 0 without a film
    film_floor_m: float
    rubs: bool
    friction: FrictionLaw


@dataclass(frozen=True, slots=True)
class SqueezeFilm:
    """Oil that is pressed out between flanks that approach each other; thinner films than the floor do not occur."""

    viscosity_pa_s: float
    face_width_m: float
    floor_m: float


def pair_law(
    tables: MeshTables,
    missing: MissingMaterial,
    *,
    line_of_action_m: float,
    damping_ratio: float,
    equivalent_mesh_mass_kg: float,
    backlash_m: float,
    friction: FrictionLaw | None = None,
    film: SqueezeFilm | None = None,
) -> PairLaw:
    """Return the law of these tables.

    Raises
    ------
    ValueError
        If damping, backlash or film are negative or not finite, or the missing material does not cover the
        path of contact.
    """
    numbers = {"damping_ratio": damping_ratio, "backlash_m": backlash_m}
    if film is not None:
        numbers |= {"film viscosity_pa_s": film.viscosity_pa_s}
    for name, value in numbers.items():
        if not (np.isfinite(value) and value >= 0.0):
            raise ValueError(f"{name}: received {value}; allowed are finite values from 0")
    pitch = tables.base_pitch_m
    before, after = (tables.start_m - missing.start_m) / pitch, (missing.end_m - tables.end_m) / pitch
    if min(before, after) < -1e-9:
        raise ValueError(
            f"missing material: received tables from {missing.start_m} m to {missing.end_m} m; allowed are tables "
            f"from {tables.start_m} m or before to {tables.end_m} m or after"
        )
    stiffness = read_only(tables.pair_stiffness_n_per_m, np.float64)
    ratio = (tables.end_m - tables.start_m) / pitch
    return PairLaw(
        stiffness=stiffness,
        table_of_pair=read_only(tables.table_of_pair, np.int32),
        contact_ratio=float(ratio),
        intervals_per_pitch=float((stiffness.shape[1] - 1) / ratio),
        missing_1=read_only(missing.pinion.profile_m, np.float64),
        kind_of_tooth_1=read_only(missing.pinion.kind_of_tooth, np.int32),
        offset_1=read_only(missing.pinion.offset_m, np.float64),
        missing_2=read_only(missing.gear.profile_m, np.float64),
        kind_of_tooth_2=read_only(missing.gear.kind_of_tooth, np.int32),
        offset_2=read_only(missing.gear.offset_m, np.float64),
        missing_intervals_per_pitch=float(
            (missing.pinion.profile_m.shape[1] - 1) * pitch / (missing.end_m - missing.start_m)
        ),
        reach_before=max(0.0, float(before)),
        reach_after=max(0.0, float(after)),
        start_m=float(tables.start_m),
        base_pitch_m=float(pitch),
        line_of_action_m=float(line_of_action_m),
        damping_root_kg=2.0 * float(damping_ratio) * float(np.sqrt(equivalent_mesh_mass_kg)),
        backlash_m=float(backlash_m),
        film_n_s_per_m=0.0 if film is None else 12.0 * np.pi * film.viscosity_pa_s * film.face_width_m,
        film_floor_m=1.0 if film is None else film.floor_m,
        rubs=friction is not None,
        friction=constant_friction(0.0) if friction is None else friction,
    )


def pair_slots(law: PairLaw) -> int:
    """Return how many pairs can be in reach at once; pair n has slot n mod slots during its whole engagement."""
    return int(np.floor(law.reach_before + law.contact_ratio + law.reach_after)) + 1


@njit(cache=True)
def _linear(table: FloatArray, row: int, place: float) -> float:
    """Return the value of a row `place` intervals from its first point, linear between points, kept beyond its ends."""
    place = min(max(place, 0.0), table.shape[1] - 1.0)
    index = min(int(place), table.shape[1] - 2)
    share = place - index
    return table[row, index] * (1.0 - share) + table[row, index + 1] * share


@njit(cache=True)
def _find_contacts(law: PairLaw, approach_m: float, pitches: float, pairs: FloatArray) -> float:
    """Write stiffness, position, penetration and flank of the pairs in reach; return Σk of those that touch."""
    pairs[:] = 0.0
    touching = 0.0
    pair = int(np.floor(pitches + law.reach_before))
    while pitches - pair < law.contact_ratio + law.reach_after:
        place = pitches - pair
        tooth_1, tooth_2 = pair % law.kind_of_tooth_1.size, pair % law.kind_of_tooth_2.size
        k = _linear(law.stiffness, law.table_of_pair[tooth_1, tooth_2], place * law.intervals_per_pitch)
        at = (place + law.reach_before) * law.missing_intervals_per_pitch
        offset = law.offset_1[tooth_1] + law.offset_2[tooth_2]
        missing = _linear(law.missing_1, law.kind_of_tooth_1[tooth_1], at)
        missing += _linear(law.missing_2, law.kind_of_tooth_2[tooth_2], at)
        row = pairs[pair % pairs.shape[0]]
        row[STIFFNESS] = k
        row[POSITION] = law.start_m + place * law.base_pitch_m
        row[PENETRATION] = approach_m - offset - missing
        if row[PENETRATION] > 0.0:
            row[FLANK] = 1.0
            touching += k
        elif approach_m - offset < -law.backlash_m:
            row[FLANK] = -1.0
            row[PENETRATION] = approach_m - offset + law.backlash_m
            touching += k
        pair -= 1
    return touching


@njit(cache=True)
def _film_force(law: PairLaw, position_m: float, gap_m: float, rate_m_s: float) -> float:
    """Return the force of the film between flanks of a pair in the path of contact; none where they part."""
    place = (position_m - law.start_m) / law.base_pitch_m
    if rate_m_s <= 0.0 or place < 0.0 or place > law.contact_ratio:
        return 0.0
    curvature_m = position_m * (law.line_of_action_m - position_m) / law.line_of_action_m
    return law.film_n_s_per_m * (0.5 * curvature_m / max(gap_m, law.film_floor_m)) ** 1.5 * rate_m_s


@njit(cache=True)
def pair_forces(
    law: PairLaw,
    approach_m: float,
    rate_m_s: float,
    pitches: float,
    sliding_0_m_s: float,
    sliding_1_per_s: float,
    pairs: FloatArray,
) -> None:
    """Write the forces of all pairs into `pairs` (slots, COLUMNS); sliding speed at s: sliding_0 + s sliding_1."""
    touching = _find_contacts(law, approach_m, pitches, pairs)
    damping = law.damping_root_kg / np.sqrt(touching) if touching > 0.0 else 0.0
    for i in range(pairs.shape[0]):
        row = pairs[i]
        if row[STIFFNESS] == 0.0:
            continue
        row[SLIDING] = sliding_0_m_s + row[POSITION] * sliding_1_per_s
        if row[FLANK] == 0.0:
            if law.film_n_s_per_m > 0.0:
                row[NORMAL] = _film_force(law, row[POSITION], -row[PENETRATION], rate_m_s)
            continue
        force = row[STIFFNESS] * (row[PENETRATION] + damping * rate_m_s)
        if row[FLANK] > 0.0:
            row[NORMAL] = max(0.0, force)
            if law.rubs:
                row[FRICTION] = friction_force(law.friction, 0, row[POSITION], row[NORMAL], row[SLIDING])
        else:
            row[NORMAL] = min(0.0, force)


@njit(cache=True)
def static_force(law: PairLaw, approach_m: float, pitches: float, pairs: FloatArray) -> float:
    """Return ΣN [N] at rest."""
    pair_forces(law, approach_m, 0.0, pitches, 0.0, 0.0, pairs)
    total = 0.0
    for i in range(pairs.shape[0]):
        total += pairs[i, NORMAL]
    return total


def static_approach_m(law: PairLaw, force_n: float, pitches: float) -> float:
    """Return the approach [m] at which the pairs carry a force [N] at rest; negative on the back flank.

    Raises
    ------
    ValueError
        If not even a penetration of a tenth of a base pitch carries it.
    """
    pairs = np.empty((pair_slots(law), COLUMNS))
    reach = 0.1 * law.base_pitch_m
    low, high = -law.backlash_m - reach, reach
    if not static_force(law, low, pitches, pairs) <= force_n <= static_force(law, high, pitches, pairs):
        raise ValueError(f"force_n: received {force_n}; allowed are forces that teeth carry within {reach:.3g} m")
    # Monotone, so halving always ends; 80 halvings of 2 mm are below the rounding of a nanometre.
    for _ in range(80):
        middle = 0.5 * (low + high)
        if static_force(law, middle, pitches, pairs) < force_n:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
