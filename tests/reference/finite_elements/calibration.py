"""Calibration of the rack-trochoid tooth compliance by finite elements: sampling plan, fit, held-out gears, table file.

Two steps: the main table fits the ratio on a Chebyshev grid of standard gears; the corrections for profile shift
and pressure angle are a linear least-squares fit to the relative rest on shifted and slanted gears.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from math import exp, log, radians, sin

import numpy as np
from numpy.polynomial import chebyshev

from siggen.gears.gear_pair import SpurGear
from siggen.mesh.calibration import RADIUS_RATIO_RANGE, TEETH_RANGE, angle_step, unit_coordinates
from tests.reference.finite_elements.model_compliance import CALIBRATED_MODEL, MODELS, model_compliance
from tests.reference.finite_elements.tooth_compliance_fem import PlaneElasticity, tooth_compliance

MAIN_DEGREES = (4, 4, 4)
CORRECTION_DEGREES = (3, 2, 2)
MAIN_NODES = (7, 7, 9)
CORRECTION_NODES = (5, 4, 7)
SHIFTS = (-0.5, -0.25, 0.25, 0.5)
ANGLES_DEG = (17.5, 22.3, 25.0)
CALIBRATION_SIZE = 0.03
THINNEST_TIP = 0.05
"""Half tip thickness in modules below which a tooth counts as pointed and is left out."""


@dataclass(frozen=True, slots=True)
class ToothShape:
    """What the dimensionless compliance of a tooth depends on; the module is 1."""

    teeth: float
    radius_ratio: float
    profile_shift: float = 0.0
    pressure_angle_deg: float = 20.0
    clearance: float = 0.25

    def gear(self) -> SpurGear:
        """Return the gear; `teeth` may be a fraction, since one tooth stands on the ring."""
        root = self.teeth / 2 - 1 - self.clearance + self.profile_shift
        return SpurGear(
            teeth=self.teeth,  # type: ignore[arg-type]
            module_m=1.0,
            pressure_angle_rad=radians(self.pressure_angle_deg),
            profile_shift=self.profile_shift,
            addendum_coefficient=1.0,
            clearance_coefficient=self.clearance,
            bore_radius_m=root / self.radius_ratio,
            body_ratio=1.0,
        )

    def usable(self) -> bool:
        """Whether the tooth is neither undercut nor pointed."""
        gear = self.gear()
        return not gear.undercut and gear.tip_half_thickness_m > THINNEST_TIP


def compliance_ratio(shape: ToothShape, place: np.ndarray, size: float = CALIBRATION_SIZE) -> np.ndarray:
    """Finite elements / rack trochoid + rack foundation, plane stress.

    Parameters
    ----------
    shape : ToothShape
        The tooth.
    place : (k,) array
        0 at the start of the involute, 1 at the tip, linear in the roll angle.
    size : float
        Edge length on the tooth in modules.

    Returns
    -------
    (k,) array
    """
    gear = shape.gear()
    start, tip = gear.involute_start_roll_rad, gear.tip_roll_rad
    roll = start + place * (tip - start)
    return tooth_compliance(gear, roll, PlaneElasticity(), size) / model_compliance(
        gear, roll, MODELS[CALIBRATED_MODEL]
    )


def chebyshev_nodes(low: float, high: float, count: int) -> np.ndarray:
    """Zeros of the Chebyshev polynomial of degree `count`, ascending, scaled to low .. high."""
    unit = -np.cos(np.pi * (np.arange(count) + 0.5) / count)
    return low + (high - low) * (unit + 1) / 2


def _grid(nodes: tuple[int, int, int]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    teeth = 1 / chebyshev_nodes(1 / TEETH_RANGE[1], 1 / TEETH_RANGE[0], nodes[0])
    ratio = np.exp(chebyshev_nodes(log(RADIUS_RATIO_RANGE[0]), log(RADIUS_RATIO_RANGE[1]), nodes[1]))
    return teeth, ratio, chebyshev_nodes(0.0, 1.0, nodes[2])


def _design(teeth: float, ratio: float, place: np.ndarray, degrees: tuple[int, int, int]) -> np.ndarray:
    """Tensor Chebyshev basis at the places of one tooth, (k, terms)."""
    axes = [
        chebyshev.chebvander(np.atleast_1d(x), d)
        for x, d in zip(unit_coordinates(teeth, ratio, place), degrees, strict=True)
    ]
    return np.einsum("a,b,kc->kabc", axes[0][0], axes[1][0], axes[2]).reshape(len(place), -1)


def _fit(design: np.ndarray, values: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    return np.linalg.lstsq(design, values, rcond=None)[0].reshape(shape)


def fit_main(size: float = CALIBRATION_SIZE) -> np.ndarray:
    """Coefficients of the standard rack's factor over 1/z, ln(h_f) and place; shape MAIN_DEGREES + 1."""
    teeth, ratio, place = _grid(MAIN_NODES)
    pairs = list(product(teeth, ratio))
    values = [compliance_ratio(ToothShape(z, h), place, size) for z, h in pairs]
    design = np.vstack([_design(z, h, place, MAIN_DEGREES) for z, h in pairs])
    return _fit(design, np.concatenate(values), tuple(d + 1 for d in MAIN_DEGREES))


