"""A belt on one of the shafts: its force along the pull, over the course of one record.

Its passes make a comb at an order below that of the shaft; a pulley that runs out makes a line at the shaft's own. Both
are shares of the pull (derived: `siggen.specimen.background_numbers`), so they scale with it, and know no speed.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.drive.comb import Comb, turns_of
from siggen.keys.number import constant
from siggen.record.background_course import Course
from siggen.specimen.background_numbers import BeltNumbers


def belt_force(belt: BeltNumbers, course: Course) -> tuple[FloatArray, dict[str, object]]:
    """Return the force (length,) [N] on the shaft along the pull, without its mean, and labels."""
    own_order, pull_n = course.orders[belt.shaft], belt_pull_n(belt, course)
    order, share = constant(belt.order) * own_order, constant(belt.force_share)
    decibels = [0.0, *(constant(level) for level in (belt.second_db, belt.third_db, belt.fourth_db))]
    passes = pull_n * share * 10.0 ** (np.array(decibels) / 20.0)
    runout = pull_n * np.array([constant(belt.runout_share)])
    of_passes = Comb(order, passes, course.phases("belt.passes", passes.size))
    of_runout = Comb(own_order, runout, course.phases("belt.runout", 1))
    force = of_passes.force_n(turns_of(course.angle_rad, order), top_order=course.top_order)
    force += of_runout.force_n(course.turns[belt.shaft], top_order=course.top_order)
    labels = {"belt_order": order, "belt_pull_n": pull_n, "belt_force_n": float(passes[0])}
    return force, {**labels, "belt_runout_force_n": float(runout[0])}


def belt_pull_n(belt: BeltNumbers, course: Course) -> float:
    """Return the mean pull of both strands [N]: as given, or of a belt that is tensioned for the record's torque."""
    if belt.pull_n is not None:
        return constant(belt.pull_n)
    torque_nm = abs(course.point.torque_nm) / course.orders[belt.shaft]
    diameter_m = constant(belt.pulley_over_centres) * course.pair.working_centre_distance_m
    return constant(belt.pull_over_effective) * 2.0 * torque_nm / diameter_m
