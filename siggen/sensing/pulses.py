"""Pulses: when the marks of a disc on a shaft pass, and the speed that a counter makes of their times.

An angle that is known at samples is a polynomial through `NODES` of them between two (Lagrange), so that vibration to a
sixth of the sampling rate is followed within 0.2 % of its amplitude (derived, tested). A counter knows the number of a
pulse and its time alone: between two pulses it takes the speed as even (reference: standard literature
on instantaneous angular speed, elapsed time).
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray

NODES = 8
"""Samples about an instant through which the angle is interpolated."""
ITERATIONS = 6
"""Of Newton's method with the slope of the sample; errors shrink by the curvature over it each time."""


def pulse_times(angle_rad: FloatArray, fs_hz: float, marks_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the numbers (p,) of the marks that pass in a record, and when (p,) [s].

    Parameters
    ----------
    angle_rad : (n,) of the shaft at the samples, the first at time 0; must rise throughout
    fs_hz : sampling rate
    marks_rad : (m,) places of the marks over one turn, rising, the last less than one turn behind the first

    Raises
    ------
    ValueError
        If the angle does not rise, or has less than `NODES` samples.
    """
    if angle_rad.size < NODES or not (np.diff(angle_rad) > 0.0).all():
        raise ValueError(f"angle_rad: received one that turns back or is too short; allowed: {NODES} samples, rising")
    turn, count = 2.0 * np.pi, marks_rad.size
    first_turn, last_turn = (int(np.floor(angle_rad[end] / turn)) + beyond for end, beyond in ((0, -1), (-1, 2)))
    numbers = np.arange(first_turn * count, last_turn * count)
    places = marks_rad[numbers % count] + (numbers // count) * turn
    inside = (places >= angle_rad[0]) & (places <= angle_rad[-1])
    numbers, places = numbers[inside], places[inside]
    sample = np.clip(np.searchsorted(angle_rad, places, side="right") - 1, 0, angle_rad.size - 2)
    slope = angle_rad[sample + 1] - angle_rad[sample]
    instants = sample + (places - angle_rad[sample]) / slope
    for _ in range(ITERATIONS):
        instants -= (interpolated(angle_rad, instants) - places) / slope
    return numbers, instants / fs_hz


def interpolated(values: FloatArray, instants: FloatArray) -> FloatArray:
    """Return values (n,) at instants (p,) in samples, through the `NODES` samples about each (Lagrange)."""
    first = np.clip(np.floor(instants).astype(np.int64) - NODES // 2 + 1, 0, values.size - NODES)
    within = instants - first
    result = np.zeros(instants.size)
    for node in range(NODES):
        weight = np.ones(instants.size)
        for other in range(NODES):
            if other != node:
                weight *= (within - other) / (node - other)
        result += weight * values[first + node]
    return result


def counted_speed(numbers: FloatArray, times_s: FloatArray, per_turn: int, fs_hz: float, samples: int) -> FloatArray:
    """Return the mean speed (samples,) [rad/s] over the sampling interval about each sample.

    So its sum over the samples, over fs, is the angle. Outside of the pulses the speed of the nearest two goes on.

    Parameters
    ----------
    numbers : (p,) of the pulses, p at least 2
    times_s : (p,) as counted
    per_turn : pulses per turn
    fs_hz, samples : of the record
    """
    angle = 2.0 * np.pi / per_turn * (numbers - numbers[0])
    edges = (np.arange(samples + 1) - 0.5) / fs_hz
    at_edges = np.interp(edges, times_s, angle)
    for end, beyond in ((0, edges < times_s[0]), (-1, edges > times_s[-1])):
        near = slice(0, 2) if end == 0 else slice(-2, None)
        (t_0, t_1), (a_0, a_1) = times_s[near], angle[near]
        at_edges[beyond] = angle[end] + (edges[beyond] - times_s[end]) * (a_1 - a_0) / (t_1 - t_0)
    return np.asarray(np.diff(at_edges) * fs_hz)


def disc_marks(per_turn: int, pitch_errors: FloatArray, eccentricity_rad: float, phase_rad: float) -> FloatArray:
    """Return the places (per_turn,) [rad] of a disc's marks, each with its own error, and all with its eccentricity.

    A disc whose middle lies e off the shaft's axis shows an angle that is e/r sin(θ + φ) off at the radius r.

    Parameters
    ----------
    per_turn : pulses per turn
    pitch_errors : (per_turn,) over the pitch
    eccentricity_rad : e/r
    phase_rad : φ
    """
    even = 2.0 * np.pi / per_turn * np.arange(per_turn)
    return np.asarray(even + 2.0 * np.pi / per_turn * pitch_errors + eccentricity_rad * np.sin(even + phase_rad))
