"""What is physically impossible in a section `variation`: motors that stall by slip, run-downs driven by the load."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

from siggen.errors import Problem
from siggen.gearbox.possible import PossibleGearbox
from siggen.keys.number import bounds


def variation_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield the problems of a section at the bounds of all numbers, for the gears that are possible."""
    if gearbox.config.variation.active and gearbox.config.operating_points:
        yield from _stalling(gearbox)
        yield from _driven_by_load(gearbox)


def _stalling(gearbox: PossibleGearbox) -> Iterator[Problem]:
    slip, rated_nm = bounds(gearbox.config.variation.speed.slip)[1], gearbox.rated_nm
    torque_nm = max(bounds(point.torque_nm)[1] for point in gearbox.config.operating_points)
    if slip * torque_nm / rated_nm >= 0.5:
        received = f"{slip:g} at {rated_nm:g} N m, which is {slip * torque_nm / rated_nm:.0%} at {torque_nm:g} N m"
        allowed = "allowed: a slip below 50 % at the highest torque; lower slip or the torque, or raise "
        yield Problem("variation.speed.slip", received, f"{allowed}dynamics.rated_torque_nm")


def _driven_by_load(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield run-ups and run-downs that load the other flanks in the mean than the torque of an operating point does.

    Ranges around 0 and 0 itself load both.
    """
    speed, duration_s = gearbox.config.variation.speed, gearbox.config.duration_s
    fall = bounds(speed.end_ratio)[0] - bounds(speed.start_ratio)[1]
    rise = bounds(speed.end_ratio)[1] - bounds(speed.start_ratio)[0]
    inertias = [gearbox.driven_inertia_kg_m2(pair) for pair in gearbox.meshes[0].pairs]
    for point in gearbox.config.operating_points:
        low, high = bounds(point.torque_nm)
        if low <= 0.0 <= high:
            continue
        sign, torque_nm, change = (1.0, low, min(fall, 0.0)) if low > 0.0 else (-1.0, high, max(rise, 0.0))
        speeding = 2.0 * pi * bounds(point.speed_hz)[1] * change / duration_s
        at_mesh = [sign * (torque_nm + inertia * speeding) for inertia in inertias]
        if min(at_mesh, default=1.0) <= 0.0:
            received = f"{change:+g} of {bounds(point.speed_hz)[1]:g} Hz in {duration_s:g} s, with which "
            received += "the load drives" if sign > 0.0 else "the motor drives"
            received += f" ({sign * min(at_mesh):.4g} N m at the mesh)"
            advice = "above 0 at the mesh; raise end_ratio, duration_s or the torque"
            if sign < 0.0:
                advice = "below 0 at the mesh, as its torque is; lower end_ratio or the torque, or raise duration_s"
            yield Problem("variation.speed.end_ratio", received, f"allowed: a mean torque {advice}")
            return
