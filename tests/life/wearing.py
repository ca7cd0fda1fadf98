"""Gearboxes on whose flanks laws of life are tried."""

from __future__ import annotations

import math

from siggen.gears.gear_pair import GearPair, SpurGear
from siggen.keys.number import MIDDLE, at
from siggen.life.flank import Flank, flanks
from siggen.life.law import Wearing
from siggen.life.pitting import TORQUE_EXPONENT, PittingCourse
from siggen.seeding import Stream, named_generator


def pair_flanks(pinion: int = 28, gear: int = 28, face_m: float = 6.35e-3) -> tuple[Flank, Flank]:
    """Return the flanks of a pair of module 3.175 mm."""
    return flanks(pair(pinion, gear, face_m))


def pair(pinion: int = 28, gear: int = 28, face_m: float = 6.35e-3) -> GearPair:
    """Return that pair."""
    made = [SpurGear(z, 3.175e-3, math.radians(20.0), 0.0, 1.0, 0.25, 0.01) for z in (pinion, gear)]
    return GearPair(made[0], made[1], face_m, 206e9, 0.3)


PAIR = pair()
NOMINAL = pair_flanks()


def course(unit: int, share: float = 0.3, own: tuple[Flank, Flank] = NOMINAL) -> PittingCourse:
    """Return the life of a gearbox with the middle of the exponents of torque."""
    wearing = Wearing(own, NOMINAL, lambda name: named_generator(7, Stream.LIFE, unit, name=name))
    return PittingCourse(at(TORQUE_EXPONENT, MIDDLE), wearing, share)
