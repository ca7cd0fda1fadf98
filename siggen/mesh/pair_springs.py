"""Elastic forces of all tooth pairs at an angle, compiled: any number of slots, one pair after the other.

How two pairs on one gear body share the load says `two_springs`. More of them, or back flanks, are solved as one system
(derived: Newton's method on all forces), without what others take from a tangent.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.lanes import (
    Choice,
    Lanes,
    Whole,
    any_of,
    as_doubles,
    gather,
    gather_pairs,
    hyperbolic_tangent,
    larger,
    select,
    smaller,
    truncated,
)
from siggen.mesh import pair_law as layout
from siggen.mesh.asperities import LoadGrid, cell_value, contact_cell
from siggen.mesh.friction import friction_mixed
from siggen.mesh.pair_columns import (
    ALONE,
    CARRYING,
    COLUMNS,
    COLUMNS_AT,
    COUPLED,
    CROSS,
    CURVES,
    FLANK,
    MISSED_1_AT,
    MISSED_2_AT,
    MOMENT,
    MOST_APART,
    NODE_ROWS,
    NORMAL,
    OFFSET,
    PAIR,
    PENETRATION,
    POSITION,
    ROUGH,
    ROW,
    SHARE,
    SPRUNG,
    STIFFNESS,
    STIFFNESS_AT,
    TILT,
    TOUCH,
    TOUCH_AT,
    TURNING,
    WHOLE,
    YIELD,
    solution_columns,
)
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.springs import (
    LEAST_CHANGE,
    NO_SPRING,
    Before,
    PairPlace,
    Spring,
    flat_spring,
    pair_spring,
    two_springs,
)

# Where tooth pairs are at an angle, compiled: what no state changes, for one value or for lanes of them.
#
# Derived: pair n of the global count is pitches - n base pitches behind its entry. What belongs to a pair stays in the
# table of pairs until another one takes its slot.

Value = Lanes
"""A number, or lanes of numbers."""


class Engaged(NamedTuple):
    """What stays during the engagement of a pair, as floats.

    Its row in the tables, where its stiffness, its first touch, its columns and the missing material of both teeth
    begin, and the place of its teeth [m].
    """

    row: Value
    stiffness: Value
    touch: Value
    columns: Value
    missed_1: Value
    missed_2: Value
    offset: Value


class Placed(NamedTuple):
    """Position [m], cell of the tables and weight of its upper end, missing material and place of the teeth [m]."""

    position: Value
    cell: Whole
    weight: Value
    gap: Value


def pair_table(law: PairLaw) -> FloatArray:
    """Return a table of no pair yet: (slots, COLUMNS, space for a solution and, in row 0, for a node)."""
    pairs = np.zeros((law.slots, COLUMNS + solution_columns(law.slots) + NODE_ROWS))
    pairs[:, PAIR] = -np.inf
    return pairs


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def row_places(law: PairLaw, row: int) -> tuple[float, float, float]:
    """Return where stiffness, first touch and columns of a row of the tables begin."""
    index, points = law.places, law.places[layout.POINTS]
    first = row * points
    return float(index[layout.STIFFNESS_AT] + first), float(index[layout.TOUCH_AT] + first), float(first - row)


@njit(cache=True, _nrt=False, error_model="numpy")
def engaged(law: PairLaw, pair: int) -> Engaged:
    """Return what stays during the engagement of a pair."""
    numbers, index, count = law.numbers, law.places, law.places[layout.MISSING_POINTS]
    tooth_1, tooth_2 = pair % index[layout.TEETH_1], pair % index[layout.TEETH_2]
    row = index[index[layout.TABLE_AT] + tooth_1 * index[layout.TEETH_2] + tooth_2]
    stiffness, touch, columns = row_places(law, row)
    missed_1 = index[layout.MISSING_1_AT] + index[index[layout.KIND_1_AT] + tooth_1] * count
    missed_2 = index[layout.MISSING_2_AT] + index[index[layout.KIND_2_AT] + tooth_2] * count
    offset = numbers[index[layout.OFFSET_1_AT] + tooth_1] + numbers[index[layout.OFFSET_2_AT] + tooth_2]
    return Engaged(float(row), stiffness, touch, columns, float(missed_1), float(missed_2), offset)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def between(law: PairLaw, first: Whole, weight: Value) -> Value:
    """Return the value in the cell of a table that begins at `first`, linear in the weight of the cell's upper end."""
    low, high = gather_pairs(law.numbers, first)
    return low * (1.0 - weight) + high * weight


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def placed(law: PairLaw, pair: Engaged, place: Value) -> Placed:
    """Return where a pair is `place` pitches behind its entry; tables are held at their ends."""
    scalars, points, count = law.scalars, law.places[layout.POINTS], law.places[layout.MISSING_POINTS]
    along = smaller(larger(place * scalars[layout.PER_PITCH], 0.0), points - 1.0)
    cell = smaller(truncated(along), points - 2)
    missing = (place + scalars[layout.REACH_BEFORE]) * scalars[layout.MISSING_PER_PITCH]
    missing = smaller(larger(missing, 0.0), count - 1.0)
    there = smaller(truncated(missing), count - 2)
    share = missing - as_doubles(there)
    missed = between(law, truncated(pair.missed_1) + there, share)
    missed = missed + between(law, truncated(pair.missed_2) + there, share)
    position = scalars[layout.START_M] + place * scalars[layout.PITCH_M]
    return Placed(position, cell, along - as_doubles(cell), pair.offset + missed + scalars[layout.LEAD_M])


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def placed_contact(
    law: PairLaw, touch_at: Value, columns_at: Value, cell: Whole, weight: Value
) -> tuple[Value, Value, Value]:
    """Return first touch [m], beginning and share of the columns of a pair in the table of the contact.

    `touch_at` and `columns_at` are those of `Engaged`.
    """
    numbers, index = law.numbers, law.places
    first = truncated(columns_at) + cell
    column = gather(numbers, first + index[layout.COLUMN_AT])
    column = column + gather(numbers, first + index[layout.GAIN_AT]) * weight
    whole = smaller(truncated(column), index[layout.CONTACT_COLUMNS] - 2)
    curves = whole * (index[layout.CONTACT_NODES] * index[layout.CONTACT_VALUES]) + index[layout.CURVES_AT]
    touch = between(law, truncated(touch_at) + cell, weight)
    return touch, as_doubles(curves), column - as_doubles(whole)


