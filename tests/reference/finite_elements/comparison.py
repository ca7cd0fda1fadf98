"""Tables of the finite-element check: models against finite elements, mesh convergence, held-out gears."""

from __future__ import annotations

from math import radians

import numpy as np

from siggen.gears.gear_pair import GearPair, SpurGear
from siggen.mesh.calibration import calibration_factor
from tests.reference.finite_elements.model_compliance import CALIBRATED_MODEL, MODELS, model_compliance

SIZE = 0.03
POINTS = 13


def paper_a_pair() -> GearPair:
    """Return the 18/47 pair of the paper_a preset: module 3.5 mm, bores 12.5 and 20 mm (assumed there)."""
    gears = [
        SpurGear(z, 3.5e-3, radians(20.0), 0.0, 1.0, 0.25, b, body_ratio=1.0) for z, b in ((18, 12.5e-3), (47, 20.0e-3))
    ]
    return GearPair(gears[0], gears[1], face_width_m=0.02, youngs_modulus_pa=206e9, poisson_ratio=0.3)


def active_rolls(pair: GearPair, count: int = POINTS) -> tuple[np.ndarray, np.ndarray]:
    """Roll angles over each gear's active flank, (count,) each; the last point keeps 0.2 % off the tip's corner."""
    rolls = [first + (last - first) * np.linspace(0.0, 0.998, count) for first, last in pair.active_flank]
    return rolls[0], rolls[1]


def model_ratios(gear: SpurGear, roll: np.ndarray, elements: np.ndarray) -> dict[str, np.ndarray]:
    """Model / finite elements of every model and of the calibrated one, (k,) each."""
    ratios = {name: model_compliance(gear, roll, options) / elements for name, options in MODELS.items()}
    return ratios | {"calibrated": ratios[CALIBRATED_MODEL] * calibration_factor(gear, roll)}
