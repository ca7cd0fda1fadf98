"""What is physically impossible in a section `variation`: motors that stall by slip, run-downs driven by the load."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi
from typing import Any

from siggen.config import Dynamics, OperatingRange, Variation
from siggen.config.config import rated_nm
from siggen.dynamics.structure.steel_disc import disc_inertia_kg_m2
from siggen.errors import Problem
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import bounds

NEEDED = ("variation", "operating_points", "dynamics", "duration_s")


def variation_problems(sections: Mapping[str, Any], pairs: Sequence[GearPair]) -> list[Problem]:
    """Return the problems of a section at the bounds of all numbers, for the gears that are possible."""
    if not set(NEEDED) <= sections.keys() or not sections["variation"].active:
        return []
    variation, points = sections["variation"], sections["operating_points"]
    return [
        *_stalling(variation, points, rated_nm(sections["dynamics"], points)),
        *_driven_by_load(variation, points, _driven_inertias_kg_m2(sections, pairs), sections["duration_s"]),
    ]


def _stalling(variation: Variation, points: Sequence[OperatingRange], rated: float) -> list[Problem]:
    slip = bounds(variation.speed.slip)[1]
    torque_nm = max(bounds(point.torque_nm)[1] for point in points)
    if slip * torque_nm / rated < 0.5:
        return []
    received = f"{slip:g} at {rated:g} N m, which is {slip * torque_nm / rated:.0%} at {torque_nm:g} N m"
    allowed = (
        "allowed: a slip below 50 % at the highest torque; lower slip or the torque, or raise dynamics.rated_torque_nm"
    )
    return [Problem("variation.speed.slip", received, allowed)]


def _driven_by_load(
    variation: Variation,
    points: Sequence[OperatingRange],
    driven_kg_m2: Sequence[float],
    duration_s: float,
) -> list[Problem]:
    """Refuse run-ups and run-downs that load the other flanks in the mean than the torque of an operating point does.

    Ranges around 0 and 0 itself load both.
    """
    speed = variation.speed
    fall = bounds(speed.end_ratio)[0] - bounds(speed.start_ratio)[1]
    rise = bounds(speed.end_ratio)[1] - bounds(speed.start_ratio)[0]
    for point in points:
        low, high = bounds(point.torque_nm)
        if low > 0.0:
            sign, torque_nm, change = 1.0, low, min(fall, 0.0)
        elif high < 0.0:
            sign, torque_nm, change = -1.0, high, max(rise, 0.0)
        else:
            continue
        speeding = 2.0 * pi * bounds(point.speed_hz)[1] * change / duration_s
        at_mesh = [sign * (torque_nm + inertia * speeding) for inertia in driven_kg_m2]
        if min(at_mesh, default=1.0) <= 0.0:
            received = f"{change:+g} of {bounds(point.speed_hz)[1]:g} Hz in {duration_s:g} s, with which "
            received += "the load drives" if sign > 0.0 else "the motor drives"
            received += f" ({sign * min(at_mesh):.4g} N m at the mesh)"
            advice = "above 0 at the mesh; raise end_ratio, duration_s or the torque"
            if sign < 0.0:
                advice = "below 0 at the mesh, as its torque is; lower end_ratio or the torque, or raise duration_s"
            allowed = f"allowed: a mean torque {advice}"
            return [Problem("variation.speed.end_ratio", received, allowed)]
    return []


def _driven_inertias_kg_m2(sections: Mapping[str, Any], pairs: Sequence[GearPair]) -> list[float]:
    """Return the largest inertia of gear and load of each pair, seen from the pinion; the load's behind a carrier."""
    planetary, dynamics = sections.get("planetary"), sections["dynamics"]
    if planetary is None:
        return [_driven_inertia_kg_m2(dynamics, pair) for pair in pairs]
    load = bounds(dynamics.load_inertia_kg_m2)[1]
    return [load / (1.0 + planetary.ring_teeth / pair.pinion.teeth) ** 2 for pair in pairs]


def _driven_inertia_kg_m2(dynamics: Dynamics, pair: GearPair) -> float:
    own = dynamics.gear.inertia_kg_m2
    gear = disc_inertia_kg_m2(pair.gear, pair.face_width_m) if own is None else bounds(own)[1]
    return (gear + bounds(dynamics.load_inertia_kg_m2)[1]) * (pair.pinion.teeth / pair.gear.teeth) ** 2
