"""What a sensor at rest sees of bodies whose coordinates turn with a carrier.

Derived: a body at (x, y) of a frame at the angle φ is at x cos φ - y sin φ, x sin φ + y cos φ in space. A ring that
moves as a whole passes a force at the angle β before the sensor on as 1 and cos β, sin β of it: the first terms of its
transfer as a Fourier series in the angle. No window: planets are heard from everywhere, as far as the ring moves.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.drivetrain import Body, Drivetrain


def in_space(
    drivetrain: Drivetrain, states: FloatArray, static_deflection: FloatArray, angle_rad: FloatArray
) -> FloatArray:
    """Return states (k, 2n) with the places of central bodies along fixed axes, static deflections included.

    Parameters
    ----------
    drivetrain : Drivetrain
    states : (k, 2n)
        About the static deflection.
    static_deflection : (n,)
    angle_rad : (k,)
        Of the frame's x axis against the fixed one.

    Rates are those in the frame along fixed axes, as supports feel them: accelerations are taken from places.
    """
    seen, n = states.copy(), static_deflection.size
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    for x, y in _places(drivetrain):
        along, across = states[:, x] + static_deflection[x], states[:, y] + static_deflection[y]
        seen[:, x] = cosine * along - sine * across
        seen[:, y] = sine * along + cosine * across
        along, across = states[:, n + x], states[:, n + y]
        seen[:, n + x] = cosine * along - sine * across
        seen[:, n + y] = sine * along + cosine * across
    return seen


def at_rest_beside(drivetrain: Drivetrain, static_deflection: FloatArray) -> FloatArray:
    """Return the static deflection (n,) without what `in_space` puts into states."""
    rest = static_deflection.copy()
    rest[[row for places in _places(drivetrain) for row in places]] = 0.0
    return rest


def _places(drivetrain: Drivetrain) -> list[tuple[int, int]]:
    """Return the numbers of x and y of the bodies on the common axis, whose axes are those of the frame."""
    bodies = [body for body in drivetrain.bodies if isinstance(body, Body) and body.goes_round and not body.on]
    index = drivetrain.index
    return [(index[f"x_{body.name}"], index[f"y_{body.name}"]) for body in bodies if "x" in body.moves]
