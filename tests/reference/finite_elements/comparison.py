"""Tables of the finite-element check: models against finite elements, mesh convergence, held-out gears."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import radians

import numpy as np

from siggen.gears.geometry.gear_pair import GearPair, SpurGear
from siggen.gears.stiffness.calibration import calibration_factor
from tests.reference.finite_elements.calibration import ToothShape, compliance_ratio, held_out_shapes
from tests.reference.finite_elements.model_compliance import CALIBRATED_MODEL, MODELS, model_compliance
from tests.reference.finite_elements.tooth_compliance_fem import PlaneElasticity, tooth_compliance

SIZE = 0.03
POINTS = 13
SIZES = (0.16, 0.08, 0.04, 0.02, 0.01)


def paper_a_pair() -> GearPair:
    """Return the 18/47 pair of the paper_a preset: module 3.5 mm, bores 12.5 and 20 mm (assumed there)."""
    gears = [SpurGear(z, 3.5e-3, radians(20.0), 0.0, 1.0, 0.25, b) for z, b in ((18, 12.5e-3), (47, 20.0e-3))]
    return GearPair(gears[0], gears[1], face_width_m=0.02, youngs_modulus_pa=206e9, poisson_ratio=0.3)


def active_rolls(pair: GearPair, count: int = POINTS) -> tuple[np.ndarray, np.ndarray]:
    """Roll angles over each gear's active flank, (count,) each; the last point keeps 0.2 % off the tip's corner."""
    rolls = [first + (last - first) * np.linspace(0.0, 0.998, count) for first, last in pair.active_flank]
    return rolls[0], rolls[1]


def single_contact(pair: GearPair) -> tuple[tuple[float, float], tuple[float, float]]:
    """Roll angles between which each gear's tooth carries the load alone."""
    low, high = pair.contact_end_m - pair.base_pitch_m, pair.contact_start_m + pair.base_pitch_m
    pinion, gear = pair.pinion.base_radius_m, pair.gear.base_radius_m
    length = pair.line_of_action_m
    return (low / pinion, high / pinion), ((length - high) / gear, (length - low) / gear)


def model_ratios(gear: SpurGear, roll: np.ndarray, elements: np.ndarray) -> dict[str, np.ndarray]:
    """Model / finite elements of every model and of the calibrated one, (k,) each."""
    ratios = {name: model_compliance(gear, roll, options) / elements for name, options in MODELS.items()}
    return ratios | {"calibrated": ratios[CALIBRATED_MODEL] * calibration_factor(gear, roll)}


def _span(values: np.ndarray) -> str:
    return f"{values.min():.3f}-{values.max():.3f}"


def model_table() -> Iterator[str]:
    """Lines of the comparison of all models with finite elements for the paper_a pair."""
    pair = paper_a_pair()
    yield "| z | model | whole active flank | single contact | pitch point |"
    yield "|---|---|---|---|---|"
    for gear, roll, alone in zip((pair.pinion, pair.gear), active_rolls(pair, 41), single_contact(pair), strict=True):
        pitch = np.append(roll, np.tan(gear.pressure_angle_rad))
        elements = tooth_compliance(gear, pitch, size=SIZE)
        inside = (roll >= alone[0]) & (roll <= alone[1])
        for name, ratio in model_ratios(gear, pitch, elements).items():
            yield f"| {gear.teeth} | {name} | {_span(ratio[:-1])} | {_span(ratio[:-1][inside])} | {ratio[-1]:.3f} |"


def plane_strain_table() -> Iterator[str]:
    """Lines of plane strain / plane stress, and of the models against plane strain."""
    pair = paper_a_pair()
    yield "| z | plane strain / stress | rack trochoid + rack / strain | root circle + profile / strain |"
    yield "|---|---|---|---|"
    for gear, roll in zip((pair.pinion, pair.gear), active_rolls(pair), strict=True):
        stress = tooth_compliance(gear, roll, size=SIZE)
        strain = tooth_compliance(gear, roll, PlaneElasticity(plane_strain=True), SIZE)
        ratios = model_ratios(gear, roll, strain)
        columns = (strain / stress, ratios[CALIBRATED_MODEL], ratios["root circle + profile"])
        yield f"| {gear.teeth} | " + " | ".join(map(_span, columns)) + " |"


