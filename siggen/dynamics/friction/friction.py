"""FrictionLaw: the friction force between two flanks, compiled for the time loop.

Derived (the composite law is standard): μ = La μ_b + (1 - La) min(μ_EHL, μ_b) with the asperity share La, so μ stays
between μ_EHL and μ_b whatever the roughness of a pit; F = μ N tanh(v/v_0) with the sliding speed v of
`contact_kinematics.sliding_speed`, which keeps the sign of v: the dissipated power F v is never negative. v_0 is of the
asperities (`reversal`). The film turns round more slowly: μ_EHL (`film_traction`) is tabled over the place at the
mean speeds and is 0 at the pitch point. F acts in -x on the pinion (arm s) and in +x on the gear (arm T - s). A force
N <= 0 gives no friction: on the back flank the line of action is another one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.compiled import entry, njit
from siggen.dynamics.friction.asperity_table import AsperityTable, mixed_contact
from siggen.lanes import Lanes, smaller

SLIP_SPEED_M_S = 0.02
"""v_0 of a constant coefficient, of which nothing is known (assumed); lubricated flanks have their own (`reversal`)."""


class FrictionLaw(NamedTuple):
    """What the compiled friction force needs: tables, μ_b and the speed v_0 [m/s] that rounds the sign of v.

    A constant coefficient is a table of that fluid friction and share 0 (`constant_friction`).
    """

    table: AsperityTable
    boundary: float
    slip_speed_m_s: float


def composite_friction(table: AsperityTable, boundary: float, slip_speed_m_s: float = SLIP_SPEED_M_S) -> FrictionLaw:
    """Return the composite law of a table of shares and fluid friction.

    Raises
    ------
    ValueError
        If the boundary friction is outside 0 to 1 or the slip speed is not positive.
    """
    if not 0.0 <= boundary <= 1.0:
        raise ValueError(f"boundary: received {boundary}; allowed are 0 to 1, usual are 0.07 to 0.12")
    if not (np.isfinite(slip_speed_m_s) and slip_speed_m_s > 0.0):
        raise ValueError(f"slip_speed_m_s: received {slip_speed_m_s}; allowed are finite values above 0")
    return FrictionLaw(table, float(boundary), float(slip_speed_m_s))


def constant_friction(coefficient: float, slip_speed_m_s: float = SLIP_SPEED_M_S, layers: int = 1) -> FrictionLaw:
    """Return a law with one coefficient for all `layers` of roughness; 0 turns friction off.

    Raises
    ------
    ValueError
        If the coefficient is outside 0 to 1 or the slip speed is not positive.
    """
    share, fluid = np.zeros((layers, 2, 2)), np.full((2, 2), float(coefficient))
    for array in (share, fluid):
        array.setflags(write=False)
    table = AsperityTable(share, fluid, line_m=4.0, start_m=1.0, per_m=1.0, floor_n_per_m=1.0, per_log=1.0)
    return composite_friction(table, coefficient, slip_speed_m_s)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def friction_mixed(share: Lanes, boundary: float, fluid: Lanes) -> Lanes:
    """Return μ = La μ_b + (1 - La) min(μ_EHL, μ_b); numbers or lanes."""
    bounded = smaller(fluid, boundary)
    return bounded + share * (boundary - bounded)


@entry(cache=True)
def friction_coefficient(law: FrictionLaw, layer: int, position_m: float, force_n: float) -> float:
    """Return the friction coefficient of a contact on the flank roughness `layer` of the table."""
    share, fluid = mixed_contact(law.table, layer, position_m, force_n)
    coefficient: float = friction_mixed(share, law.boundary, fluid)
    return coefficient
