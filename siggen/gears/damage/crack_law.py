r"""Compliance that a crack in the root adds to its tooth, by its depth, its angle and the place of the load.

Fitted to plane finite elements of our own (`python -m benchmarks.finite_elements fit_crack`). With the chord S of the
root at the height y_A (`root_chord`), a crack from the loaded end of it, its depth share η = q/S and its angle v to
the tooth's centre line, C = cos v, and a load of slant a whose line of action crosses the centre line at R_b/cos a:

    E L Δc = ∫ 2 s [e^α (l + D cos a - G sin a + N e^(-l/λ))² + e^β cos² a] ds,  s from 0 to η
    l = (R_b/cos a - y_A) cos a / S

The integral is what growing by ds releases (Irwin), so that a deeper crack always adds more. The square is the opening
by bending less compression (l the lever of the load about the chord), with what a load close by adds; the rest is its
sliding. α, D, G, N and β are linear in products of s and C; G also in the slimness S/(2 y_A), which falls with the
number of teeth. E L Δc is the same for every module, and in plane stress, in which the calibrated tooth is too, for
every Poisson's ratio.
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
OPENING = (5.095, 1.36, -1.555, -7.9, -4.304, -0.167, 38.346, -7.006, -43.078)
"""α over 1, C, C², s, sC, sC², s², s²C, s³."""
BELOW = (0.252, 0.054, -1.734, 1.518, 2.252)
"""D over 1, C, s, sC, s²."""
ASIDE = (0.233, -0.042, 0.101, 0.856)
"""G over 1, C, s, sC."""
ASIDE_PER_SLIMNESS = 0.085
SLIDING = (-0.826, 2.804, 11.732, -11.183, -13.513)
"""β, as D."""
CLOSE = (-0.005, -0.034, 0.096)
"""N over 1, C, s."""
CLOSE_LENGTH = 0.055
"""λ, in chords."""
RULE = np.polynomial.legendre.leggauss(6)
"""Over the depth: exact to 1e-4 (tested against 40 nodes)."""


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
    chord, slant, c = root_chord(gear), roll_rad - gear.base_half_angle_rad, cos(angle_rad)
    cross, along = np.cos(slant), np.sin(slant)
    lever = (gear.base_radius_m - chord.height_m * cross) / chord.length_m
    close = np.exp(-lever / CLOSE_LENGTH)
    slimness = ASIDE_PER_SLIMNESS * (chord.length_m / (2.0 * chord.height_m) - USUAL_SLIMNESS)
    total = np.zeros(roll_rad.shape)
    for node, weight in zip(0.5 + 0.5 * RULE[0], RULE[1], strict=True):
        s = share * float(node)
        terms = np.array([1.0, c, s, s * c, s**2])
        more = np.array([1.0, c, c**2, s, s * c, s * c**2, s**2, s**2 * c, s**3])
        aside = float(terms[:4] @ ASIDE) + slimness
        opening = lever + float(terms @ BELOW) * cross - aside * along + float(terms[:3] @ CLOSE) * close
        released = exp(float(more @ OPENING)) * opening**2 + exp(float(terms @ SLIDING)) * cross**2
        total += float(weight * node) * released
    return np.asarray(share**2 * total)
