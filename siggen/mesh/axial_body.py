r"""Axial compliance of a gear body: the force of helical teeth along the axis bends it as an annular plate.

Derived: Mindlin plate theory (Mindlin 1951, shear factor 5/6), of the thickness of the face, held at the hub and free
at the root circle. Beside the shear force Q the plate has the rotations ψ = -∇w + Q/S, S = 5 G b/6. Equilibrium leaves
ψ = ∇φ + curl χ, w = (D/S) ∇²φ - φ with ∇⁴φ = 0 and ∇²χ = λ² χ, λ² = 10/b². Around the rim all is a sum of cos mθ, so
that every m has four powers of the radius and two Bessel functions, and three conditions at either edge.

The tooth brings an axial force and, since it acts at the height u above the root circle, a moment u times it. Both
spread evenly over the arc of the root (half angle θ_f), as forces do in the foundation in the gear's plane (Sainsot),
and the deflection is the mean over that arc at the height of the force:

    E b w/F = Σ_m q_m sinc²(m θ_f) (1, u/R)ᵀ P_m (1, u/R) cos mΔ,   q_0 = 1/(2π), else 1/π

P_m: deflection and slope of the rim under unit loads of cos mθ, lengths over R; Δ: angle to the tooth that is read.
"""

from __future__ import annotations

from functools import lru_cache
from math import pi

import numpy as np
from scipy.special import ive, kve

from siggen.arrays import FloatArray
from siggen.gears.planetary import RingGear
from siggen.gears.spur_gear import SpurGear

SHEAR_FACTOR = 5.0 / 6.0
WAVES = 60
"""Waves around the rim that are summed: of 18 to 100 teeth the others are below 1e-3 of the sum (tested)."""


def axial_compliance(
    gear: SpurGear,
    face_width_m: float,
    poisson_ratio: float,
    half_angle_rad: float,
    roll_rad: FloatArray,
    other_roll_rad: FloatArray | None = None,
    apart: int = 0,
) -> FloatArray:
    """Return the axial deflection at one tooth per unit axial force on another, times E b (k,), dimensionless.

    Parameters
    ----------
    gear : SpurGear
        In its transverse section; a ring gear, held all round, does not bend.
    face_width_m, poisson_ratio : float
        [m], -.
    half_angle_rad : float
        Of the arc of a root, θ_f.
    roll_rad, other_roll_rad : (k,)
        Roll angles of the contacts on the two teeth; without the second one it is the same contact [rad].
    apart : int
        Pitches between the two teeth.

    Source: derived, see this module.
    """
    if isinstance(gear, RingGear):
        return np.zeros(np.shape(roll_rad))
    rim, bore = gear.root_radius_m, gear.held_radius_m / gear.root_radius_m
    between = 2.0 * pi * apart / gear.teeth
    answer = wave_sum(bore, face_width_m / rim, poisson_ratio, half_angle_rad, between)
    one = gear.radius_m(roll_rad) / rim - 1.0
    two = one if other_roll_rad is None else gear.radius_m(other_roll_rad) / rim - 1.0
    return np.asarray(answer[0, 0] + answer[0, 1] * (one + two) + answer[1, 1] * one * two)


@lru_cache(maxsize=64)
def wave_sum(
    bore: float, width: float, poisson_ratio: float, half_angle_rad: float, between_rad: float = 0.0
) -> FloatArray:
    """Return Σ_m q_m sinc²(m θ_f) P_m cos mΔ times b/R (2, 2): E b times deflection and slope by force and moment.

    Parameters
    ----------
    bore, width : float
        Bore radius and thickness over the radius of the rim.
    poisson_ratio, half_angle_rad : float
        -, θ_f [rad].
    between_rad : float
        Δ [rad].
    """
    waves = np.arange(WAVES + 1)
    spread = np.sinc(waves * half_angle_rad / pi) ** 2 * np.where(waves == 0, 0.5, 1.0) / pi
    each = np.stack([wave_answer(m, bore, width, poisson_ratio) for m in waves.tolist()])
    out = np.asarray(np.einsum("m,mij->ij", spread * np.cos(waves * between_rad), each) * width)
    out.setflags(write=False)
    return out


