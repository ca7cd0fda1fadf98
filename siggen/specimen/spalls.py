"""From a spall in the units of the configuration to the outline and depth on the flank of a drawn gear."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Spalls, SpallSize
from siggen.errors import Problem
from siggen.gears.damage.flank_damage import damage_problems
from siggen.gears.damage.outlines import Ellipse, Outline, Polygon, rectangle, v_outline
from siggen.gears.damage.spall import Spall, length_squared_depth_m
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.keys.drawing import corners, draw
from siggen.keys.number import at, bounds, constant
from siggen.keys.teeth import stage_of
from siggen.specimen.damage_kind import PROBE_M, DamageKind, allowed_text, in_mm
from siggen.specimen.gears import pit_height_m
from siggen.specimen.growth import MM, Growth

SIZE_KEYS = ("face_length_mm", "profile_length_mm", "lower_width_mm", "upper_width_mm", "depth_mm")
SPALL_KEYS = {
    "height_m": "centre_height_mm",
    "face_m": "face_centre_mm",
    "depth_m": "depth_mm",
    "vertices_m": "vertices",
}
"""Key of the configuration that a problem of a spall is about."""


def spall_on_tooth(pair: GearPair, size: SpallSize, reading: str, tooth: int) -> Spall:
    """Return a drawn spall on one tooth.

    Parameters
    ----------
    pair : GearPair
    size : SpallSize
        Without distributions.
    reading : str
        How its heights and its profile length are measured: 'axial', 'radial' or 'arc'.
    tooth : int

    Raises
    ------
    TypeError
        If a number is still a distribution.
    """
    gear = pair.member(size.gear)
    outline = _outline(pair, size, reading)
    if size.depth_law == "length_squared":
        # um/mm^2 is 1/m.
        depth_m = length_squared_depth_m(gear, outline, constant(size.depth_coefficient_um_per_mm2))
    else:
        depth_m = MM * _given(size.depth_mm)
    return Spall(size.gear, tooth, outline, depth_m, size.depth_law)


def _outline(pair: GearPair, size: SpallSize, reading: str) -> Outline:
    gear = pair.member(size.gear)
    if size.shape == "polygon":
        corners = [(axial_m(gear, MM * v.height_mm, reading), MM * v.face_mm) for v in size.vertices]
        return Polygon(tuple(corners))
    centre = size.centre_height_mm
    middle = pit_height_m(pair, size.gear, centre if isinstance(centre, str) else constant(centre), reading)
    along = read_m(gear, middle, reading)
    half = 0.5 * MM * _given(size.profile_length_mm)
    heights = axial_m(gear, along - half, reading), axial_m(gear, along + half, reading)
    face = 0.5 * pair.face_width_m if size.face_centre_mm is None else MM * constant(size.face_centre_mm)
    if size.shape == "v":
        return v_outline(heights, face, MM * _given(size.lower_width_mm), MM * _given(size.upper_width_mm))
    across = 0.5 * MM * _given(size.face_length_mm)
    if size.shape == "rectangle":
        return rectangle(heights, (face - across, face + across))
    # About the centre itself, not the middle of its ends: ellipses of one centre then hold each other.
    return Ellipse(middle, face, across, 0.5 * (heights[1] - heights[0]))


def _given(number: object) -> float:
    if not isinstance(number, float):
        raise TypeError(f"a drawn value was expected, received {number}")
    return number


def read_m(gear: SpurGear, height_m: float, reading: str) -> float:
    """Return the distance from the base circle of a flank point at an axial height, as a reading measures it [m]."""
    if reading == "axial":
        return height_m
    roll, base = float(gear.roll_at_height(height_m)), gear.base_radius_m
    return 0.5 * base * roll * roll if reading == "arc" else base * (math.hypot(1.0, roll) - 1.0)


def axial_m(gear: SpurGear, value_m: float, reading: str) -> float:
    """Return the axial height of one reading, as `axial_heights_m` [m]."""
    return float(axial_heights_m(gear, np.array(value_m), reading))


def axial_heights_m(gear: SpurGear, values_m: FloatArray, reading: str) -> FloatArray:
    """Return the axial heights of readings; below the base circle and above the tip along the flank's tangent [m].

    Any shape.

    Ends of damage that reach off the flank need a height, whatever is cut off there afterwards. Derived: dx/darc =
    cos(psi - alpha_2), dx/dR = cos(psi - alpha_2) sqrt(1 + psi^2)/psi (finite at the base circle only per arc, so a
    radial reading goes on below it as the arc does).
    """
    if reading == "axial":
        return values_m
    tip = read_m(gear, float(gear.height_m(gear.tip_roll_rad)), reading)
    ratio = np.clip(values_m, 0.0, tip) / gear.base_radius_m
    roll = np.sqrt(ratio * (ratio + 2.0)) if reading == "radial" else np.sqrt(2.0 * ratio)
    beyond = np.maximum(values_m - tip, 0.0) * math.cos(gear.tip_roll_rad - gear.base_half_angle_rad)
    below = values_m * math.cos(gear.base_half_angle_rad)
    return np.where(values_m < 0.0, below, gear.height_m(roll) + beyond)


def _spalls(model: Spalls, growth: Growth) -> Damage:
    """Return a spall on each damaged tooth, with the draws of the first spall that it has grown from."""
    uniform = growth.place(model.gear, Spalls)
    found = []
    for index, tooth in enumerate(growth.teeth(model)):
        name = f"spall.{model.gear}.{tooth}"
        stage = at(stage_of(model.stages, index), uniform(f"{name}.stages"))
        found.append(
            spall_on_tooth(growth.pair, _staged(draw(model, uniform, name), stage), model.height_reading, tooth)
        )
    return tuple(found)


def _staged(size: Spalls, stage: float) -> Spalls:
    """Return drawn sizes at a stage: all lengths and the depth shrink alike; a depth by length follows its own law."""
    given = {key: value for key in SIZE_KEYS if (value := getattr(size, key)) is not None}
    return size if stage == 1.0 else size.model_copy(update={key: stage * constant(v) for key, v in given.items()})


def spall_problems(pair: GearPair, size: SpallSize, reading: str, prefix: str = "") -> Iterator[Problem]:
    """Yield what is wrong with a spall by itself, at every combination of its bounds."""
    for corner in corners(size):
        spall = spall_on_tooth(pair, corner, reading, 0)
        for problem in damage_problems(pair, (spall,)):
            if problem.name != "contact":
                key = _spall_key(size, problem.name)
                yield Problem(prefix + key, in_mm(problem.received), allowed_text(problem.allowed))


def _spall_key(size: SpallSize, name: str) -> str:
    if size.shape == "polygon" and name in ("height_m", "face_m"):
        return "vertices"
    if name == "depth_m" and size.depth_law == "length_squared":
        return "depth_coefficient_um_per_mm2"
    return SPALL_KEYS.get(name, "profile_length_mm")


def largest_spall(pair: GearPair, size: SpallSize, reading: str, tooth: int) -> Spall:
    """Return a spall with all its sizes at their upper and its place at its lower bounds, without depth to speak of."""
    sizes = {key: value for key in SIZE_KEYS if (value := getattr(size, key)) is not None}
    largest = size.model_copy(update={key: bounds(value)[1] for key, value in sizes.items()})
    spall = spall_on_tooth(pair, next(corners(largest)), reading, tooth)
    return replace(spall, depth_m=PROBE_M)


SPALLS = DamageKind(
    _spalls,
    lambda pair, model: spall_problems(pair, model, model.height_reading),
    lambda pair, model: (largest_spall(pair, model, model.height_reading, 0),),
)
