"""Places and lengths on a flank: the keys that name them, their values on a drawn gear, and messages in mm."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Annotated, Literal, TypeAlias

import numpy as np
from pydantic import Field

from siggen.arrays import FloatArray
from siggen.damage.flank_damage import damage_problems
from siggen.damage.heights import axial_height
from siggen.damage.part import Damage
from siggen.errors import Problem
from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear
from siggen.keys.distributions import LogUniform, Uniform
from siggen.keys.number import Number, Within, at, bounds
from siggen.keys.scaling import Grows
from siggen.keys.section import Section
from siggen.keys.user_name import PART
from siggen.keys.usual import Usual
from siggen.keys.wording import AllowedText
from siggen.names import EITHER, SECTIONS, Side

GEAR_TEXT = AllowedText(
    "one of pinion, gear, either; of a machine the name of a gear, or MESH.either; of planetary sets sun, planet, ring",
    (*SECTIONS, EITHER, "sun", "planet", "ring"),
)
AnyGear: TypeAlias = Annotated[str, Field(pattern=rf"^{PART}(\.{PART})?$"), GEAR_TEXT]
"""`either`: drawn per gearbox, the same for all of its states."""

DAMAGED_GEAR = (
    "damaged gear: pinion, gear, either (drawn, not in lists); of a machine NAME or MESH.either; sun, ring, "
    "planet (the first)"
)

AXIAL, ARC = "axial", "arc"
"""How heights are measured: of pits along the tooth's axis, of spalls along the flank, as their profile lengths."""

MODULE, FACE_WIDTH, SKEW = "module", "face width", "module over face width"
"""What lengths of damage grow with, so that it takes the same share of the flank of another gear pair. Pits keep their
outline, so both of their axes grow with the module; an edge rises by the same share of a spall's length."""

Length = Annotated[Number, Within(above=0), Usual(0.01, 30), Grows(MODULE)]
OptionalLength = Annotated[Number | None, Within(above=0, words=(None,)), Usual(0.002, 30), Grows(MODULE)]
LengthAcross = Annotated[Number, Within(above=0), Usual(0.02, 300), Grows(FACE_WIDTH)]
Height = Annotated[Number | Literal["pitch"], Within(least=0, words=("pitch",)), Grows(MODULE)]
PlaceOnFace = Annotated[Number | None, Within(least=0, words=(None,)), Grows(FACE_WIDTH)]

FloorShape: TypeAlias = Literal["flat", "dish"]

MIDDLE_HEIGHT = (
    "of the middle above the base circle; below_pitch: half way from the lowest point of single contact to "
    "the pitch point"
)
FACE_CENTRE = "middle across the face; null: of the face"
LENGTHS = "length across the face, and along the profile; of irregular spalls the mean"
EDGE_RADIUS = "radius of the edges (default assumed)"
DEPTH = "normal to the tooth's middle plane; of irregular spalls null: 0.05 of the root of both lengths (assumed)"
FLOOR = "flat floor, or a dish that is deepest in the middle"

MM = 1e-3
PROBE_M = 1e-9
"""Size of a damage that is checked for its place alone."""

GO_ON = {"contact": ", or dynamics.mesh.law: pairs"}
"""What else to do about a problem, by its name."""


def height_m_of(pair: GearPair, side: Side, height_mm: float | str, reading: str) -> float:
    """Return the axial height above the base circle of a flank point given as in the configuration [m].

    Parameters
    ----------
    pair : GearPair
    side : Side
        Of which it is.
    height_mm : float or str
        Height as measured [mm], or 'pitch' for the pitch point of the mesh (roll angle tan(alpha_w), derived).
    reading : str
        'axial' or 'arc'.
    """
    gear = pair.member(side)
    if isinstance(height_mm, str):
        return float(gear.height_m(math.tan(pair.working_pressure_angle_rad)))
    return axial_height(gear, height_mm / 1e3, reading)