def wave_answer(m: int, bore: float, width: float, poisson_ratio: float) -> FloatArray:
    """Return P_m (2, 2): rim deflection and slope ∂w/∂r under an edge force and an edge moment of cos mθ each.

    Parameters
    ----------
    m : int
        Waves around the rim.
    bore, width : float
        Bore radius and thickness over the radius of the rim; E = 1.
    poisson_ratio : float

    Source: derived, see this module. The slope is that of the plate's normals, so that work is force times way.
    """
    inside, rim = (_solutions(m, at, bore, width, poisson_ratio) for at in (bore, 1.0))
    held, free = ([0, 1], [3, 4]) if m == 0 else ([0, 1, 2], [3, 4, 5])
    matrix = np.concatenate([inside[held], rim[free]])
    loads = np.zeros((len(matrix), 2))
    loads[len(held), 0], loads[len(held) + 1, 1] = 1.0, -1.0
    size = np.abs(matrix).max(axis=0)
    shares = np.linalg.solve(matrix / size, loads) / size[:, np.newaxis]
    return np.asarray(np.stack([rim[0], -rim[1]]) @ shares)


def _solutions(m: int, x: float, bore: float, width: float, poisson_ratio: float) -> FloatArray:
    """Return w, ψ_r, ψ_θ, Q, M_r and M_rθ (6, solutions) at the radius x of all solutions of m waves."""
    bending = width**3 / (12.0 * (1.0 - poisson_ratio**2))
    shearing = SHEAR_FACTOR * width / (2.0 * (1.0 + poisson_ratio))
    f0, f1, f2, laplacian, its_slope = _powers(m, x, bore)
    c0, c1, c2 = _bessel(m, x, bore, np.sqrt(12.0 * SHEAR_FACTOR) / width)
    radial, around = f1 + m * c0 / x, -m * f0 / x - c1
    radial_slope = f2 + m * (c1 - c0 / x) / x
    around_slope = -m * (f1 - f0 / x) / x - c2
    deflection = bending / shearing * laplacian - f0
    force = shearing * (radial - f1) + bending * its_slope
    moment = bending * (radial_slope + poisson_ratio * (radial + m * around) / x)
    twisting = 0.5 * bending * (1.0 - poisson_ratio) * (around_slope - (m * radial + around) / x)
    return np.stack([deflection, radial, around, force, moment, twisting])


def _powers(m: int, x: float, bore: float) -> FloatArray:
    """Return φ, φ', φ'', ∇²φ and its slope (5, solutions) of r^p (ln r)^q; 0 for the Bessel functions behind them."""
    power, logs = {0: ([0, 0, 2, 2], [0, 1, 0, 1]), 1: ([1, -1, 3, 1], [0, 0, 0, 1])}.get(
        m, ([m, -m, m + 2, 2 - m], [0, 0, 0, 0])
    )
    p, q = np.array(power, dtype=np.float64), np.array(logs, dtype=np.float64)
    # Negative powers count from the bore, where they are largest: none overflows.
    size, log, square = np.where(p < 0.0, x / bore, x) ** p, np.where(q > 0.0, np.log(x), 1.0), p * p - m * m
    laplacian = square * log + 2.0 * p * q
    found = [log, (p * log + q) / x, (p * (p - 1.0) * log + q * (2.0 * p - 1.0)) / x**2]
    found += [laplacian / x**2, ((p - 2.0) * laplacian + square * q) / x**3]
    return np.pad(size * np.stack(found), ((0, 0), (0, 2 if m else 0)))


def _bessel(m: int, x: float, bore: float, edge: float) -> FloatArray:
    """Return χ, χ' and χ'' (3, solutions) of I_m(λ r) and K_m(λ r), `edge` is λ; 0 for the powers before them."""
    if m == 0:
        return np.zeros((3, 4))
    z, m_square = edge * x, m * m
    size = np.exp([z - edge, edge * bore - z])  # over their largest, at rim and bore
    zeroth = size * [ive(m, z), kve(m, z)]
    first = 0.5 * edge * size * [ive(m - 1, z) + ive(m + 1, z), -kve(m - 1, z) - kve(m + 1, z)]
    found = np.stack([zeroth, first, (edge**2 + m_square / x**2) * zeroth - first / x])
    return np.pad(found, ((0, 0), (4, 0)))
