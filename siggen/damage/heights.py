"""Heights of points on a flank above the base circle, and the arc along the involute that an outline spans."""

from __future__ import annotations

from math import sqrt, tan

import numpy as np
from numpy.typing import ArrayLike

from siggen.arrays import FloatArray
from siggen.damage.outlines import Outline
from siggen.gears.gear_pair import GearPair, contact_zones
from siggen.gears.spur_gear import SpurGear
from siggen.names import Side

READINGS = ("axial", "arc")


def flank_heights(gear: SpurGear) -> tuple[float, float]:
    """Return the heights x of the ends of the flank, ascending: start of the involute and tip, of rings turned [m]."""
    low, high = gear.flank_rolls_rad
    return float(gear.height_m(low)), float(gear.height_m(high))


def initiation_height_m(pair: GearPair, side: Side) -> float:
    """Return the height x half way along the flank from the lowest point of the zone around the pitch point to it [m].

    With a contact ratio below 2 that zone is the one of single contact: the full load meets negative sliding. Derived.
    """
    gear, line = pair.member(side), pair.line_of_action_m
    pitch = pair.pinion.base_radius_m * tan(pair.working_pressure_angle_rad)
    zone = next(z for z in contact_zones(pair) if z.start_m <= pitch <= z.end_m)
    travels = (zone.start_m, pitch) if side == Side.DRIVER else (line - zone.end_m, line - pitch)
    arc_m = sum(travel**2 for travel in travels) / (4.0 * gear.base_radius_m)
    return axial_height(gear, arc_m, "arc")


def axial_height(gear: SpurGear, value_m: float, reading: str) -> float:
    """Return the height x along the tooth centre line of a flank point that was measured another way [m].

    Parameters
    ----------
    gear : SpurGear
    value_m : float
        Distance of the point from the base circle [m].
    reading : str
        'axial' (already x) or 'arc' (along the involute, R_b psi^2/2).

    Raises
    ------
    ValueError
        If the reading is unknown.
    """
    if reading == "axial":
        return float(value_m)
    ratio = value_m / gear.base_radius_m
    if reading == "arc":
        return float(gear.height_m(sqrt(2.0 * ratio)))
    raise ValueError(f"received height reading {reading!r}; allowed: {', '.join(READINGS)}")


def profile_arc_m(gear: SpurGear, outline: Outline) -> float:
    """Return the arc along the involute that an outline spans, clipped to the flank [m]."""
    return clipped_arc_m(gear, outline.height_range_m)


def clipped_arc_m(gear: SpurGear, height_range_m: tuple[float, float]) -> float:
    """Return the arc along the involute between two heights, clipped to the flank [m]."""
    return float(clipped_arcs_m(gear, *height_range_m))


def clipped_arcs_m(gear: SpurGear, low_m: ArrayLike, high_m: ArrayLike) -> FloatArray:
    """Return the arcs along the involute from lower to upper heights, clipped to the flank, in their shape [m]."""
    low, high = gear.roll_at_height(np.clip(np.array([low_m, high_m], dtype=np.float64), *flank_heights(gear)))
    return np.asarray(0.5 * gear.base_radius_m * (high - low) * (high + low))
