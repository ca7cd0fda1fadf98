"""From a spall in the units of the configuration to the outline and depth on the flank of a drawn gear."""

from __future__ import annotations

import math

from siggen.config import SpallSize, constant
from siggen.gears.damage.flank_damage import Spall, length_squared_depth_m
from siggen.gears.damage.outlines import Ellipse, Outline, Polygon, rectangle, v_outline
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.specimen.gears import pit_height_m

MM = 1e-3


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
        corners = [(_axial_m(gear, MM * v.height_mm, reading), MM * v.face_mm) for v in size.vertices]
        return Polygon(tuple(corners))
    centre = size.centre_height_mm
    middle = pit_height_m(pair, size.gear, centre if isinstance(centre, str) else constant(centre), reading)
    along = _read_m(gear, middle, reading)
    half = 0.5 * MM * _given(size.profile_length_mm)
    heights = _axial_m(gear, along - half, reading), _axial_m(gear, along + half, reading)
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


def _read_m(gear: SpurGear, height_m: float, reading: str) -> float:
    """Return the distance from the base circle of a flank point at an axial height, as a reading measures it [m]."""
    if reading == "axial":
        return height_m
    roll, base = float(gear.roll_at_height(height_m)), gear.base_radius_m
    return 0.5 * base * roll * roll if reading == "arc" else base * (math.hypot(1.0, roll) - 1.0)


def _axial_m(gear: SpurGear, value_m: float, reading: str) -> float:
    """Return the axial height of a reading; below the base circle and above the tip along the flank's tangent [m].

    Ends of damage that reach off the flank need a height, whatever is cut off there afterwards. Derived: dx/darc =
    cos(psi - alpha_2), dx/dR = cos(psi - alpha_2) sqrt(1 + psi^2)/psi (finite at the base circle only per arc, so a
    radial reading goes on below it as the arc does).
    """
    if reading == "axial":
        return value_m
    tip = _read_m(gear, float(gear.height_m(gear.tip_roll_rad)), reading)
    if value_m < 0.0:
        return value_m * math.cos(gear.base_half_angle_rad)
    ratio = min(value_m, tip) / gear.base_radius_m
    roll = math.sqrt(ratio * (ratio + 2.0)) if reading == "radial" else math.sqrt(2.0 * ratio)
    return float(gear.height_m(roll)) + max(value_m - tip, 0.0) * math.cos(gear.tip_roll_rad - gear.base_half_angle_rad)
