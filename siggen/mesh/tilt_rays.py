r"""Rays over approach and tilt, along which the table of the contact holds the stored energy.

Derived. d is the approach beyond first touch of the untilted face, h half the face width, τ = θ h the lift of its ends.
Nothing touches where d < -|τ|. So the energy is asked for in polar coordinates about first touch,

    r = √(d² + τ²),   p = tan(φ/2) = τ/(r + d),   from p = -(1 + √2) to 1 + √2,

in which a face that rests on one end, or touches as a whole, is the same function at every load but for logarithms: a
few rays do. Along a ray W_r and W_p are monotone cubics between nodes and W is the integral of W_r; between rays W is
the cubic of Hermite of W and W_p. Force and moment are derivatives of that one function: no closed loop does work.

Shafts lift the ends of a face by little: below 1 um in `quickstart`, where the approach goes to 47 um. So up to
`NEAR` the energy follows from the face without tilt alone, to the second order in p,

    W(r, p) = W + p W_p + ½ p² W_pp,   W_p = 2 r M/h,   W_pp = 4 r (r T - F)  at p = 0,   T = dM/dθ / h²,

and the ray at `NEAR` is the first behind it. Rays are solved as far as such lifts reach.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray

HALF_RAYS = (0.0, 0.3, 0.8, 1.5, 1.0 + 2.0**0.5)
"""p of the rays to one side; the last one is that on which a rigid corner comes to touch."""
NEAR = 0.04
"""p up to which a face counts as one without tilt, to the second order."""
RAYS = np.array([-p for p in HALF_RAYS[:0:-1]] + list(HALF_RAYS))
UPRIGHT = len(HALF_RAYS) - 1
"""Number of the ray without tilt."""
FORCE, MOMENT, STIFFNESS, CROSS, TURNING, CARRYING, ON_ROUGH = range(7)
"""Where answers of the solver stand in a `ForceCurve`."""


class RayWay(NamedTuple):
    """Approaches beyond first touch [m] and tilts [rad] of the nodes of rays (rays, nodes)."""

    approach_m: FloatArray
    tilt_rad: FloatArray


def ray_way(rays: FloatArray, node_m: FloatArray, half_face_m: float) -> RayWay:
    """Return the way along rays (rays,) of p through the nodes (nodes,), r [m]."""
    cosine, sine = _direction(rays)
    return RayWay(cosine * node_m, sine * node_m / half_face_m)


def along_rays(rays: FloatArray, node_m: FloatArray, half_face_m: float, found: FloatArray) -> FloatArray:
    """Return W_r, W_rr, W_p and W_pr (4, ..., rays, nodes).

    `found` (7, ..., rays, nodes): the solver's answers at the nodes in the order of `ForceCurve`.
    """
    cosine, sine = _direction(rays)
    force, stiffness = found[FORCE], found[STIFFNESS]
    moment, cross = found[MOMENT] / half_face_m, found[CROSS] / half_face_m
    turning = found[TURNING] / half_face_m**2
    per_angle = -sine * force + cosine * moment
    bend = cosine * (cosine * cross - sine * stiffness) + sine * (cosine * turning - sine * cross)
    radial = cosine**2 * stiffness + 2.0 * cosine * sine * cross + sine**2 * turning
    angle = 2.0 / (1.0 + rays[:, np.newaxis] ** 2)  # dφ/dp
    pushed = cosine * force + sine * moment
    return np.stack([pushed, radial, angle * node_m * per_angle, angle * (per_angle + node_m * bend)])


def energy_j(node_m: FloatArray, pushed: FloatArray, slope: FloatArray) -> FloatArray:
    """Return W (..., nodes) [J]: the integral of the cubics through values and slopes of W_r (..., nodes)."""
    span = np.diff(node_m)
    parts = span * (0.5 * (pushed[..., 1:] + pushed[..., :-1]) + span * (slope[..., :-1] - slope[..., 1:]) / 12.0)
    return np.concatenate([np.zeros_like(pushed[..., :1]), np.cumsum(parts, axis=-1)], axis=-1)


def _direction(rays: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return cos φ and sin φ (rays, 1)."""
    p = rays[:, np.newaxis]
    return (1.0 - p**2) / (1.0 + p**2), 2.0 * p / (1.0 + p**2)
