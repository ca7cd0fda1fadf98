"""Logarithm and tangent of lanes: near the true values, with the bytes that the same functions of numbers give."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.lanes import LANES, hyperbolic_tangent, load, logarithm, store


@entry(error_model="numpy")
def of_lanes(loads: FloatArray, speeds: FloatArray, found: FloatArray) -> None:
    for i in range(0, loads.size, LANES):
        store(found, i, logarithm(load(loads, i)))
        store(found, loads.size + i, hyperbolic_tangent(load(speeds, i)))


@entry(error_model="numpy")
def of_numbers(loads: FloatArray, speeds: FloatArray, found: FloatArray) -> None:
    for i in range(loads.size):
        found[0, i], found[1, i] = logarithm(loads[i]), hyperbolic_tangent(speeds[i])


def test_logarithm_and_tangent_are_true_to_rounding_in_lanes_as_alone() -> None:
    rng, count = np.random.default_rng(1), 80_000
    loads = np.exp(rng.uniform(-20.0, 60.0, count))
    loads[::2] = 1.0 + 10.0 ** rng.uniform(-15.0, 0.0, count // 2)
    speeds = rng.uniform(-25.0, 25.0, count)
    speeds[::2] = 10.0 ** rng.uniform(-12.0, 1.0, count // 2)
    speeds[:LANES], loads[:3] = (0.0, -0.0, 1e300, -np.inf, 20.0, -20.0, 19.9, 1e-300), (1.0, 2.0, 0.5)
    lanes, numbers = np.empty((2, count)), np.empty((2, count))
    of_lanes(loads, speeds, lanes)
    of_numbers(loads, speeds, numbers)
    assert lanes.tobytes() == numbers.tobytes()
    true = np.log(loads)
    assert (np.abs(lanes[0] - true) <= 2.0 * np.spacing(np.abs(true))).all()
    # of the friction, which is multiplied by it, a rounding of 1
    assert np.abs(lanes[1] - np.tanh(speeds)).max() <= 4e-16
