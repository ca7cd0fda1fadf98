"""Tables of the law of cracks against finite elements: gears and angles that were fitted and that were not."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product
from math import radians

import numpy as np

from siggen.damage.crack_law import unit_compliance
from tests.reference.finite_elements.calibration import ToothShape
from tests.reference.finite_elements.crack_fit import FIT_SIZE, TEETH, flank_rolls
from tests.reference.finite_elements.cracked_tooth import crack_compliance

SHARES = (0.05, 0.1, 0.25, 0.4)
FITTED = tuple(pair for plan in TEETH for pair in product(plan.shapes, plan.angles_deg))
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
