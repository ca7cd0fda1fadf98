"""Sizes that a file leaves out where it says the rated torque: masses, bearings, couplings and shafts.

By the rules of `siggen init` (`rig_numbers`), at the middle of what is drawn. With three digits, as a file has them.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import atan, cos, degrees, radians, tan
from typing import Any

from pydantic import TypeAdapter, ValidationError

from siggen.config import GearsSection
from siggen.config.config import OperatingRange
from siggen.config.dynamics import RATED, ShaftSection
from siggen.errors import Problem
from siggen.keys.merging import merged
from siggen.keys.number import Number, bounds
from siggen.keys.problems import received_text
from siggen.names import SHAFT_OF
from siggen.rig.rig import Rig
from siggen.rig.rig_numbers import RotorNumbers, rig_numbers

WHEELS = ("pinion", "gear")
SPREAD = (0.75, 1.33)
"""Of stiffness between bearings of one size: fit, clearance and number of balls are not known (assumed)."""
DAMPING = (0.02, 0.04)
"""Of a shaft on its bearings, as a share of the critical one (assumed)."""
OTHERS = ("machine", "planetary")


def with_sizes(raw: Mapping[str, Any]) -> tuple[dict[str, Any], list[Problem]]:
    """Return a raw configuration with the numbers that follow from its rated torque where it gives none itself.

    Shafts of given diameters have bearings of this bore; without `shafts` none bend. What cannot be read is left to be
    refused.

    Parameters
    ----------
    raw : mapping
        With everything that it extends.
    """
    dynamics = raw.get("dynamics")
    rated = dynamics.get(RATED) if isinstance(dynamics, Mapping) else None
    if rated is None or not isinstance(dynamics, Mapping):
        return dict(raw), []
    if beside := [key for key in OTHERS if raw.get(key)]:
        allowed = "allowed with gears alone; here give masses, bearings and couplings themselves"
        return dict(raw), [Problem(f"dynamics.{RATED}", f"{received_text(rated)}, beside {beside[0]}", allowed)]
    try:
        torque_nm = TypeAdapter(float).validate_python(rated, strict=True)
        gears = GearsSection.model_validate(raw.get("gears"))
        points = TypeAdapter(tuple[OperatingRange, ...]).validate_python(raw.get("operating_points"))
        diameters = [_diameter_mm(dynamics, wheel) for wheel in WHEELS]
    except ValidationError:
        return dict(raw), []
    if not (0.0 < torque_nm < float("inf") and points):
        return dict(raw), []
    speeds_hz = [bound for point in points for bound in bounds(point.speed_hz)]
    derived = sizes(_rig(gears, torque_nm, (min(speeds_hz), max(speeds_hz)), diameters))
    if dynamics.get("shafts") is None:
        derived.pop("shafts")
    return {**raw, "dynamics": merged(derived, dynamics)}, []


def sizes(rig: Rig) -> dict[str, Any]:
    """Return keys of `dynamics` by the rules of a rig at its largest torque."""
    numbers = rig_numbers(rig)
    couplings = zip(("input", "output"), numbers.coupling_nm_per_rad, numbers.coupling_nm_s_per_rad, strict=True)
    shafts = [rotor.shaft for rotor in numbers.rotors]
    return {
        **{wheel: _rotor(rotor) for wheel, rotor in zip(WHEELS, numbers.rotors, strict=True)},
        "motor_inertia_kg_m2": _rounded(numbers.motor_inertia_kg_m2),
        "load_inertia_kg_m2": _rounded(numbers.load_inertia_kg_m2),
        **{
            f"{which}_coupling": {"stiffness_nm_per_rad": _rounded(k, 4), "damping_nm_s_per_rad": _rounded(c)}
            for which, k, c in couplings
        },
        "shafts": {
            key: {"bearing_span_mm": _rounded(shaft.span_mm, 15), "diameter_mm": _rounded(shaft.diameter_mm, 15)}
            for key, shaft in zip(SHAFT_OF.values(), shafts, strict=True)
        },
    }


def _rig(gears: GearsSection, torque_nm: float, speed_hz: tuple[float, float], diameters_mm: list[float | None]) -> Rig:
    """Return the pair as a rig of spur gears with the same pitch circles: helical ones by their transverse section."""
    across = cos(radians(_middle(gears.helix_deg)))
    first, second = diameters_mm
    return Rig(
        teeth=(gears.pinion.teeth, gears.gear.teeth),
        module_mm=_middle(gears.module_mm) / across,
        face_width_mm=_middle(gears.face_width_mm),
        speed_hz=speed_hz,
        torque_nm=(torque_nm, torque_nm),
        pressure_angle_deg=degrees(atan(tan(radians(_middle(gears.pressure_angle_deg))) / across)),
        bores_mm=None if first is None or second is None else (first, second),
        shifts=(_middle(gears.pinion.profile_shift), _middle(gears.gear.profile_shift)),
    )


def _diameter_mm(dynamics: Mapping[str, Any], wheel: str) -> float | None:
    shafts = dynamics.get("shafts")
    given = shafts.get(SHAFT_OF[wheel]) if isinstance(shafts, Mapping) else None
    if not isinstance(given, Mapping) or "diameter_mm" not in given:
        return None
    return _middle(ShaftSection.model_validate({"diameter_mm": given["diameter_mm"]}).diameter_mm)


def _rotor(rotor: RotorNumbers) -> dict[str, Any]:
    damping = [2.0 * ratio * (rotor.bearing_n_per_m * rotor.mass_kg) ** 0.5 for ratio in DAMPING]
    return {
        "mass_kg": _rounded(rotor.mass_kg),
        "inertia_kg_m2": _rounded(rotor.inertia_kg_m2),
        "bearing": {
            "stiffness_n_per_m": {"log": [_rounded(share * rotor.bearing_n_per_m) for share in SPREAD]},
            "damping_n_s_per_m": {"log": [_rounded(one) for one in damping]},
        },
    }


def _middle(value: Number) -> float:
    low, high = bounds(value)
    return 0.5 * (low + high)


def _rounded(value: float, digits: int = 3) -> float:
    return float(f"{value:.{digits}g}")
