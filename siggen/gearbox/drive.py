"""What is drawn of how a gearbox is driven: how speed and torque vary at an operating point, and unbalance; in SI."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi

from siggen.config import Dynamics, Variation
from siggen.drivetrain.varying_drive import TorqueSettings
from siggen.keys.drawing import draw, in_si
from siggen.keys.number import constant
from siggen.names import Names


@dataclass(frozen=True, slots=True)
class SpeedLevels:
    """How the speed varies over that of the operating point."""

    start_ratio: float
    end_ratio: float
    random_rms: float
    ripple_once: float
    ripple_twice: float
    slip: float


@dataclass(frozen=True, slots=True)
class PointVariation:
    """What varies within a record at an operating point; courses and phases belong to records."""

    speed: SpeedLevels
    torque: TorqueSettings


@dataclass(frozen=True, slots=True)
class UnbalanceLevels:
    """Grade of balance of the shafts [mm/s], and the angle of each, in the order of power."""

    grade_mm_s: float
    phases_rad: tuple[float, ...]


def drawn_variation(law: Variation, uniform: Callable[[str], float]) -> PointVariation | None:
    """Return the variation at an operating point; None where nothing varies."""
    if not law.active:
        return None
    section = draw(law, uniform, "variation")
    torque = in_si(section.torque)
    speed = SpeedLevels(**in_si(section.speed))
    return PointVariation(speed, TorqueSettings(slow_rms=torque.pop("random_rms"), **torque))


def drawn_unbalance(dynamics: Dynamics, names: Names, uniform: Callable[[str], float]) -> UnbalanceLevels | None:
    """Return the unbalance of a drawn section; None for balanced shafts."""
    grade_mm_s = constant(dynamics.unbalance.grade_mm_s)
    if grade_mm_s <= 0.0:
        return None
    phases = (2.0 * pi * uniform(f"dynamics.unbalance.{shaft.bearing}.phase") for shaft in names.shafts)
    return UnbalanceLevels(grade_mm_s, tuple(phases))