FORCE, SLOPE, RIGHT, MATRIX = range(4)
"""Columns of the solution of many pairs: force, slope, right side; the matrix, and behind it the coupling."""
MOST_SHARES = 50
"""Beyond half of these, pairs are solved one at a time; Newton's method was never seen to need more than 5."""


@njit(cache=True, _nrt=False, error_model="numpy")
def write_springs(
    law: PairLaw, approach_m: float, pitches: float, pairs: FloatArray, base: int, before: int, slots: int,
    settled: float,
) -> int:  # fmt: skip
    """Write elastic force, its own stiffness, its stiffness to the approach, carrying share and flank of every slot.

    The slots are the rows of `pairs` from `base` on; those from `before` on hold a state near by, for a first guess.
    Pairs on one gear body are settled to a share of their force (SMOOTH_CHANGE or EXACT_CHANGE). Forces stand in
    NORMAL, stiffness in STIFFNESS and YIELD, 0 where nothing touches. Returns which slots touch, one digit to the base
    3 per slot: 0 none, 1 drive flank, 2 back flank.
    """
    for i in range(base, base + slots):
        pairs[i, WHOLE], pairs[i, POSITION], pairs[i, PENETRATION] = 0.0, 0.0, 0.0
    first, second, near, back = -1, -1, 0, False
    lift = abs(pairs[base, TILT]) * law.scalars[layout.CONTACT_HALF_FACE]  # how far one end of the face is ahead
    pair = int(np.floor(pitches + law.scalars[layout.REACH_BEFORE]))
    while pitches - pair < law.scalars[layout.CONTACT_RATIO] + law.scalars[layout.REACH_AFTER]:
        i = base + pair % slots
        gap = _place_pair(law, pairs, i, pair, pitches - pair)
        pair -= 1
        depth, flank = approach_m - gap, 0.0
        behind = 2.0 * (approach_m - pairs[i, OFFSET]) - depth + law.scalars[layout.BACKLASH_M]
        if depth <= 0.0 and behind < 0.0:
            depth, flank, back = behind, -1.0, True
        pairs[i, PENETRATION], pairs[i, ALONE], pairs[i, FLANK] = depth, depth, flank
        if depth + lift > 0.0 or flank < 0.0:
            near += 1
            first, second = (i, second) if first < 0 else (first, i)
    if law.places[layout.APART] == 0 or near < 2:
        return _write_alone(law, pairs, base, slots)
    if near > 2 or back or not _write_two(law, pairs, first, second, before - base, settled):
        return _write_many(law, pairs, base, before, slots)
    for i in range(base, base + slots):
        if i not in (first, second):
            _write(pairs, i, NO_SPRING)
    digit_1, digit_2 = 3 ** (first - base), 3 ** (second - base)
    return (digit_1 if pairs[first, FLANK] > 0.0 else 0) + (digit_2 if pairs[second, FLANK] > 0.0 else 0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _place_pair(law: PairLaw, pairs: FloatArray, i: int, pair: int, place: float) -> float:
    """Write what depends on the angle alone, `place` pitches behind the entry of a pair; return its missing material.

    That counts with the place of its teeth [m].
    """
    if pairs[i, PAIR] != pair:
        engage(law, pairs, i, pair)
    kept = Engaged(
        pairs[i, ROW], pairs[i, STIFFNESS_AT], pairs[i, TOUCH_AT], pairs[i, COLUMNS_AT], pairs[i, MISSED_1_AT],
        pairs[i, MISSED_2_AT], pairs[i, OFFSET],
    )  # fmt: skip
    position, cell, weight, gap = placed(law, kept, place)
    missing: float = gap
    pairs[i, POSITION], pairs[i, WHOLE] = position, between(law, int(kept.stiffness) + cell, weight)
    if law.places[layout.CONTACT_NODES] > 0:
        pairs[i, TOUCH], pairs[i, CURVES], pairs[i, SHARE] = placed_contact(law, kept.touch, kept.columns, cell, weight)
    for a in range(min(law.places[layout.APART], MOST_APART)):
        first = law.places[layout.COUPLING_AT] + a * law.places[layout.POINTS]
        pairs[i, COUPLED + a] = between(law, first + cell, weight)
    return missing


@njit(cache=True, _nrt=False, error_model="numpy")
def engage(law: PairLaw, pairs: FloatArray, i: int, pair: int) -> None:
    """Write what stays during the engagement of a pair."""
    pairs[i, PAIR] = pair
    (
        pairs[i, ROW], pairs[i, STIFFNESS_AT], pairs[i, TOUCH_AT], pairs[i, COLUMNS_AT], pairs[i, MISSED_1_AT],
        pairs[i, MISSED_2_AT], pairs[i, OFFSET],
    ) = engaged(law, pair)  # fmt: skip


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_many(law: PairLaw, pairs: FloatArray, base: int, before: int, slots: int) -> int:
    """Write the springs of more than two pairs, or with a back flank, without what others take from a tangent."""
    for i in range(slots):
        pairs[base + i, NORMAL] = pairs[before + i, SPRUNG]
    _share(law, pairs[base : base + slots])
    return _write_alone(law, pairs, base, slots)


@njit(cache=True, _nrt=False, error_model="numpy")
def _write_alone(law: PairLaw, pairs: FloatArray, base: int, slots: int) -> int:
    """Write the springs at the penetrations in the table."""
    touching, digit = 0, 1
    for i in range(base, base + slots):
        spring = NO_SPRING
        if pairs[i, WHOLE] > 0.0:
            spring = _spring(law, pairs, i, pairs[i, PENETRATION])
        _write(pairs, i, spring)
        if spring.force != 0.0:
            touching += digit if spring.force > 0.0 else 2 * digit
        digit *= 3
    return touching


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _place(pairs: FloatArray, i: int) -> PairPlace:
    return PairPlace(pairs[i, ALONE], pairs[i, TOUCH], pairs[i, CURVES], pairs[i, SHARE], pairs[i, WHOLE])


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _spring(law: PairLaw, pairs: FloatArray, i: int, penetration_m: float) -> Spring:
    """Return the spring of the flank of slot i; the back flank has no damage."""
    if pairs[i, FLANK] < 0.0:
        return flat_spring(pairs[i, WHOLE], penetration_m, -1.0)
    return pair_spring(law, _place(pairs, i), pairs[i, TILT], penetration_m)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write(pairs: FloatArray, i: int, spring: Spring) -> None:
    touches = spring.force != 0.0
    pairs[i, NORMAL], pairs[i, STIFFNESS] = spring.force, spring.stiffness if touches else 0.0
    pairs[i, SPRUNG] = spring.force
    pairs[i, YIELD], pairs[i, MOMENT] = spring.yielding if touches else 0.0, spring.moment
    pairs[i, CROSS], pairs[i, TURNING] = spring.cross, spring.turning
    pairs[i, CARRYING], pairs[i, ROUGH] = spring.carrying, spring.rough
    pairs[i, FLANK] = 1.0 if spring.force > 0.0 else (-1.0 if touches else 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _write_two(law: PairLaw, pairs: FloatArray, i: int, j: int, offset: int, settled: float) -> bool:
    """Write the springs of two drive flanks on one gear body, i entered later; return whether that is settled.

    The state before stands `offset` rows on.
    """
    away = int(pairs[i, PAIR] - pairs[j, PAIR])
    c = pairs[i, COUPLED + away - 1] if away <= min(law.places[layout.APART], MOST_APART) else 0.0
    before = _before(pairs, i, i + offset), _before(pairs, j, j + offset)
    spring_i, spring_j, near = two_springs(law, c, pairs[i, TILT], settled, _place(pairs, i), _place(pairs, j), before)
    if near:
        pairs[i, PENETRATION], pairs[j, PENETRATION] = spring_i.penetration, spring_j.penetration
        _write(pairs, i, spring_i)
        _write(pairs, j, spring_j)
    return near


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _before(pairs: FloatArray, i: int, before: int) -> Before:
    """Return the spring in a state near by; zeros of another pair."""
    if pairs[before, PAIR] != pairs[i, PAIR]:
        return Before(0.0, 0.0, 0.0)
    return Before(pairs[before, SPRUNG], pairs[before, STIFFNESS], pairs[i, ALONE] - pairs[before, ALONE])


@njit(cache=True, _nrt=False)
def coupling_of(law: PairLaw, pairs: FloatArray, apart: int, i: int, j: int) -> float:
    """Return c of two slots [m/N]."""
    away = int(np.round((pairs[i, POSITION] - pairs[j, POSITION]) / law.scalars[layout.PITCH_M]))
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
def _share(law: PairLaw, pairs: FloatArray) -> None:
    """Replace the penetration of every pair by itself with that under the forces of the others."""
    slots, apart = pairs.shape[0], min(law.places[layout.APART], MOST_APART)
    coupling = MATRIX + slots
    work = pairs[:, COLUMNS:]  # of the table itself: code that allocates nothing need not count references
    for i in range(slots):
        for column in range(coupling + slots):
            work[i, column] = 0.0
    _prepare(law, pairs, work, apart)
    for step in range(MOST_SHARES):
        settled = True
        for i in range(slots):
            found, tangent = 0.0, 0.0
            if pairs[i, WHOLE] > 0.0:
                pairs[i, PENETRATION] = _under_others(pairs, work, coupling, i)
                spring = _spring(law, pairs, i, pairs[i, PENETRATION])
                found, tangent = spring.force, spring.stiffness
            settled = settled and tangent == work[i, SLOPE]
            work[i, SLOPE], work[i, RIGHT] = tangent, found - work[i, FORCE]
            if step > MOST_SHARES // 2:
                # Pieces that alternate, which strong couplings could make: one pair at a time always ends.
                work[i, FORCE], work[i, RIGHT] = found, 0.0
        # One at a time, the same pieces twice are no proof: all steps are taken, each far nearer than the one before.
        if settled and step <= MOST_SHARES // 2:
            return
        if _newton_step(work, coupling) <= LEAST_CHANGE:
            for i in range(slots):
                pairs[i, PENETRATION] = _under_others(pairs, work, coupling, i)
            return


@njit(cache=True, _nrt=False, inline="always")
def _prepare(law: PairLaw, pairs: FloatArray, work: FloatArray, apart: int) -> None:
    """Write first guesses and couplings."""
    slots = pairs.shape[0]
    for i in range(slots):
        work[i, SLOPE] = -1.0
        if pairs[i, WHOLE] == 0.0:
            continue
        work[i, FORCE] = pairs[i, NORMAL]  # of the evaluation before, a near guess
        for j in range(slots):
            if i != j and pairs[j, WHOLE] > 0.0:
                work[i, MATRIX + slots + j] = coupling_of(law, pairs, apart, i, j)


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
def _under_others(pairs: FloatArray, work: FloatArray, coupling: int, i: int) -> float:
    """Return the penetration of a slot under the forces of the others [m]."""
    left: float = pairs[i, ALONE]
    others = 0.0
    for j in range(work.shape[0]):
        others += work[i, coupling + j] * work[j, FORCE]
    return left - others


# Forces of a pair by its spring and its motion, compiled: damper, friction; for one value or for lanes of them.
#
# Equations: `pair_law`.

LEAST_CARRYING = 1e-3
"""Of the face, less than a slice: what a force is divided by where a motion that diverges leaves the table."""


class Damped(NamedTuple):
    """Force [N], 0 where it would pull; damping [N s/m]; moment [N m]; whether there is a force."""

    force: Value
    damping: Value
    moment: Value
    carries: Choice


class Rubbed(NamedTuple):
    """Friction [N], its coefficient, and the share of the load that asperities carry."""

    friction: Value
    coefficient: Value
    share: Value


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def damped(law: PairLaw, root: Value, rate: Value, tilt_rate: Value, spring: Spring) -> Damped:
    """Return spring and damper together; `root`: c √Σk/k over √Σk.

    The damper answers to the rate of the whole state as the spring's tangent does: it never gives work.
    """
    driven, back = spring.force > 0.0, spring.force < 0.0
    damping, moment = root * spring.stiffness, spring.moment
    force = spring.force + damping * rate
    if law.places[layout.CONTACT_VALUES] > 4:
        turned = root * tilt_rate
        force = select(driven, force + spring.cross * turned, force)
        moment = spring.moment + root * spring.cross * rate + spring.turning * turned
        moment = select(driven & (force > 0.0), moment, 0.0)
    carries = (driven & (force > 0.0)) | (back & (force < 0.0))
    return Damped(select(carries, force, 0.0), damping, moment, carries)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def lubricated(law: PairLaw, position_m: Value, load_n: Value, rough: Value, chosen: Choice) -> tuple[Value, Value]:
    """Return asperity share and friction coefficient at a force per carrying share, of use where chosen.

    Rough lands count by their share.
    """
    scalars, numbers, index = law.scalars, law.numbers, law.places
    loads, positions = index[layout.LUBRICATED_LOADS], index[layout.LUBRICATED_POSITIONS]
    grid = LoadGrid(
        positions, loads, scalars[layout.LUBRICATED_LINE], scalars[layout.LUBRICATED_START],
        scalars[layout.LUBRICATED_PER_M], scalars[layout.LUBRICATED_FLOOR], scalars[layout.LUBRICATED_PER_LOG],
    )  # fmt: skip
    corner, a, b = contact_cell(grid, position_m, load_n)
    share = cell_value(numbers, corner + index[layout.SHARE_AT], loads, a, b)
    if index[layout.ROUGHNESSES] > 1 and any_of(chosen & (rough > 0.0)):
        raised = cell_value(numbers, corner + (index[layout.SHARE_AT] + positions * loads), loads, a, b)
        share = select(rough > 0.0, share * (1.0 - rough) + raised * rough, share)
    fluid = cell_value(numbers, corner + index[layout.FLUID_AT], loads, a, b)
    return share, friction_mixed(share, scalars[layout.BOUNDARY], fluid)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def rubbed(law: PairLaw, force_n: Value, position_m: Value, faces: tuple[Value, Value], sliding: Value) -> Rubbed:
    """Return the friction of a flank at the size of its force; of no use where there is none.

    `faces`: carrying share of the face, and share of the load on damage; `sliding`: speed [m/s].
    """
    carrying, rough = faces
    rubs = force_n > 0.0
    load_n = select(rubs, force_n, 0.0) / larger(carrying, LEAST_CARRYING)
    share, coefficient = lubricated(law, position_m, load_n, rough, rubs)
    speed = sliding / law.scalars[layout.SLIP_SPEED]
    return Rubbed(coefficient * force_n * hyperbolic_tangent(speed), coefficient, share)
