"""Noise of forces in the mesh, at every bearing and of both machines, in order; independent of each other."""

from __future__ import annotations

from collections.abc import Mapping

from siggen.arrays import FloatArray
from siggen.keys.number import constant
from siggen.record.background_course import Course
from siggen.sensing.modulation import LevelCourse, shaft_course
from siggen.specimen.background import MACHINES, SHAFTS
from siggen.specimen.background_numbers import FloorNumbers
from siggen.specimen.measured_path import INPUTS

PHASE_SPREAD = 0.1
"""Noise of one shaft's bearings rises at the same angle, within this share of a turn to either side."""


def floor_levels(floor: FloorNumbers) -> dict[str, float]:
    """Return input -> density [N/√Hz] above the low corner."""
    mesh = constant(floor.density_n_per_sqrt_hz)
    levels = {"mesh": mesh, **dict.fromkeys(INPUTS, mesh * constant(floor.elsewhere))}
    return levels | dict.fromkeys(MACHINES, constant(floor.machines_n_per_sqrt_hz))


def random_levels(floor: FloorNumbers, course: Course) -> dict[str, LevelCourse]:
    """Return shaft -> exp(s U - s²/2) of its bearings from the first sample on, of mean 1; none where s is 0."""
    std, memory = constant(floor.level_std), 1e-3 * constant(floor.level_time_ms) * course.fs_hz
    if std == 0.0:
        return {}
    return {shaft: LevelCourse(std, memory, course.of_record(f"background.floor.{shaft}.level")) for shaft in SHAFTS}


def bearing_strength(
    floor: FloorNumbers, course: Course, name: str, random: Mapping[str, FloatArray]
) -> FloatArray | None:
    """Return the power (length,) of a bearing's noise, of mean 1, by shaft and `random` level; None elsewhere."""
    shaft, depth = name.partition("_")[0], constant(floor.shaft_depth)
    if shaft not in SHAFTS or (shaft not in random and depth <= 0.0):
        return None
    turn = PHASE_SPREAD * (2.0 * course.uniform(f"background.floor.{name}.turn") - 1.0)
    strength = shaft_course([course.shaft_lines(shaft, depth, turn)])
    return strength * random[shaft] if shaft in random else strength
