"""Fit of the compliance that a crack adds (`siggen.damage.crack_law`) to finite elements.

About five minutes. Least squares of errors over what the crack adds and 0.4 % of the sound tooth, so that neither
cracks that add next to nothing nor deep ones decide; then twice more with weights that grow with the errors left.
"""

from __future__ import annotations

from itertools import product
from math import radians
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from siggen.damage import crack_law
from siggen.damage.crack_law import mouth_distance, root_shape
from siggen.gears.spur_gear import SpurGear, root_chord
from tests.reference.finite_elements.calibration import ToothShape
from tests.reference.finite_elements.cracked_tooth import crack_compliance

FIT_SIZE, COARSE_SIZE = 0.08, 0.12
"""Edge lengths: 0.3 % from that of 0.03 (`crack_convergence`), and 0.2 % from the former."""
PLACES = np.array([0.045, 0.07, 0.11, 0.17, 0.26, 0.38, 0.52, 0.68, 0.84, 0.998])
"""On the flank, linear in the roll angle; contact begins at 0.04 to 0.13 of it, by the mating gear."""


class Plan(NamedTuple):
    """All cracks of some teeth: depth shares and angles [deg], by meshes of one edge length."""

    shapes: tuple[ToothShape, ...]
    shares: tuple[float, ...]
    angles_deg: tuple[float, ...]
    size: float


USUAL = tuple(ToothShape(z, 2.5) for z in (18, 24, 35, 47, 80))
_RACKS = ((14.5, (20, 36, 70)), (17.5, (18, 28, 50)), (22.5, (18, 30, 55)), (25.0, (18, 26, 45, 90)))
_SHIFTED = ((22, 0.4, 20.0), (45, -0.3, 20.0), (26, 0.3, 25.0), (50, -0.3, 25.0), (50, 0.4, 14.5))
OTHER_RACKS = (
    *(ToothShape(z, 2.5, pressure_angle_deg=angle) for angle, teeth in _RACKS for z in teeth),
    *(ToothShape(z, 2.5, shift, angle) for z, shift, angle in _SHIFTED),
    ToothShape(70, 2.5, pressure_angle_deg=25.0, clearance=0.2),
)
TEETH = (
    Plan(USUAL, (0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.45), (35, 45, 60, 70), FIT_SIZE),
    Plan(OTHER_RACKS, (0.03, 0.1, 0.2, 0.32, 0.45), (35, 50, 70), COARSE_SIZE),
)
"""What is fitted; `crack_comparison` compares with these and with others."""
LEAST_OF_TOOTH, TYPICAL_ERROR = 0.004, 0.04
SIZES = {
    "OPENING": 9, "BELOW": 5, "ASIDE": 4, "ASIDE_PER_SLIMNESS": 1, "SLIDING": 5, "CLOSE": 3, "CLOSE_LENGTH": 1,
    "OPENING_PER_ROOT": 2, "BELOW_PER_ROOT": 2, "ASIDE_PER_ROUND": 1, "SLIDING_ASIDE": 3, "SLIDING_CLOSE": 3,
}  # fmt: skip
"""Coefficients by their names in the law."""
DEPTHS = 6
"""Nodes over the depth."""


class Case(NamedTuple):
    """One crack under one load: coordinates of the law, compliance of the sound tooth and what the crack adds."""

    down: np.ndarray
    share: np.ndarray
    lever: np.ndarray
    slant: np.ndarray
    distance: np.ndarray
    slimness: np.ndarray
    rounded: np.ndarray
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
    for plan in TEETH:
        for shape, share, angle_deg in product(plan.shapes, plan.shares, plan.angles_deg):
            gear, roll = shape.gear(), flank_rolls(shape)
            results = crack_compliance(gear, roll, share, radians(angle_deg), size=plan.size)
            found.append((*coordinates(gear, roll, share, radians(angle_deg)), *results))
    return Case(*np.concatenate(found, axis=1))


def coordinates(gear: SpurGear, roll: np.ndarray, share: float, angle_rad: float) -> tuple[np.ndarray, ...]:
    """Return the coordinates (k,) of `Case`, without compliances."""
    chord, slant = root_chord(gear), roll - gear.base_half_angle_rad
    lever = (gear.base_radius_m - chord.height_m * np.cos(slant)) / chord.length_m
    down, depth, slim, rounded = (np.full(roll.size, n) for n in (np.cos(angle_rad), share, *root_shape(gear)))
    return down, depth, lever, slant, mouth_distance(gear, roll), slim, rounded


def law(coefficients: np.ndarray, case: Case) -> np.ndarray:
    """Return the law (n,) written out, for coefficients in the order of `SIZES`."""
    parts = np.split(coefficients, np.cumsum(list(SIZES.values()))[:-1])
    nodes, weights = np.polynomial.legendre.leggauss(DEPTHS)
    shares = [0.5 * (1.0 + node) * case.share for node in nodes]
    return np.asarray(sum(w * e * case.share * released(parts, case, e) for w, e in zip(weights, shares, strict=True)))


def released(parts: list[np.ndarray], case: Case, e: np.ndarray) -> np.ndarray:
    """Return half of what growing at the depth share e (n,) releases, over e (n,)."""
    opening, below, aside, slimness, sliding, close, _, wider, lower, rounded, shear, near = parts
    c, one, n = case.down, np.ones_like(e), np.exp(-case.distance / parts[6])
    first, root = np.stack([one, c, e, e * c, e * e]), np.stack([case.slimness, case.rounded])
    alpha = opening @ np.stack([one, c, c * c, e, e * c, e * c * c, e * e, e * e * c, e**3]) + wider @ root
    side = aside @ first[:4] + slimness * case.slimness + rounded * case.rounded
    lift = (below @ first + lower @ root) * np.cos(case.slant)
    square = case.lever + lift - side * np.sin(case.slant) + close @ first[:3] * n
    slide = np.cos(case.slant) - shear @ first[:3] * np.sin(case.slant) + near @ first[:3] * n
    return np.asarray(np.exp(alpha) * square**2 + np.exp(sliding @ first) * slide**2)


def present() -> np.ndarray:
    """Return the coefficients of the law as it is."""
    return np.concatenate([np.atleast_1d(getattr(crack_law, name)) for name in SIZES])


def fit_crack() -> dict[str, np.ndarray]:
    """Return the coefficients of a new fit by their names."""
    case = cases()
    scale = 1.0 / (case.added + LEAST_OF_TOOTH * case.sound)

    def errors(coefficients: np.ndarray) -> np.ndarray:
        return np.asarray((law(coefficients, case) - case.added) * scale)

    best = least_squares(errors, present()).x
    for _ in range(2):
        weight = 1.0 + np.abs(errors(best)) / TYPICAL_ERROR
        best = least_squares(lambda p, w=weight: errors(p) * w, best).x
    parts = np.split(best.round(3), np.cumsum(list(SIZES.values()))[:-1])
    return dict(zip(SIZES, parts, strict=True))
