"""Bearings of a drawn specimen under the mean load of its operating point: where a shaft gives their `geometry`.

Teeth press along the line of action, under a torque below 0 along that of the back flanks; gears and shafts weigh. Each
of the two bearings of a shaft bears half. Vibration about that load is small: bearings are linear about it.
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, sin

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.bearings.loaded_bearing import LoadedBearing, loaded_bearing
from siggen.dynamics.structure.gear_stage import GearStage, Rotor
from siggen.gearbox.specimen import PairTrain
from siggen.gears.geometry.gear_pair import GearPair
from siggen.names import Side

BEARINGS = 2
"""Of a shaft: each bears half of the force and has half of their stiffness."""
GRAVITY_M_S2 = 9.81


def loaded_bearings(train: PairTrain, pair: GearPair, torque_nm: float, *, housed: bool) -> dict[Side, LoadedBearing]:
    """Return one of both bearings of each shaft whose stiffness follows the load, under a torque on the pinion."""
    found = {}
    for side, ball_bearing in train.balls:
        mass_kg = getattr(train.first, side).mass_kg
        force_n = shaft_load_n(pair, side, torque_nm, mass_kg, housed=housed)
        found[side] = loaded_bearing(ball_bearing, force_n / BEARINGS)
    return found


def shaft_load_n(pair: GearPair, side: Side, torque_nm: float, mass_kg: float, *, housed: bool) -> FloatArray:
    """Return the mean force (2,) on a shaft, horizontal and upward [N]: of the teeth and of its weight."""
    angle, force_n = pair.working_pressure_angle_rad, torque_nm / pair.pinion.base_radius_m
    # Horizontal runs from the gear to the pinion in a casing, else back. Either flank pushes the gears apart.
    apart = 1.0 if housed else -1.0
    on_pinion = np.array([apart * sin(angle) * abs(force_n), -cos(angle) * force_n])
    return np.asarray((on_pinion if side == Side.DRIVER else -on_pinion) - np.array([0.0, mass_kg * GRAVITY_M_S2]))


def cage_sense(side: Side, *, housed: bool) -> float:
    """Return 1 where a shaft turns from horizontal to upward, -1 where back: the pinion's mesh goes up, beside it."""
    pinion = -1.0 if housed else 1.0
    return pinion if side == Side.DRIVER else -pinion


def on_loaded_bearings(stage: GearStage, found: dict[Side, LoadedBearing]) -> GearStage:
    """Return a stage on bearings under load."""
    rotors = {Side.DRIVER: stage.pinion, Side.DRIVEN: stage.gear}
    rotors |= {side: on_loaded_bearing(rotors[side], one) for side, one in found.items()}
    return replace(stage, pinion=rotors[Side.DRIVER], gear=rotors[Side.DRIVEN])


def on_loaded_bearing(rotor: Rotor, one: LoadedBearing) -> Rotor:
    """Return a gear on two bearings under load."""
    stiffness = BEARINGS * one.stiffness_n_per_m
    x, xy, y = float(stiffness[0, 0]), float(stiffness[0, 1]), float(stiffness[1, 1])
    numbers = replace(rotor.bearing, stiffness_x_n_per_m=x, stiffness_y_n_per_m=y, stiffness_xy_n_per_m=xy)
    if (time_s := numbers.damping_time_s) is not None:
        numbers = replace(numbers, damping_x_n_s_per_m=time_s * x, damping_y_n_s_per_m=time_s * y)
    return replace(rotor, bearing=numbers)
