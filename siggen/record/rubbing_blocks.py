"""Rubbing force block after block: the model of `rubbing`, its noise behind a filter of 1024 taps."""

from __future__ import annotations

from math import sqrt

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Background, Rubbing, constant
from siggen.record.background_course import Course
from siggen.record.rubbing import (
    burst_rise,
    drawn_bursts,
    force_size_n,
    level_process,
    modulation,
    rubbing_labels,
    shaft_pattern,
)
from siggen.sensing.force_density import contact_bandwidth_hz, contact_filter
from siggen.sensing.modulation import replayed
from siggen.sensing.shaped_noise import ShapedNoise, shape_taps

CONTACT_TAPS = 1024
"""Of the contact's filter, whose corner lies in the kilohertz: at 25.6 kHz 40 ms."""


class RubbingForce:
    """The force of one record from the first sample of `course` on, over `length` samples, and its labels."""

    def __init__(self, section: Background, rubbing: Rubbing, course: Course, length: int) -> None:
        self._rubbing, self._size = rubbing, force_size_n(section, rubbing, course)
        corner_hz, steepness = constant(rubbing.corner_hz), constant(rubbing.steepness)
        unit = 1.0 / sqrt(contact_bandwidth_hz(corner_hz, steepness))
        taps = shape_taps(lambda f: unit * contact_filter(f, corner_hz, steepness), CONTACT_TAPS, course.fs_hz)
        self._noise = ShapedNoise(taps, course.fs_hz, course.of_record("background.rubbing"))
        self._level = level_process(rubbing, course)
        self._share = constant(rubbing.replayed_share)
        self._patterns = {
            shaft: shaft_pattern(corner_hz, steepness, course, shaft, order)
            for shaft, order in (course.orders.items() if self._share > 0.0 else ())
        }
        self._bursts = None if rubbing.bursts is None else drawn_bursts(rubbing.bursts, course, length)
        self._done = 0
        self.labels = rubbing_labels(rubbing, self._size)
        if self._bursts is not None:
            self.labels["burst_count"] = self._bursts.recorded

    def take(self, course: Course) -> FloatArray:
        """Return the force (k,) [N] over the next samples, those of `course`."""
        noise = sqrt(1.0 - self._share) * self._noise.take(course.length)
        for shaft, pattern in self._patterns.items():
            noise += sqrt(0.5 * self._share) * replayed(course.angle_rad, course.orders[shaft], pattern)
        strength = np.sqrt(modulation(self._rubbing, course, self._level.take(course.length)))
        if self._bursts is not None:
            strength += burst_rise(self._bursts, self._done, course.length)
        self._done += course.length
        return np.asarray(self._size * noise * strength)
