"""Forces of all tooth pairs in reach, compiled: springs, dampers, squeezed film and friction.

Equations: `pair_law`.
"""

from __future__ import annotations

from math import tanh

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit
from siggen.dynamics.friction.asperity_table import cell_value, contact_cell
from siggen.dynamics.friction.friction import friction_mixed
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.contact_spring import contact_moment, contact_shares
from siggen.dynamics.mesh.pair_columns import (
    ASPERITY_SHARE,
    CARRYING,
    COEFFICIENT,
    CROSS,
    DAMPING,
    FLANK,
    FRICTION,
    MOMENT,
    NORMAL,
    PENETRATION,
    PLACED,
    POSITION,
    ROUGH,
    SLIDING,
    STIFFNESS,
    TILT_RATE,
    TOUCH,
    TURNING,
    WHOLE,
)
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.mesh.pair_places import find_flanks, pair_table, place_pairs
from siggen.dynamics.mesh.pair_springs import share_coupled, spring_of_flank

LEAST_CARRYING = 1e-3
"""Of the face, less than a slice: what a force is divided by where a motion that diverges leaves the table."""


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def film_force(scalars: FloatArray, position_m: float, gap_m: float, rate_m_s: float) -> float:
    """Return the force of the film between flanks of a pair in the path of contact; none where they part."""
    place = (position_m - scalars[layout.START_M]) / scalars[layout.PITCH_M]
    if rate_m_s <= 0.0 or place < 0.0 or place > scalars[layout.CONTACT_RATIO]:
        return 0.0
    curvature_m = position_m * (scalars[layout.LINE_M] - position_m) / scalars[layout.LINE_M]
    force_n: float = (
        scalars[layout.FILM] * (0.5 * curvature_m / max(gap_m, scalars[layout.FILM_FLOOR_M])) ** 1.5 * rate_m_s
    )
    return force_n


@njit(cache=True, _nrt=False, inline="always", error_model="numpy")
def lubricated(
    scalars: FloatArray,
    numbers: FloatArray,
    index: IntArray,
    position_m: float,
    load_n: float,
    rough: float,
) -> tuple[float, float]:
    """Return asperity share and friction coefficient at a force per carrying share; rough lands count by theirs."""
    loads, positions = index[layout.LUBRICATED_LOADS], index[layout.LUBRICATED_POSITIONS]
    along, up, a, b = contact_cell(
        positions, loads, scalars[layout.LUBRICATED_LINE], scalars[layout.LUBRICATED_START],
        scalars[layout.LUBRICATED_PER_M], scalars[layout.LUBRICATED_FLOOR], scalars[layout.LUBRICATED_PER_LOG],
        position_m, load_n,
    )  # fmt: skip
    corner = along * loads + up
    share = min(cell_value(numbers, index[layout.RATIO_AT] + corner, loads, a, b), 1.0)
    if rough > 0.0 and index[layout.ROUGHNESSES] > 1:
        raised = cell_value(numbers, index[layout.RATIO_AT] + positions * loads + corner, loads, a, b)
        share = share * (1.0 - rough) + min(raised, 1.0) * rough
    fluid = cell_value(numbers, index[layout.FLUID_AT] + corner, loads, a, b)
    return share, friction_mixed(share, scalars[layout.BOUNDARY], fluid)


@njit(cache=True, _nrt=False, inline="always")
def _lubricate(
    scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int, force_n: float
) -> None:
    """Write asperity share and friction coefficient of slot i at a force."""
    load = force_n / max(pairs[i, CARRYING], LEAST_CARRYING)
    pairs[i, ASPERITY_SHARE], pairs[i, COEFFICIENT] = lubricated(
        scalars, numbers, index, pairs[i, POSITION], load, pairs[i, ROUGH]
    )


@njit(cache=True, _nrt=False, inline="always")
def _load(
    scalars: FloatArray,
    numbers: FloatArray,
    index: IntArray,
    pairs: FloatArray,
    i: int,
    elastic: float,
    damping: float,
    rate_m_s: float,
) -> None:
    """Write the forces of a touching slot: spring, damper, friction on the drive flank."""
    root, driven = scalars[layout.DAMPING_ROOT], pairs[i, FLANK] > 0.0
    if index[layout.SHARE_DAMPS] > 0:
        root = scalars[layout.DAMPING_STRUCTURE] + scalars[layout.DAMPING_FILM]
        if driven:
            _lubricate(scalars, numbers, index, pairs, i, elastic)
            share = pairs[i, ASPERITY_SHARE]
            root = scalars[layout.DAMPING_STRUCTURE] + scalars[layout.DAMPING_FILM] * (1.0 - share)
            root += scalars[layout.DAMPING_ASPERITIES] * share
    pairs[i, DAMPING] = root * damping * pairs[i, STIFFNESS]
    force = elastic + pairs[i, DAMPING] * rate_m_s
    if driven and index[layout.CONTACT_VALUES] > 4:
        # The damper answers to the rate of the whole state as the spring's tangent does: it never gives work.
        force += root * damping * pairs[i, CROSS] * pairs[i, TILT_RATE]
        turned = pairs[i, CROSS] * rate_m_s + pairs[i, TURNING] * pairs[i, TILT_RATE]
        pairs[i, MOMENT] = pairs[i, MOMENT] + root * damping * turned if force > 0.0 else 0.0
    if not driven:
        pairs[i, NORMAL] = min(0.0, force)
    elif force > 0.0:
        pairs[i, NORMAL] = force
        if index[layout.ROUGHNESSES] > 0:
            _lubricate(scalars, numbers, index, pairs, i, force)
            pairs[i, FRICTION] = pairs[i, COEFFICIENT] * force * tanh(pairs[i, SLIDING] / scalars[layout.SLIP_SPEED])


