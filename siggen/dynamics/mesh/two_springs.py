"""Springs of two pairs on one gear body, compiled.

Derived: each pair deflects the other's body, p_i = d_i - c f_j(p_j) and back. f is monotone, so Newton's method ends
after a few steps with the solution; it exists and is unique while the coupling c stays below a pair's own compliance,
since then the energy is strictly convex. It starts from the forces and tangents of a state near by; the tangent of ΣN
to the approach of all follows from the same system: (I + diag(k) c) y = k.
"""

from __future__ import annotations

from typing import NamedTuple

from siggen.compiled import njit
from siggen.dynamics.mesh.contact_spring import PairPlace, Spring, pair_spring
from siggen.dynamics.mesh.pair_law import PairLaw

SMOOTH_CHANGE = 0.02
"""Of each force: Newton's error is the curvature times the square of this over ten, below 1e-4 of that force.

A share of the larger one would let a pair that hardly touches be wrong by all of its force, however short the step:
1.3e-3 of the accelerations at 0.9 Hz.
"""
EXACT_CHANGE = 1e-5
"""Of the larger force, what is settled in any case; where forces stand for themselves less than 1e-9 is left."""
MOST_STEPS = 8


class Before(NamedTuple):
    """Force and stiffness of a pair in a state near by, and how far its depth by itself changed since."""

    force: float
    stiffness: float
    change: float


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def alone_spring(law: PairLaw, pair: PairPlace, tilt: float) -> Spring:
    """Return the spring of a pair at its own depth."""
    return _pushed(pair_spring(law, pair, tilt, pair.depth))


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def two_springs(
    law: PairLaw, coupling: float, tilt: float, settled: float, pair_i: PairPlace, pair_j: PairPlace,
    before: tuple[Before, Before],
) -> tuple[Spring, Spring, bool]:  # fmt: skip
    """Return the springs of two drive flanks, and whether they settled to a share of their force, or near enough.

    Parameters
    ----------
    law : PairLaw
    coupling : float
        Deflection at one pair per unit force at the other [m/N].
    tilt : float
        [rad]
    settled : float
        SMOOTH_CHANGE or EXACT_CHANGE.
    pair_i, pair_j : PairPlace
    before : (Before, Before)
        Zeros where another pair was there.
    """
    c, (f_i, k_i, d_i), (f_j, k_j, d_j) = coupling, before[0], before[1]
    inverse = 1.0 / (1.0 - k_i * k_j * c * c)
    f_i, f_j = f_i + k_i * (d_i - c * k_j * d_j) * inverse, f_j + k_j * (d_j - c * k_i * d_i) * inverse
    near = settled >= SMOOTH_CHANGE
    at_i, at_j = NO_SPRING, NO_SPRING
    for _ in range(MOST_STEPS):
        at_i = pair_spring(law, pair_i, tilt, pair_i.depth - c * f_j)
        at_j = pair_spring(law, pair_j, tilt, pair_j.depth - c * f_i)
        k_i, k_j = at_i.stiffness, at_j.stiffness
        inverse = 1.0 / (1.0 - k_i * k_j * c * c)
        d_i = (at_i.force - f_i - k_i * c * (at_j.force - f_j)) * inverse
        d_j = (at_j.force - f_j - k_j * c * (at_i.force - f_i)) * inverse
        f_i, f_j = f_i + d_i, f_j + d_j
        least = EXACT_CHANGE * max(abs(f_i), abs(f_j))
        if abs(d_i) <= max(settled * abs(f_i), least) and abs(d_j) <= max(settled * abs(f_j), least):
            near = True
            break
    sprung_i = _settled(at_i, f_i, pair_i.depth - c * f_j, k_i * (1.0 - c * k_j) * inverse)
    return sprung_i, _settled(at_j, f_j, pair_j.depth - c * f_i, k_j * (1.0 - c * k_i) * inverse), near


NO_SPRING = Spring(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _pushed(spring: Spring) -> Spring:
    """Return a spring without stiffness where it has no force."""
    stiffness = spring.stiffness if spring.force != 0.0 else 0.0
    return Spring(
        spring.force, stiffness, stiffness, spring.penetration, spring.moment, spring.cross, spring.turning,
        spring.carrying, spring.rough,
    )  # fmt: skip


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _settled(last: Spring, force: float, penetration_m: float, yielding: float) -> Spring:
    """Return the spring at the solution, of the last one that was asked for."""
    force = max(force, 0.0)
    moment = last.moment + last.cross * (penetration_m - last.penetration)
    stiffness = last.stiffness if force != 0.0 else 0.0
    return Spring(
        force, stiffness, yielding, penetration_m, moment, last.cross, last.turning, last.carrying, last.rough
    )
