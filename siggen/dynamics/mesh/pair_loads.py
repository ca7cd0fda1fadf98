"""Forces of a pair by its spring and its motion, compiled: damper, friction; for one value or for lanes of them.

Equations: `pair_law`.
"""

from __future__ import annotations

from typing import NamedTuple

from siggen.compiled import njit
from siggen.dynamics.friction.asperity_table import LoadGrid, cell_value, contact_cell
from siggen.dynamics.friction.friction import friction_mixed
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.contact_spring import Spring
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.lanes import Choice, Lanes, any_of, hyperbolic_tangent, larger, magnitude, select

STRAIGHT = 10.0
"""tanh is 1 within 4e-9 beyond."""
LEAST_CARRYING = 1e-3
"""Of the face, less than a slice: what a force is divided by where a motion that diverges leaves the table."""
Value = Lanes
"""A number, or lanes of numbers."""


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
    corner, a, b = contact_cell(grid, position_m, load_n, chosen)
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
    turns = magnitude(speed) < STRAIGHT
    way = select(turns, hyperbolic_tangent(speed, rubs & turns), select(speed < 0.0, -1.0, 1.0))
    return Rubbed(coefficient * force_n * way, coefficient, share)
