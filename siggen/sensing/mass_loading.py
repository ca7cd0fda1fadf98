"""mass_loading: how a mass that a place carries changes the motion of that place.

The mass m presses back with -m a where the place moves by a: a = a_0 - A m a with the accelerance A of the place
(reference: standard literature, mass loading). Along one direction a = a_0/(1 + m A). A mass has inertia along every
direction and a place may give way across a force, so all directions count together: a = (I + m A)^-1 a_0.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import ComplexArray


def mass_loading(accelerance: ComplexArray, mass_kg: float) -> ComplexArray:
    """Return (I + m A)^-1 (d, d, k): motions of a place with the mass on it over those without.

    One direction after another takes the mass along: each time a = a_0/(1 + m A) along it. No division is by 0, since
    what is shaken takes power from the shaker.

    Parameters
    ----------
    accelerance : (d, d, k) of the place, from forces to motions along its d directions [m/s² per N]
    mass_kg : mass
    """
    left = np.array(accelerance)
    result = np.zeros_like(left)
    for direction in range(len(left)):
        result[direction, direction] = 1.0
    for direction in range(len(left)):
        pressed = left[:, direction] * (mass_kg / (1.0 + mass_kg * left[direction, direction]))
        result -= pressed[:, None] * result[direction]
        left -= pressed[:, None] * left[direction]
    return result
