"""RootChord: where the root of a rack-cut tooth is stressed most, by the tangent of 30 degrees (ISO 6336-3)."""

from __future__ import annotations

from functools import lru_cache
from math import pi, tan
from typing import NamedTuple

from siggen.gears.geometry.spur_gear import SpurGear

TANGENT_RAD = pi / 6.0
"""Between the fillet's tangent and the tooth's centre line."""


class RootChord(NamedTuple):
    """Height above the gear centre and length of the chord between the two points of the fillets [m]."""

    height_m: float
    length_m: float


@lru_cache(maxsize=256)
def root_chord(gear: SpurGear) -> RootChord:
    """Return the chord between the points of both fillets whose tangent makes 30 degrees with the centre line.

    Raises
    ------
    ValueError
        If the fillet has no such tangent.

    Source: ISO 6336-3 (memory); derived: at gamma the common normal has the slope gamma - turn, so the tangent makes
    this angle with the centre line. It falls from the root circle to the involute.
    """
    from scipy.optimize import brentq

    def over(gamma: float) -> float:
        turn = (gear.rack_round_depth_m / tan(gamma) + gear.rack_round_offset_m) / gear.pitch_radius_m
        return gamma - turn - TANGENT_RAD

    first, last = gear.involute_start_gamma_rad, 0.5 * pi
    if not over(first) < 0.0 < over(last):
        raise ValueError("the fillet has no tangent at 30 degrees to the tooth's centre line")
    height, half = gear.trochoid_point_m(brentq(over, first, last, xtol=1e-14))
    return RootChord(height, 2.0 * half)
