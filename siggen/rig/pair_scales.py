"""PairScales: by how much the numbers of a gearbox change when it gets another gear pair.

Ratios of what `rig_numbers` gives for either pair, so that `siggen init` and a set of many pairs follow one rule. The
torque comes first: the one at which neither flank nor tooth root is stressed more than before (derived).
"""

from __future__ import annotations

from dataclasses import replace
from math import ceil
from typing import NamedTuple

from siggen.config import GearsSection, OperatingRange
from siggen.config.gears import PairSection
from siggen.keys.number import Number, at, bounds
from siggen.rig.rig import Rig, RigDesign
from siggen.rig.rig_numbers import rig_numbers
from siggen.rig.shafts import LARGEST_BORE, root_diameter_mm, shaft_end_mm

Two = tuple[float, float]


class PairScales(NamedTuple):
    """Factors; those that are two belong to pinion and gear, or to input and output.

    `gear_order` is that of the gear shaft's turns per turn of the pinion, `size` that of the centre distance, `load`
    that of the tooth force.
    """

    module: float
    face_width: float
    gear_order: float
    torque: float
    load: float
    size: float
    bore: Two
    mass: Two
    inertia: Two
    bearing: Two
    span: Two
    end_inertia: Two
    coupling: Two
    coupling_damping: Two


LEAST_TORQUE_NM = 0.01
"""Of a pair that only idles: its shafts are what makers leave, not what the torque needs."""


def pair_scales(gears: GearsSection, pair: PairSection, points: tuple[OperatingRange, ...]) -> PairScales:
    """Return the factors from the pair that a section `gears` describes to one of its `pairs`."""
    before = _rig(gears, points)
    torque = _torque_ratio(before, pair)
    torques = before.torque_nm[0] * torque, before.torque_nm[1] * torque
    sizes = {"teeth": pair.teeth, "module_mm": pair.module_mm, "face_width_mm": pair.face_width_mm}
    bare = replace(before, **sizes, torque_nm=torques, bores_mm=None)  # type: ignore[arg-type]
    after = replace(bare, bores_mm=_bores_mm(before, bare))
    return _ratios(before, after, torque)


def _ratios(before: Rig, after: Rig, torque: float) -> PairScales:
    old, new = rig_numbers(before), rig_numbers(after)

    def of_rotors(key: str) -> Two:
        first, second = (getattr(new.rotors[i], key) / getattr(old.rotors[i], key) for i in range(2))
        return first, second

    def of_shafts(key: str) -> Two:
        first, second = (getattr(new.rotors[i].shaft, key) / getattr(old.rotors[i].shaft, key) for i in range(2))
        return first, second

    return PairScales(
        after.module_mm / before.module_mm,
        after.face_width_mm / before.face_width_mm,
        after.teeth[0] / after.teeth[1] / (before.teeth[0] / before.teeth[1]),
        torque,
        new.load_share / old.load_share,
        new.scale / old.scale,
        of_shafts("bore_mm"),
        of_rotors("mass_kg"),
        of_rotors("inertia_kg_m2"),
        of_rotors("bearing_n_per_m"),
        of_shafts("span_mm"),
        (new.motor_inertia_kg_m2 / old.motor_inertia_kg_m2, new.load_inertia_kg_m2 / old.load_inertia_kg_m2),
        _each(new.coupling_nm_per_rad, old.coupling_nm_per_rad),
        _each(new.coupling_nm_s_per_rad, old.coupling_nm_s_per_rad),
    )


def _each(new: Two, old: Two) -> Two:
    return new[0] / old[0], new[1] / old[1]


def _rig(gears: GearsSection, points: tuple[OperatingRange, ...]) -> Rig:
    speeds = [speed for point in points for speed in bounds(point.speed_hz)]
    torques = [abs(torque) for point in points for torque in bounds(point.torque_nm)]
    return Rig(
        (gears.pinion.teeth, gears.gear.teeth),
        _median(gears.module_mm),
        _median(gears.face_width_mm),
        (min(speeds), max(speeds)),
        (min(torques), max(*torques, LEAST_TORQUE_NM)),
        pressure_angle_deg=_median(gears.pressure_angle_deg),
        bores_mm=(2.0 * _median(gears.pinion.bore_radius_mm), 2.0 * _median(gears.gear.bore_radius_mm)),
    )


def _median(number: Number) -> float:
    return at(number, 0.5)


def _torque_ratio(before: Rig, pair: PairSection) -> float:
    """Return the largest ratio at which neither stress grows.

    Contact: force/(b d1) (u + 1)/u; root: force/(b m), both by ISO 6336 without its factors, force = 2 T/d1.
    """
    first = _load_capacities(before.teeth, before.module_mm, before.face_width_mm)
    second = _load_capacities(pair.teeth, pair.module_mm, pair.face_width_mm)
    return min(new / old for new, old in zip(second, first, strict=True))


def _load_capacities(teeth: tuple[int, int], module_mm: float, width_mm: float) -> Two:
    """Return what the torque at equal contact stress, and at equal root stress, is proportional to [mm³]."""
    pitch_mm, ratio = module_mm * teeth[0], teeth[1] / teeth[0]
    return width_mm * pitch_mm**2 * ratio / (ratio + 1.0), width_mm * module_mm * pitch_mm


def _bores_mm(before: Rig, after: Rig) -> Two:
    """Return the bores as they are, times the ratio of shafts for either torque, at most 0.6 of the root circle."""
    given, torque = before.bores_mm or (), (before.torque_nm[1], after.torque_nm[1])
    found = []
    for i, bore in enumerate(given):
        old, new = (
            _shaft_mm(value * (rig.teeth[1] / rig.teeth[0] if i else 1.0), root_diameter_mm(rig, i))
            for rig, value in zip((before, after), torque, strict=True)
        )
        found.append(
            min(bore * new / old, max(LARGEST_BORE, bore / root_diameter_mm(before, i)) * root_diameter_mm(after, i))
        )
    return found[0], found[1]


def _shaft_mm(torque_nm: float, root_mm: float) -> float:
    """Return a shaft for the torque, in steps of 5 mm where it is that thick, at most 0.6 of the root circle [mm]."""
    needed = shaft_end_mm(torque_nm, root_mm, RigDesign())
    rounded = 5.0 * ceil(needed / 5.0) if needed > 10.0 else float(ceil(needed))
    return min(rounded, LARGEST_BORE * root_mm)