def heights_m(pair: GearPair, gear: Side, height_mm: Number | str, reading: str) -> list[float]:
    """Return the axial heights [m] at the bounds of a height as the configuration gives it."""
    if isinstance(height_mm, str):
        return [height_m_of(pair, gear, height_mm, reading)]
    return [height_m_of(pair, gear, value, reading) for value in dict.fromkeys(bounds(height_mm))]


def drawn_height_m(height_mm: Number | str, reading: str, pair: GearPair, side: Side, u: float) -> float:
    """Return the axial height [m] of a height as the configuration states it, drawn by the uniform `u`."""
    return height_m_of(pair, side, height_mm if isinstance(height_mm, str) else at(height_mm, u), reading)


def length_m(section: Section, key: str, uniform: Callable[[str], float]) -> float:
    """Return a length of a layout [m], drawn by the uniform of its key."""
    return MM * at(getattr(section, key), uniform(key))


def read_m(gear: SpurGear, height_m: float, reading: str) -> float:
    """Return the distance from the base circle of a flank point at an axial height, as a reading measures it [m]."""
    roll = float(gear.roll_at_height(height_m))
    return height_m if reading == AXIAL else 0.5 * gear.base_radius_m * roll * roll


def axial_m(gear: SpurGear, value_m: float, reading: str) -> float:
    """Return the axial height of one reading, as `axial_heights_m` [m]."""
    return float(axial_heights_m(gear, np.array(value_m), reading))


def axial_heights_m(gear: SpurGear, values_m: FloatArray, reading: str) -> FloatArray:
    """Return the axial heights of readings; below the base circle and above the tip along the flank's tangent [m].

    Any shape.

    Ends of damage that reach off the flank need a height, whatever is cut off there afterwards. Derived: dx/darc =
    cos(psi - alpha_2).
    """
    if reading == AXIAL:
        return values_m
    end = read_m(gear, float(gear.height_m(gear.last_roll_rad)), reading)
    roll = np.sqrt(2.0 * np.clip(values_m, 0.0, end) / gear.base_radius_m)
    beyond = np.maximum(values_m - end, 0.0) * math.cos(gear.last_roll_rad - gear.base_half_angle_rad)
    below = values_m * math.cos(gear.base_half_angle_rad)
    return np.where(values_m < 0.0, below, gear.height_m(roll) + beyond)


def found_problems(
    pair: GearPair, damage: Damage, path: str, remark: str = "", called: Sequence[str] = SECTIONS
) -> list[Problem]:
    """Return what is wrong with a damage as problems of one key; `called`: both gears in sentences."""
    return [
        Problem(path, f"{remark}{problem.received}", f"allowed: {problem.allowed}{GO_ON.get(problem.name, '')}")
        for problem in damage_problems(pair, damage, called)
    ]


def size_that_adds_nothing(own: Section, milder: object, sizes: Sequence[str]) -> str | None:
    """Return the first smaller size if none is larger than that of milder damage that is the same otherwise; else None.

    Both take their quantiles of one draw, so a range adds nothing if neither of its ends lies higher. Equal ones pass.
    """
    if not isinstance(milder, type(own)):
        return None
    same = all(getattr(own, key) == getattr(milder, key) for key in type(own).model_fields if key not in sizes)
    if not same or not all(_no_larger(getattr(own, key), getattr(milder, key)) for key in sizes):
        return None
    return next((key for key in sizes if getattr(own, key) != getattr(milder, key)), None)


def _no_larger(own: Number | None, milder: Number | None) -> bool:
    if own == milder:
        return True
    if own is None or milder is None:  # one follows from the others
        return False
    (low, high), (milder_low, milder_high) = bounds(own), bounds(milder)
    by_ends = type(own) is type(milder) and isinstance(own, (Uniform, LogUniform))
    return high <= milder_low or (by_ends and low <= milder_low and high <= milder_high)
