"""What a sensor at rest sees of bodies whose coordinates turn with a carrier.

Derived: a body at (x, y) of a frame at the angle φ is at x cos φ - y sin φ, x sin φ + y cos φ in space. A ring that
moves as a whole passes a force at the angle β before the sensor on as 1 and cos β, sin β of it: the first terms of its
transfer as a Fourier series in the angle. No window: planets are heard from everywhere, as far as the ring moves.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from siggen.arrays import FloatArray

CENTRAL = ("s", "c", "r")
"""Bodies on the common axis, whose axes are those of the frame."""


def in_space(
    coordinates: Sequence[str], states: FloatArray, static_deflection: FloatArray, angle_rad: FloatArray
) -> FloatArray:
    """Return states (k, 2n) with the places of central bodies along fixed axes, static deflections included.

    Parameters
    ----------
    coordinates : names of the n coordinates
    states : (k, 2n)
        About the static deflection.
    static_deflection : (n,)
    angle_rad : (k,)
        Of the frame's x axis against the fixed one.

    Rates stay those of the frame: accelerations are taken from places.
    """
    seen, names = states.copy(), list(coordinates)
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    for body in CENTRAL:
        x, y = names.index(f"x_{body}"), names.index(f"y_{body}")
        along, across = states[:, x] + static_deflection[x], states[:, y] + static_deflection[y]
        seen[:, x] = cosine * along - sine * across
        seen[:, y] = sine * along + cosine * across
    return seen
