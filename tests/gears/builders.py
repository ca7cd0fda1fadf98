"""Gear pairs and pits that the tests of the tooth mechanics share."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import radians

from siggen.damage.pits import FlankPit
from siggen.gears.gear_pair import GearPair, SpurGear


def spur_gear(teeth=18, module_m=3.5e-3, bore_radius_m=12.5e-3, profile_shift=0.0):
    return SpurGear(teeth, module_m, radians(20.0), profile_shift, 1.0, 0.25, bore_radius_m)


def pair_18_47(module_m=3.5e-3, bores_m=(12.5e-3, 20e-3), shifts=(0.0, 0.0), **other):
    pinion = spur_gear(18, module_m, bores_m[0], shifts[0])
    gear = spur_gear(47, module_m, bores_m[1], shifts[1])
    numbers = {"face_width_m": 20e-3, "youngs_modulus_pa": 206e9, "poisson_ratio": 0.3} | other
    return GearPair(pinion, gear, **numbers)


def bare(pair):
    """The pair as rings held in their bores: the gears of published tables and of finite elements."""
    return replace(pair, pinion=replace(pair.pinion, body_ratio=1.0), gear=replace(pair.gear, body_ratio=1.0))


def pit(height_mm=1.9, face_mm=10.0, a_mm=0.3, b_mm=0.2, depth_mm=0.4, floor="flat", gear="pinion", tooth=0):
    return FlankPit(gear, tooth, height_mm * 1e-3, face_mm * 1e-3, a_mm * 1e-3, b_mm * 1e-3, depth_mm * 1e-3, floor)


def layers(count, per_layer, step_face_mm=1.0, step_height_mm=0.4, height_mm=1.9, stagger_mm=0.0, **sizes):
    """Layers centred on a 20 mm face, further layers upwards; every second one moved by `stagger_mm`."""
    return tuple(
        pit(
            height_mm + layer * step_height_mm,
            10.0 + (i - 0.5 * (per_layer - 1)) * step_face_mm + (layer % 2) * stagger_mm,
            **sizes,
        )
        for layer in range(count)
        for i in range(per_layer)
    )


def even_places(planets: int) -> tuple[Fraction, ...]:
    """Return places of equally spaced planets in turns."""
    return tuple(Fraction(i, planets) for i in range(planets))
