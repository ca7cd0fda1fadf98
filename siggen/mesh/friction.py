"""FrictionLaw: the friction force between two flanks, compiled for the time loop.

Derived (the composite law is standard): μ = La μ_b + (1 - La) min(μ_EHL, μ_b) with the asperity share La, so μ stays
between μ_EHL and μ_b whatever the roughness of a pit; F = μ N tanh(v/v_0) with the sliding speed v of
`contact_kinematics.sliding_speed`, which keeps the sign of v: the dissipated power F v is never negative. v_0 is of the
asperities (`reversal`). The film turns round more slowly: μ_EHL (`film_traction`) is tabled over the place at the
mean speeds and is 0 at the pitch point. F acts in -x on the pinion (arm s) and in +x on the gear (arm T - s). A force
N <= 0 gives no friction: on the back flank the line of action is another one.
"""

from __future__ import annotations

from math import log, pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy.special import gamma, pbdv

from siggen.compiled import entry, njit
from siggen.lanes import Lanes, smaller
from siggen.mesh.asperities import AsperityTable, mixed_contact
from siggen.mesh.lubrication import (
    LubricatedMesh,
    Values,
    asperity_load_share,
    central_film_m,
    film_ratio,
    hertz_half_width,
    relative_radius,
)

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
    """Return the composite law of a table of shares and fluid friction."""
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


# Sliding speed over which the friction of asperities turns round at the pitch point.
#
# Model: flanks that stick have to be pushed back before they slip the other way (presliding; Cattaneo, Mindlin). Teeth
# pass the pitch point with the rate of sliding a = (Ω_1 + Ω_2) Ω_1 R_b1, so a push of 2 δ is done at √(4 a δ). Two
# compliances in a row give way (derived): δ = μ_b (La δ_H + κ w).
#
# * δ_H = 2 F_l/(π E*) [ln(2 d/b) - ν/(2 (1 - ν))], the approach of two half planes to the depth d. In plane strain the
#   tangential one has the same factor of the logarithm; the number after it is left as it is for normal loads.
# * κ w: asperities that are pressed together by w slip at μ κ w, κ = (2 - ν)/(2 (1 - ν)) (Mindlin, equal spheres). w
#   is the mean over their load, σ F_5/2(Λ)/F_3/2(Λ), of Gaussian heights under Hertz's law.
#
# Mindlin's turn F = 1 - 2 (1 - v²/(4 a δ))^1.5 goes from -0.9 to 0.9 between 0.18 and 0.93 of √(4 a δ), and
# tanh(v/v_0) does over 2.94 v_0: v_0 = √(4 a δ)/3.95. The turn is half-way at 0.61 √(4 a δ), later than v = 0. The law
# leaves this lag out, since it would give power back for that moment.
#
# Steady rolling (Carter) would end the turn at μ_b b u_e/R_e, which is a tenth of that: it needs the time in which
# flanks pass the width, which is three to five times as long as the push. The sliding speed itself differs over the
# width by (Ω_1 + Ω_2) b² (1/ρ_1 - 1/ρ_2)/4 alone (Heathcote), since the flanks turn about the pitch point: less than a
# hundredth.

POISSON_RATIO = 0.3
"""Of steel; enters by a few per cent."""
TURN_OVER_SLIP_SPEED = 3.95
"""√(4 a δ)/v_0."""
THICKEST = 20.0
"""Largest film ratio that asperities are looked at with."""


class PitchPoint(NamedTuple):
    """Where and how teeth pass the pitch point: place [m], speed of the contact [m/s], depth of a tooth [m]."""

    position_m: float
    roll_speed_m_s: float
    depth_m: float


def slip_speed(mesh: LubricatedMesh, pitch: PitchPoint, force_n: float, roughness_m: float) -> float:
    """Return v_0 of F = μ N tanh(v/v_0) for the asperities of a pair that carries a force [m/s].

    Parameters
    ----------
    mesh : LubricatedMesh
    pitch : PitchPoint
    force_n : float
        Normal force of the pair [N].
    roughness_m : float
        Composite rms roughness σ [m].
    """
    turning = (mesh.speed_1_rad_s + mesh.speed_2_rad_s) * pitch.roll_speed_m_s
    return sqrt(4.0 * turning * presliding_m(mesh, pitch, force_n, roughness_m)) / TURN_OVER_SLIP_SPEED


def presliding_m(mesh: LubricatedMesh, pitch: PitchPoint, force_n: float, roughness_m: float) -> float:
    """Return δ, by which a pair's flanks give way before asperities slip [m]."""
    separation = float(film_ratio(central_film_m(mesh.groups(pitch.position_m, force_n)), roughness_m))
    share = float(asperity_load_share(separation))
    line_load = force_n / mesh.contact_length_m
    radius = float(relative_radius(pitch.position_m, mesh.line_m))
    width = float(hertz_half_width(line_load, radius, mesh.effective_modulus_pa))
    bracket = log(2.0 * pitch.depth_m / width) - POISSON_RATIO / (2.0 * (1.0 - POISSON_RATIO))
    approach = 4.0 * line_load / (pi * mesh.effective_modulus_pa) * max(bracket, 0.0)
    separation = min(separation, THICKEST)  # beyond, both integrals vanish; asperities carry nothing there
    pressed = roughness_m * float(gaussian_integral(2.5, separation) / gaussian_integral(1.5, separation))
    mindlin = (2.0 - POISSON_RATIO) / (2.0 * (1.0 - POISSON_RATIO))
    return mesh.boundary_friction * (share * approach + mindlin * pressed)


def gaussian_integral(order: float, separation: Values) -> Values:
    """Return F_n(H) = ∫_H^∞ (x - H)^n exp(-x²/2)/√(2π) dx, exact by the parabolic cylinder function.

    F_n(H) = Γ(n + 1) exp(-H²/4) D_{-n-1}(H)/√(2π) (reference: standard literature).
    """
    value: Values = (
        gamma(order + 1.0)
        * np.exp(-0.25 * np.square(separation))
        * pbdv(-order - 1.0, separation)[0]
        / np.sqrt(2.0 * np.pi)
    )
    return value