def least_shift(teeth: float, pressure_angle_deg: float) -> float:
    """Profile shift below which the rack undercuts the tooth (ha = 1)."""
    return 1 - teeth / 2 * sin(radians(pressure_angle_deg)) ** 2


def _corrected_shapes(teeth: np.ndarray, ratio: np.ndarray) -> Iterator[ToothShape]:
    for z, h in product(teeth, ratio):
        # An undercut corner of the range is replaced by the limit of undercut.
        shifts = sorted({max(x, least_shift(z, 20.0) + 1e-6) for x in SHIFTS})
        yield from (ToothShape(z, h, x) for x in shifts)
        for angle in ANGLES_DEG:
            # The rack's tip round fits between the flanks only up to c = 0.203 at 25 deg.
            yield ToothShape(z, h, max(0.0, least_shift(z, angle) + 1e-6), angle, 0.2 if angle > 22.4 else 0.25)


def fit_corrections(main: np.ndarray, size: float = CALIBRATION_SIZE) -> np.ndarray:
    """Coefficients of X, X^2 and the pressure angle; shape (3, *CORRECTION_DEGREES + 1).

    Parameters
    ----------
    main : array
        Result of `fit_main`.
    size : float
        Edge length on the tooth in modules.
    """
    teeth, ratio, place = _grid(CORRECTION_NODES)
    rows, rests = [], []
    for shape in filter(ToothShape.usable, _corrected_shapes(teeth, ratio)):
        standard = _design(shape.teeth, shape.radius_ratio, place, MAIN_DEGREES) @ main.ravel()
        basis = _design(shape.teeth, shape.radius_ratio, place, CORRECTION_DEGREES)
        x, a = shape.profile_shift, angle_step(radians(shape.pressure_angle_deg))
        rows.append(np.hstack([x * basis, x**2 * basis, a * basis]))
        rests.append(compliance_ratio(shape, place, size) / standard - 1)
    return _fit(np.vstack(rows), np.concatenate(rests), (3, *(d + 1 for d in CORRECTION_DEGREES)))


def held_out_shapes(count: int) -> list[ToothShape]:
    """Return standard gears with whole teeth between the calibration's nodes, the same ones every time."""
    steps = np.modf(np.arange(1, count + 1)[:, None] * [0.7548776662466927, 0.5698402909980532])[0]
    teeth = 1 / (1 / TEETH_RANGE[1] + steps[:, 0] * (1 / TEETH_RANGE[0] - 1 / TEETH_RANGE[1]))
    low, high = map(log, RADIUS_RATIO_RANGE)
    return [ToothShape(float(round(z)), exp(low + s * (high - low))) for z, s in zip(teeth, steps[:, 1], strict=True)]


def evaluate(main: np.ndarray, corrections: np.ndarray, shape: ToothShape, place: np.ndarray) -> np.ndarray:
    """Factor of freshly fitted coefficients at the places of one tooth (k,)."""
    standard = _design(shape.teeth, shape.radius_ratio, place, MAIN_DEGREES) @ main.ravel()
    basis = _design(shape.teeth, shape.radius_ratio, place, CORRECTION_DEGREES)
    x, a = shape.profile_shift, angle_step(radians(shape.pressure_angle_deg))
    first, second, angle = (basis @ c.ravel() for c in corrections)
    return standard * (1 + x * first + x**2 * second + a * angle)


def largest_error(shape: ToothShape, factor: np.ndarray, place: np.ndarray, size: float) -> float:
    """Largest relative deviation of factor x model from finite elements over the places of one tooth."""
    return float(np.abs(factor / compliance_ratio(shape, place, size) - 1).max())
