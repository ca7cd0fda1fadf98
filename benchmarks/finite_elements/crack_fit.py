"""Fit of the compliance that a crack adds (`siggen.gears.damage.crack_law`) to finite elements.

About a minute. Least squares of errors over what the crack adds and 0.4 % of the sound tooth, so that neither cracks
that add next to nothing nor deep ones decide; then once more with weights that grow with the errors left.
"""

from __future__ import annotations

from itertools import product
from math import radians
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from benchmarks.finite_elements.calibration import ToothShape
from benchmarks.finite_elements.cracked_tooth import crack_compliance
from siggen.gears.damage import crack_law
from siggen.gears.geometry.root_chord import root_chord

FIT_SIZE = 0.08
"""Edge length: 0.3 % from that of 0.03 (`crack_convergence`)."""
PLACES = np.array([0.045, 0.07, 0.11, 0.17, 0.26, 0.38, 0.52, 0.68, 0.84, 0.998])
"""On the flank, linear in the roll angle; contact begins at 0.04 to 0.13 of it, by the mating gear."""
TEETH, ANGLES_DEG = (18, 24, 35, 47, 80), (35, 45, 60, 70)
SHARES = (0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.45)
LEAST_OF_TOOTH, TYPICAL_ERROR = 0.004, 0.04
SIZES = {"OPENING": 9, "BELOW": 5, "ASIDE": 4, "ASIDE_PER_SLIMNESS": 1, "SLIDING": 5, "CLOSE": 3, "CLOSE_LENGTH": 1}
"""Coefficients by their names in the law."""
DEPTHS = 6
"""Nodes over the depth."""


class Case(NamedTuple):
    """One crack under one load: coordinates of the law, compliance of the sound tooth and what the crack adds."""

    down: np.ndarray
    share: np.ndarray
    lever: np.ndarray
    slant: np.ndarray
    slimness: np.ndarray
    sound: np.ndarray
    added: np.ndarray


def flank_rolls(shape: ToothShape) -> np.ndarray:
    """Return the roll angles (10,) of the loads [rad]."""
    gear = shape.gear()
    start = gear.involute_start_roll_rad
    return start + PLACES * (gear.tip_roll_rad - start)


def cases() -> Case:
    """Return all loads (n,) of all cracks of the fit."""
    found = []
    for teeth, angle_deg, share in product(TEETH, ANGLES_DEG, SHARES):
        shape = ToothShape(teeth, 2.5)
        gear, roll = shape.gear(), flank_rolls(shape)
        chord, slant = root_chord(gear), roll - gear.base_half_angle_rad
        lever = (gear.base_radius_m - chord.height_m * np.cos(slant)) / chord.length_m
        sound, added = crack_compliance(gear, roll, share, radians(angle_deg), size=FIT_SIZE)
        numbers = np.cos(radians(angle_deg)), share, chord.length_m / (2.0 * chord.height_m)
        down, depth, slimness = (np.full(roll.size, number) for number in numbers)
        found.append((down, depth, lever, slant, slimness, sound, added))
    return Case(*np.concatenate(found, axis=1))


def law(coefficients: np.ndarray, case: Case) -> np.ndarray:
    """Return the law (n,) written out, for coefficients in the order of `SIZES`."""
    parts = np.split(coefficients, np.cumsum(list(SIZES.values()))[:-1])
    nodes, weights = np.polynomial.legendre.leggauss(DEPTHS)
    shares = [0.5 * (1.0 + node) * case.share for node in nodes]
    return np.asarray(sum(w * e * case.share * released(parts, case, e) for w, e in zip(weights, shares, strict=True)))


def released(parts: list[np.ndarray], case: Case, e: np.ndarray) -> np.ndarray:
    """Return half of what growing at the depth share e (n,) releases, over e (n,)."""
    opening, below, aside, slimness, sliding, close, length = parts
    c, one = case.down, np.ones_like(e)
    first = np.stack([one, c, e, e * c, e * e])
    alpha = opening @ np.stack([one, c, c * c, e, e * c, e * c * c, e * e, e * e * c, e**3])
    side = aside @ first[:4] + slimness * (case.slimness - crack_law.USUAL_SLIMNESS)
    near = close @ first[:3] * np.exp(-case.lever / length)
    square = case.lever + below @ first * np.cos(case.slant) - side * np.sin(case.slant) + near
    return np.asarray(np.exp(alpha) * square**2 + np.exp(sliding @ first) * np.cos(case.slant) ** 2)


def present() -> np.ndarray:
    """Return the coefficients of the law as it is."""
    return np.concatenate([np.atleast_1d(getattr(crack_law, name)) for name in SIZES])


def fit_crack() -> dict[str, np.ndarray]:
    """Return the coefficients of a new fit by their names."""
    case = cases()
    scale = 1.0 / (case.added + LEAST_OF_TOOTH * case.sound)

    def errors(coefficients: np.ndarray) -> np.ndarray:
        return np.asarray((law(coefficients, case) - case.added) * scale)

    first = least_squares(errors, present()).x
    weight = 1.0 + np.abs(errors(first)) / TYPICAL_ERROR
    best = least_squares(lambda p: errors(p) * weight, first).x
    parts = np.split(best.round(3), np.cumsum(list(SIZES.values()))[:-1])
    return dict(zip(SIZES, parts, strict=True))
