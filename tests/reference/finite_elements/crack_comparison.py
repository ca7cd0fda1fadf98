"""Tables of the law of cracks against finite elements: gears and angles that were fitted and that were not."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import product
from math import radians

import numpy as np

from siggen.gears.damage.crack_law import unit_compliance
from tests.reference.finite_elements.calibration import ToothShape
from tests.reference.finite_elements.crack_fit import FIT_SIZE, TEETH, flank_rolls
from tests.reference.finite_elements.cracked_tooth import crack_compliance
from tests.reference.finite_elements.tooth_compliance_fem import PlaneElasticity

SHARES = (0.05, 0.1, 0.25, 0.4)
FITTED = tuple(pair for plan in TEETH for pair in product(plan.shapes, plan.angles_deg))
GEARS_LEFT_OUT = tuple(product((ToothShape(z, 2.5) for z in (21, 28, 60, 65)), (40, 50, 65)))
GEARS_UNSEEN = tuple(product((ToothShape(z, 2.5) for z in (24, 33, 52, 72, 90)), (38, 52, 64, 68)))
SHARES_UNSEEN = (0.13, 0.22, 0.33, 0.43)
"""Neither fitted nor looked at before the form of the law stood."""
TEETH_BY_ANGLE, ANGLES_BY_ANGLE = (21, 33, 60), (40, 52, 65)
PRESSURE_ANGLES_DEG = (14.5, 16.0, 17.5, 20.0, 22.5, 23.5, 25.0)
"""Gears of other numbers of teeth than the fit's; it has no gear of 16 and 23.5 degrees at all."""
SHARES_BY_ANGLE = (0.13, 0.25, 0.4)
RACKS_LEFT_OUT = {
    "X = +0.5, z = 17": ToothShape(17, 2.5, profile_shift=0.5),
    "X = +0.4, z = 35": ToothShape(35, 2.5, profile_shift=0.4),
    "X = -0.3, z = 35": ToothShape(35, 2.5, profile_shift=-0.3),
    "17.5 deg, z = 40": ToothShape(40, 2.5, pressure_angle_deg=17.5),
    "25 deg, c = 0.2, z = 30": ToothShape(30, 2.5, pressure_angle_deg=25.0, clearance=0.2),
    "25 deg, c = 0.2, z = 80": ToothShape(80, 2.5, pressure_angle_deg=25.0, clearance=0.2),
    "root over bore 1.4, z = 18": ToothShape(18, 1.4),
    "root over bore 6, z = 50": ToothShape(50, 6.0),
}
POISSON = (0.2, 0.3, 0.4)


def _errors(cases: Iterable[tuple[ToothShape, float]], shares: Iterable[float]) -> tuple[np.ndarray, np.ndarray]:
    """Return the law's error over what the crack adds, and over the sound tooth, (n,) each."""
    found = []
    for (shape, angle_deg), share in product(cases, shares):
        gear, roll = shape.gear(), flank_rolls(shape)
        sound, added = crack_compliance(gear, roll, share, radians(angle_deg), size=FIT_SIZE)
        error = unit_compliance(gear, roll, share, radians(angle_deg)) - added
        found.append((error / added, error / sound))
    return tuple(np.abs(np.concatenate(found, axis=1)))  # type: ignore[return-value]


def _line(name: str, cases: Iterable[tuple[ToothShape, float]], shares: tuple[float, ...]) -> str:
    own, of_tooth = (100.0 * error for error in _errors(cases, shares))
    depths = ", ".join(f"{share:g}" for share in shares)
    middle, most = f"{np.median(own):.1f} %", f"{np.quantile(own, 0.95):.1f} %"
    return f"| {name} | {depths} | {own.size} | {middle} | {most} | {own.max():.1f} % | {of_tooth.max():.1f} % |"


def crack_table() -> Iterator[str]:
    """Lines of the law's errors over the crack's compliance, and the largest over the sound tooth's (six minutes)."""
    yield "| gears | depth shares | loads | median | 95 % within | largest | largest, of the sound tooth |"
    yield "|---|---|---|---|---|---|---|"
    for name, cases in (("fitted", FITTED), ("not fitted, nor angles", GEARS_LEFT_OUT)):
        yield _line(name, cases, SHARES[1:])
        yield _line(name, cases, SHARES[:1])
    yield _line("unseen: gears, angles, depths", GEARS_UNSEEN, SHARES_UNSEEN)
    for pressure_deg in PRESSURE_ANGLES_DEG:
        shapes = (ToothShape(z, 2.5, pressure_angle_deg=pressure_deg) for z in TEETH_BY_ANGLE)
        cases = tuple(product(shapes, ANGLES_BY_ANGLE))
        yield _line(f"not fitted, {pressure_deg:g} deg", cases, SHARES_BY_ANGLE)
        yield _line(f"not fitted, {pressure_deg:g} deg", cases, SHARES[:1])
    for name, shape in RACKS_LEFT_OUT.items():
        yield _line(name, tuple((shape, angle) for angle in ANGLES_BY_ANGLE), SHARES[1:])


def crack_convergence_table() -> Iterator[str]:
    """Lines of what a crack adds by edge length, and by Poisson's ratio (E L Δc, half a minute)."""
    shape = ToothShape(18, 2.5)
    gear, roll = shape.gear(), flank_rolls(shape)[[2, 6, 9]]
    yield "| edge length [m], Poisson's ratio | depth 0.1, 45 deg | depth 0.4, 70 deg |"
    yield "|---|---|---|"
    options = [(size, 0.3) for size in (0.16, 0.08, 0.05, 0.03)] + [(FIT_SIZE, nu) for nu in POISSON]
    for size, poisson in options:
        columns = []
        for share, angle_deg in ((0.1, 45), (0.4, 70)):
            elasticity = PlaneElasticity(poisson)
            _, added = crack_compliance(gear, roll, share, radians(angle_deg), elasticity, size)
            columns.append(", ".join(f"{value:.4f}" for value in added))
        yield f"| {size:g}, {poisson:g} | " + " | ".join(columns) + " |"
