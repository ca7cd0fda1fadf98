r"""Compliance that a crack in the root adds to its tooth, by its depth, its angle and the place of the load.

Fitted to plane finite elements of our own (`python -m benchmarks.finite_elements fit_crack`). With the chord S of the
root at the height y_A (`root_chord`), a crack from the loaded end of it, its depth share η = q/S and its angle v to
the tooth's centre line, C = cos v, and a load of slant a whose line of action crosses the centre line at R_b/cos a:

    E L Δc = η² [e^α (l + D cos a - G sin a + N e^(-l/λ))² + e^β cos² a],    l = (R_b/cos a - y_A) cos a / S

The square is the opening of the crack by bending less compression (l the lever of the load about the chord), with
what a load close by adds; the rest is its sliding. α, D, G, N and β are linear in products of η and C; G also in the
slimness S/(2 y_A), which falls with the number of teeth. E L Δc is the same for every module, and in plane stress, in
which the calibrated tooth is too, for every Poisson's ratio.
"""

from __future__ import annotations

from math import cos, exp, radians

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.geometry.root_chord import root_chord
from siggen.gears.geometry.spur_gear import SpurGear

DEEPEST_SHARE = 0.45
"""Of the chord: the deepest of the fit; a little deeper, and a tooth breaks within few turns (Lewicki, memory)."""
ANGLE_RANGE_RAD = (radians(35.0), radians(70.0))
"""Of the fit, and of cracks that were seen in gears without thin rims (Lewicki, memory)."""
USUAL_SLIMNESS = 0.07
OPENING = (5.287, 0.917, -1.384, -5.66, 0.262, -0.615, 11.316, -6.716)
"""α over 1, C, C², η, ηC, ηC², η², η²C."""
BELOW = (0.194, 0.097, -0.476, 0.665)
"""D over 1, C, η, ηC."""
ASIDE = (0.251, -0.073, 0.028, 0.573)
"""G, as D."""
ASIDE_PER_SLIMNESS = 0.068
SLIDING = (-0.324, 2.363, 3.564, -5.17)
"""β, as D."""
CLOSE = (0.006, -0.047, 0.033, 0.0)
"""N, as D."""
CLOSE_LENGTH = 0.054
"""λ, in chords."""


def unit_compliance(gear: SpurGear, roll_rad: FloatArray, share: float, angle_rad: float) -> FloatArray:
    """Return E L Δc of a crack through the whole face, plane stress (k,), dimensionless.

    Parameters
    ----------
    gear : SpurGear
    roll_rad : (k,)
        Roll angles of the contact.
    share : float
        Depth along the crack over the chord of the root.
    angle_rad : float
        Between the crack and the tooth's centre line.
    """
    chord, slant, down = root_chord(gear), roll_rad - gear.base_half_angle_rad, cos(angle_rad)
    cross, along = np.cos(slant), np.sin(slant)
    lever = (gear.base_radius_m - chord.height_m * cross) / chord.length_m
    terms = np.array([1.0, down, share, share * down])
    more = np.array([1.0, down, down**2, share, share * down, share * down**2, share**2, share**2 * down])
    aside = float(terms @ ASIDE) + ASIDE_PER_SLIMNESS * (chord.length_m / (2.0 * chord.height_m) - USUAL_SLIMNESS)
    opening = lever + float(terms @ BELOW) * cross - aside * along
    opening = opening + float(terms @ CLOSE) * np.exp(-lever / CLOSE_LENGTH)
    bending, sliding = exp(float(more @ OPENING)), exp(float(terms @ SLIDING))
    return np.asarray(share**2 * (bending * opening**2 + sliding * cross**2))
