r"""Compliance that a crack in the root adds to its tooth, by its depth, its angle and the place of the load.

Fitted to plane finite elements of our own (`-m tests.reference.finite_elements fit_crack`). With the chord S of the
root at the height y_A (`root_chord`), a crack from the loaded end of it, its depth share η = q/S and its angle v to
the tooth's centre line, C = cos v, and a load of slant a whose line of action crosses the centre line at R_b/cos a:

    E L Δc = ∫ 2 s [e^α (l + D cos a - G sin a + N n)² + e^β (cos a - H sin a + M n)²] ds,  s from 0 to η
    l = (R_b/cos a - y_A) cos a / S,  n = e^(-d/λ)

The integral is what growing by ds releases (Irwin), so that a deeper crack always adds more. The first square is the
opening by bending less compression (l the lever of the load about the chord), the second the sliding; n is what a load
close by adds, at the distance d chords from the crack's mouth. α, D, G, N, β, H and M are linear in products of s and
C. α, D and G also know the root's shape: its slimness S/(2 y_A) and the rack's tip round over S, by which pressure
angles and numbers of teeth differ. E L Δc is the same for every module, and in plane stress, in which the calibrated
tooth is too, for every Poisson's ratio.
"""

from __future__ import annotations

from math import cos, exp, radians

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.spur_gear import SpurGear, root_chord

DEEPEST_SHARE = 0.45
"""Of the chord: the deepest of the fit; a little deeper, and a tooth breaks within few turns (Lewicki, memory)."""
ANGLE_RANGE_RAD = (radians(35.0), radians(70.0))
"""Of the fit, and of cracks that were seen in gears without thin rims (Lewicki, memory)."""
USUAL_SLIMNESS, USUAL_ROUND = 0.07, 0.19
OPENING = (4.978, 1.726, -1.814, -7.912, -6.539, 1.129, 42.0, -4.981, -51.665)
"""α over 1, C, C², s, sC, sC², s², s²C, s³."""
BELOW = (0.285, -0.021, -1.908, 1.77, 2.59)
"""D over 1, C, s, sC, s²."""
ASIDE = (0.253, -0.218, -0.058, 1.367)
"""G over 1, C, s, sC."""
ASIDE_PER_SLIMNESS = 0.252
SLIDING = (-0.36, 3.302, 9.789, -12.781, -15.367)
"""β, as D."""
CLOSE = (-0.257, 0.011, 1.314)
"""N over 1, C, s."""
CLOSE_LENGTH = 0.062
"""λ, in chords."""
OPENING_PER_ROOT, BELOW_PER_ROOT = (0.351, -1.025), (0.057, -0.348)
"""Of α and D: by slimness, by round."""
ASIDE_PER_ROUND = -0.949
SLIDING_ASIDE = (1.387, 0.026, -5.076)
"""H over 1, C, s."""
SLIDING_CLOSE = (0.883, -1.228, -0.923)
"""M, as H."""
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
    close = np.exp(-mouth_distance(gear, roll_rad) / CLOSE_LENGTH)
    root = root_shape(gear)
    wider, lower = float(root @ OPENING_PER_ROOT), float(root @ BELOW_PER_ROOT)
    sideways = float(root @ (ASIDE_PER_SLIMNESS, ASIDE_PER_ROUND))
    total = np.zeros(roll_rad.shape)
    for node, weight in zip(0.5 + 0.5 * RULE[0], RULE[1], strict=True):
        s = share * float(node)
        terms = np.array([1.0, c, s, s * c, s**2])
        more, first = np.array([1.0, c, c**2, s, s * c, s * c**2, s**2, s**2 * c, s**3]), terms[:3]
        aside = float(terms[:4] @ ASIDE) + sideways
        opening = lever + (float(terms @ BELOW) + lower) * cross - aside * along + float(first @ CLOSE) * close
        sliding = cross - float(first @ SLIDING_ASIDE) * along + float(first @ SLIDING_CLOSE) * close
        released = exp(float(more @ OPENING) + wider) * opening**2 + exp(float(terms @ SLIDING)) * sliding**2
        total += float(weight * node) * released
    return np.asarray(share**2 * total)


def mouth_distance(gear: SpurGear, roll_rad: FloatArray) -> FloatArray:
    """Return the distance of the contact from the crack's mouth (k,), in chords."""
    chord = root_chord(gear)
    above = gear.base_height_m + gear.height_m(roll_rad) - chord.height_m
    return np.asarray(np.hypot(above, gear.half_thickness_m(roll_rad) - 0.5 * chord.length_m) / chord.length_m)


def root_shape(gear: SpurGear) -> FloatArray:
    """Return slimness and round of the root (2,), less the usual ones, dimensionless."""
    chord = root_chord(gear)
    slimness, rounded = chord.length_m / (2.0 * chord.height_m), gear.rack_round_m / chord.length_m
    return np.array([slimness - USUAL_SLIMNESS, rounded - USUAL_ROUND])
