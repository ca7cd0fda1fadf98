"""Tables of the finite-element check: models against finite elements, mesh convergence, held-out gears."""

from __future__ import annotations

from collections.abc import Iterator
from math import radians

import numpy as np

from siggen.gears.gear_pair import GearPair, SpurGear
from siggen.mesh.calibration import calibration_factor
from tests.reference.finite_elements.calibration import ToothShape, compliance_ratio
from tests.reference.finite_elements.model_compliance import CALIBRATED_MODEL, MODELS, model_compliance
from tests.reference.finite_elements.tooth_compliance_fem import tooth_compliance

SIZE = 0.03
POINTS = 13
SIZES = (0.16, 0.08, 0.04, 0.02, 0.01)


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


def _errors(shape: ToothShape, place: np.ndarray) -> tuple[str, str]:
    """Largest deviation without and with the calibration, in per cent."""
    gear = shape.gear()
    roll = gear.involute_start_roll_rad + place * (gear.tip_roll_rad - gear.involute_start_roll_rad)
    model = 1 / compliance_ratio(shape, place, SIZE)
    with_factor = model * calibration_factor(gear, roll)
    return f"{100 * np.abs(model - 1).max():.1f} %", f"{100 * np.abs(with_factor - 1).max():.2f} %"


SPOT_SHAPES = (
    ToothShape(18.0, 2.17),
    ToothShape(47.0, 3.894),
    ToothShape(17.0, 4.0),
    ToothShape(23.0, 6.0),
    ToothShape(65.0, 1.6),
    ToothShape(33.0, 3.0, profile_shift=0.3),
    ToothShape(28.0, 2.5, pressure_angle_deg=22.0),
)
SPOT_PLACES = (0.1, 0.3, 0.5, 0.7, 0.9)


def spots() -> Iterator[str]:
    """Lines of finite-element compliances times E L, the values that the fast tests hold."""
    place = np.array(SPOT_PLACES)
    yield f"z, h_f, X, pressure angle [deg]: compliance times E L at places {SPOT_PLACES}"
    for s in SPOT_SHAPES:
        gear = s.gear()
        roll = gear.involute_start_roll_rad + place * (gear.tip_roll_rad - gear.involute_start_roll_rad)
        values = ", ".join(f"{c:.4f}" for c in tooth_compliance(gear, roll, size=0.02))
        yield f"({s.teeth:.0f}, {s.radius_ratio:g}, {s.profile_shift:g}, {s.pressure_angle_deg:g}): ({values})"