@njit(cache=True, _nrt=False, inline="always")
def write_spread(scalars: FloatArray, numbers: FloatArray, index: IntArray, pairs: FloatArray, i: int) -> float:
    """Write share on damage, and moment where gears tilt, of a slot; return the carrying share of its face."""
    carrying, pairs[i, ROUGH] = contact_shares(scalars, numbers, index, pairs, i, pairs[i, PENETRATION])
    if index[layout.CONTACT_VALUES] > 4:
        pairs[i, MOMENT], pairs[i, CROSS], pairs[i, TURNING] = contact_moment(
            scalars, numbers, index, pairs, i, pairs[i, PENETRATION]
        )
    return carrying


@njit(cache=True, _nrt=False)
def write_forces(
    scalars: FloatArray,
    numbers: FloatArray,
    index: IntArray,
    approach_m: float,
    rate_m_s: float,
    pitches: float,
    sliding_0_m_s: float,
    sliding_1_per_s: float,
    pairs: FloatArray,
) -> None:
    """Write what `pair_forces` writes, from the arrays of a law: for loops that have taken them out of it once."""
    if pairs[0, PLACED] != pitches:
        place_pairs(scalars, numbers, index, pitches, pairs)
    find_flanks(scalars, approach_m, pairs)
    if index[layout.APART] > 0:
        share_coupled(scalars, numbers, index, pairs)
    touching = 0.0
    for i in range(pairs.shape[0]):
        for column in range(NORMAL, FRICTION + 1):
            pairs[i, column] = 0.0
        for column in range(CARRYING, DAMPING + 1):
            pairs[i, column] = 0.0
        pairs[i, MOMENT] = 0.0
        if pairs[i, WHOLE] == 0.0:
            for column in range(PENETRATION, FLANK + 1):
                pairs[i, column] = 0.0
            continue
        pairs[i, SLIDING] = sliding_0_m_s + pairs[i, POSITION] * sliding_1_per_s
        # NORMAL holds the elastic force until the damping is known, which needs the stiffness of all that touch.
        elastic, tangent = spring_of_flank(scalars, numbers, index, pairs, i, pairs[i, PENETRATION])
        if elastic == 0.0:
            pairs[i, FLANK], pairs[i, STIFFNESS] = 0.0, pairs[i, WHOLE]
            continue
        pairs[i, FLANK] = 1.0 if elastic > 0.0 else -1.0
        carrying = 1.0
        if elastic > 0.0 and index[layout.CONTACT_NODES] > 0:
            carrying = write_spread(scalars, numbers, index, pairs, i)
        pairs[i, NORMAL], pairs[i, STIFFNESS], pairs[i, CARRYING] = elastic, tangent, carrying
        touching += tangent
    damping = 1.0 / np.sqrt(touching) if touching > 0.0 else 0.0
    for i in range(pairs.shape[0]):
        if pairs[i, FLANK] != 0.0:
            elastic = pairs[i, NORMAL]
            pairs[i, NORMAL] = 0.0
            _load(scalars, numbers, index, pairs, i, elastic, damping, rate_m_s)
        elif scalars[layout.FILM] > 0.0 and pairs[i, WHOLE] > 0.0:
            gap = pairs[i, TOUCH] - pairs[i, PENETRATION]
            pairs[i, NORMAL] = film_force(scalars, pairs[i, POSITION], gap, rate_m_s)


@njit(cache=True, _nrt=False)
def pair_forces(
    law: PairLaw,
    approach_m: float,
    rate_m_s: float,
    pitches: float,
    sliding_0_m_s: float,
    sliding_1_per_s: float,
    pairs: FloatArray,
) -> None:
    """Write the forces of all pairs into `pairs` of `pair_table`; sliding speed at s: sliding_0 + s sliding_1."""
    write_forces(
        law.scalars, law.numbers, law.places, approach_m, rate_m_s, pitches, sliding_0_m_s, sliding_1_per_s, pairs
    )


@njit(cache=True, _nrt=False)
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
    pairs = pair_table(law)
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