def poisson_table() -> Iterator[str]:
    """Lines of the error that Poisson's ratio other than 0.3 leaves in the calibrated compliance (plane stress)."""
    pair = paper_a_pair()
    yield "| z | nu 0.25 / nu 0.3 | nu 0.33 / nu 0.3 |"
    yield "|---|---|---|"
    for gear, roll in zip((pair.pinion, pair.gear), active_rolls(pair), strict=True):
        usual = tooth_compliance(gear, roll, size=SIZE)
        others = [tooth_compliance(gear, roll, PlaneElasticity(nu), SIZE) / usual for nu in (0.25, 0.33)]
        yield f"| {gear.teeth} | " + " | ".join(map(_span, others)) + " |"


def convergence_table() -> Iterator[str]:
    """Lines of the largest deviation over the active flank from the finest mesh, by edge length."""
    pair = paper_a_pair()
    yield "| edge length [m] | z = 18 | z = 47 |"
    yield "|---|---|---|"
    values = {
        s: [tooth_compliance(g, r, size=s) for g, r in zip((pair.pinion, pair.gear), active_rolls(pair), strict=True)]
        for s in SIZES
    }
    for size in SIZES[:-1]:
        errors = [np.abs(v / finest - 1).max() for v, finest in zip(values[size], values[SIZES[-1]], strict=True)]
        yield f"| {size:g} | " + " | ".join(f"{100 * e:.3f} %" for e in errors) + " |"


def held_out_table() -> Iterator[str]:
    """Lines of the calibrated model's deviation from finite elements on standard gears that were not fitted."""
    place = np.linspace(0.0, 0.998, 15)
    yield "| z | h_f | uncalibrated | calibrated |"
    yield "|---|---|---|---|"
    for shape in held_out_shapes(20):
        yield f"| {shape.teeth:.0f} | {shape.radius_ratio:.2f} | " + " | ".join(_errors(shape, place)) + " |"


def _errors(shape: ToothShape, place: np.ndarray) -> tuple[str, str]:
    """Largest deviation without and with the calibration, in per cent."""
    gear = shape.gear()
    roll = gear.involute_start_roll_rad + place * (gear.tip_roll_rad - gear.involute_start_roll_rad)
    model = 1 / compliance_ratio(shape, place, SIZE)
    with_factor = model * calibration_factor(gear, roll)
    return f"{100 * np.abs(model - 1).max():.1f} %", f"{100 * np.abs(with_factor - 1).max():.2f} %"


VARIANTS = {
    "standard": {},
    "X = +0.3": {"profile_shift": 0.3},
    "X = -0.3": {"profile_shift": -0.3},
    "X = +0.5": {"profile_shift": 0.5},
    "17.5 deg": {"pressure_angle_deg": 17.5},
    "22 deg": {"pressure_angle_deg": 22.0},
    "25 deg, c = 0.2": {"pressure_angle_deg": 25.0, "clearance": 0.2},
    "22 deg, X = +0.3": {"pressure_angle_deg": 22.0, "profile_shift": 0.3},
    "c = 0.2": {"clearance": 0.2},
    "c = 0.3": {"clearance": 0.3},
}


def variants_table() -> Iterator[str]:
    """Lines of the largest deviation over gears between the nodes, by rack and shift (undercut teeth left out)."""
    place = np.linspace(0.0, 0.998, 9)
    yield "| rack and shift | gears | uncalibrated | calibrated |"
    yield "|---|---|---|---|"
    for name, changes in VARIANTS.items():
        grid = [ToothShape(z, h) for z in (19.0, 26.0, 41.0, 83.0) for h in (1.55, 2.6, 5.5)]
        shapes = [s for s in (replace(g, **changes) for g in grid) if s.usable()]
        errors = np.array([[float(e.split()[0]) for e in _errors(s, place)] for s in shapes]).max(axis=0)
        yield f"| {name} | {len(shapes)} | {errors[0]:.1f} % | {errors[1]:.2f} % |"


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


OUTSIDE_SHAPES = (
    ToothShape(13.0, 2.5, profile_shift=0.4),
    ToothShape(14.0, 2.5),
    ToothShape(150.0, 2.5),
    ToothShape(30.0, 1.25),
    ToothShape(30.0, 10.0),
    ToothShape(40.0, 2.5, profile_shift=0.8),
)


def outside_table() -> Iterator[str]:
    """Lines of the deviation of gears outside the calibrated range, where the nearest gear's factor is used."""
    place = np.linspace(0.0, 0.998, 9)
    yield "| z | h_f | X | uncalibrated | calibrated (clamped) |"
    yield "|---|---|---|---|---|"
    for s in OUTSIDE_SHAPES:
        yield f"| {s.teeth:.0f} | {s.radius_ratio:g} | {s.profile_shift:g} | " + " | ".join(_errors(s, place)) + " |"
