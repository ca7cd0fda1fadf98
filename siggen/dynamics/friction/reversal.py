"""Sliding speed over which the friction of asperities turns round at the pitch point.

Model: flanks that stick have to be pushed back before they slip the other way (presliding; Cattaneo, Mindlin). Teeth
pass the pitch point with the rate of sliding a = (Ω_1 + Ω_2) Ω_1 R_b1, so a push of 2 δ is done at √(4 a δ). Two
compliances in a row give way (derived): δ = μ_b (La δ_H + κ w).

* δ_H = 2 F_l/(π E*) [ln(2 d/b) - ν/(2 (1 - ν))], the approach of two half planes to the depth d. In plane strain the
  tangential one has the same factor of the logarithm; the number after it is left as it is for normal loads.
* κ w: asperities that are pressed together by w slip at μ κ w, κ = (2 - ν)/(2 (1 - ν)) (Mindlin, equal spheres). w is
  the mean over their load, σ F_5/2(Λ)/F_3/2(Λ), of Gaussian heights under Hertz's law.

Mindlin's turn F = 1 - 2 (1 - v²/(4 a δ))^1.5 goes from -0.9 to 0.9 between 0.18 and 0.93 of √(4 a δ), and tanh(v/v_0)
does over 2.94 v_0: v_0 = √(4 a δ)/3.95. The turn is half-way at 0.61 √(4 a δ), later than v = 0. The law leaves this
lag out, since it would give power back for that moment.

Steady rolling (Carter) would end the turn at μ_b b u_e/R_e, which is a tenth of that: it needs the time in which flanks
pass the width, which is three to five times as long as the push. The sliding speed itself differs over the width by
(Ω_1 + Ω_2) b² (1/ρ_1 - 1/ρ_2)/4 alone (Heathcote), since the flanks turn about the pitch point: less than a hundredth.
"""

from __future__ import annotations

from math import log, pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy.special import gamma, pbdv

from siggen.dynamics.friction.asperity_share import asperity_load_share
from siggen.dynamics.friction.contact_kinematics import Values, hertz_half_width, relative_radius
from siggen.dynamics.friction.lubrication import LubricatedMesh, central_film_m, film_ratio

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
