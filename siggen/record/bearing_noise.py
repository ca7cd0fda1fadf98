"""Noise and lines of rolling bearings in one record: what moves in series with each bearing's spring, as velocities.

Waviness has a spectrum over the ring's angle. ISO 15242 measures it as rms velocities in three bands at 1,800 turns a
minute (reference: standard, limits from memory). Derived: at another speed Ω the same waves pass sooner, their
displacement S_e(f; Ω) = (Ω_0/Ω) S_e(f Ω_0/Ω; Ω_0), so their velocity S_v(f; Ω) = (Ω/Ω_0) S_v(f Ω_0/Ω; Ω_0). Between
the middles of the bands, and beyond them, densities are straight in log-log; above the last one they fall as 1/f.

As balls pass, a bearing gives way by a drawn size; one whose stiffness follows the load does so by `LoadedBearing`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from siggen.arrays import FloatArray
from siggen.drivetrain.bearings import LoadedBearing
from siggen.drivetrain.comb import Comb, harmonic_sum
from siggen.gearbox.background import BearingLevels
from siggen.gearbox.specimen import Specimen
from siggen.names import ShaftName
from siggen.record.background_course import BackgroundCourse
from siggen.record.structure import BEARINGS, cage_sense, specimen_bearings
from siggen.sensing.modulation import LevelCourse, shaft_course
from siggen.sensing.noise import ShapedNoise, shape_taps, tabulated

CLASS_SPEED_HZ = 30.0
BAND_EDGES_HZ = (50.0, 300.0, 1800.0, 10_000.0)
TAPS = 2048
PHASE_SPREAD = 0.1
"""Noise of one shaft's bearings rises at the same angle, within this share of a turn to either side."""
SLIP = (0.005, 0.02)
"""Share by which the cage lags (assumed)."""
PASSING_LINES = 3
"""Lines of passing balls, each half as large as the one before (assumed)."""
VARYING_LINES = 8
"""Of bearings under load: what balls do beyond has less than 1 % of its power (test)."""
AXES = ("horizontal", "vertical")
WEAKEST = 0.2
"""Displacements of passing balls lie between this share of the drawn one and all of it, by axis (assumed)."""


def velocity_density(levels: BearingLevels, shaft_hz: float, frequency_hz: FloatArray) -> FloatArray:
    """Return the one-sided density (k,) of a bearing's velocity at a speed of its shaft [m/s/√Hz]."""
    edges = np.array(BAND_EDGES_HZ)
    middles = np.sqrt(edges[:-1] * edges[1:])
    bands = np.array([levels.low_um_s, levels.middle_um_s, levels.high_um_s])
    velocity = 1e-6 * bands / np.sqrt(np.diff(edges))
    far = 1e3 * middles[-1]
    knots, values = np.append(middles, far), np.append(velocity, velocity[-1] * sqrt(middles[-1] / far))
    ratio = shaft_hz / CLASS_SPEED_HZ
    found = tabulated(frequency_hz / ratio, knots.tolist(), np.maximum(values, 1e-30).tolist())
    return np.asarray(sqrt(ratio) * found)


@dataclass(frozen=True, slots=True)
class _Seat:
    """A bearing along one of its axes."""

    named: ShaftName
    axis: str

    @property
    def shaft(self) -> str:
        """Its shaft, by its name in sections."""
        return self.named.inner

    @property
    def stream(self) -> str:
        """What its random numbers belong to."""
        return f"{self.named.bearing}/{self.axis}"


class BearingVelocities:
    """Velocities [m/s] of each bearing's waves, from the first sample of a course on; by input of the background."""

    def __init__(self, bearings: Mapping[str, BearingLevels], course: BackgroundCourse, specimen: Specimen) -> None:
        self._bearings = bearings
        loaded = specimen_bearings(specimen)
        self._sense = {shaft.value: cage_sense(shaft, housed=specimen.housed) for shaft in loaded}
        self._loaded = {shaft.value: one for shaft, one in loaded.items()}
        shafts = specimen.names.shafts
        self._seats = {f"{shaft.bearing}/{axis}": _Seat(shaft, axis) for shaft in shafts for axis in AXES[::-1]}
        taps = {shaft: _taps(levels, course, shaft) for shaft, levels in bearings.items()}
        self._noise = {
            name: ShapedNoise(taps[seat.shaft], course.fs_hz, course.of_record(f"background.bearings.{seat.stream}"))
            for name, seat in self._seats.items()
        }
        self._levels = {shaft: _level(shaft, levels, course) for shaft, levels in bearings.items()}
        self.labels = {f"bearing_velocity_{shaft}_um_s": levels.high_um_s for shaft, levels in bearings.items()}

    def take(self, course: BackgroundCourse) -> dict[str, FloatArray]:
        """Return the next velocities (k,) by input."""
        random = {shaft: level.take(course.length) for shaft, level in self._levels.items()}
        found = {}
        for name, noise in self._noise.items():
            seat = self._seats[name]
            strength = _strength(self._bearings[seat.shaft], course, seat) * random[seat.shaft]
            found[name] = noise.take(course.length) * np.sqrt(strength) + self._passing(seat, course)
        return found

    def _passing(self, seat: _Seat, course: BackgroundCourse) -> FloatArray:
        """Return the velocity (k,) of a displacement with every ball that passes the loaded side."""
        shaft = seat.shaft
        if shaft in self._loaded:
            return self._varying(seat, self._loaded[shaft], course)
        levels, path = self._bearings[shaft], f"background.bearings.{seat.stream}.passing"
        slip = SLIP[0] + (SLIP[1] - SLIP[0]) * course.of_record(f"background.bearings.{shaft}.slip").random()
        order = course.shafts[shaft] * levels.ball_pass_order * (1.0 - slip)
        size_m = levels.compliance_m * (WEAKEST + (1.0 - WEAKEST) * course.uniform(path))
        count = min(PASSING_LINES, int(course.top_order / order))
        if count == 0:
            return np.zeros(course.length)
        number = np.arange(1.0, count + 1.0)
        amplitude = size_m * np.power(0.5, number - 1.0) * 2.0 * pi * number * order * course.point.speed_hz
        phase = 2.0 * pi * course.of_record(path).random(PASSING_LINES)[:count]
        return Comb(order, amplitude, phase).force_n(course.turns(order))

    def _varying(self, seat: _Seat, loaded: LoadedBearing, course: BackgroundCourse) -> FloatArray:
        """Return the velocity (k,) of what lies in series with both bearings' spring as balls pass under their load.

        Its axes are tied: the spring along each of them gets what pushes as both do.
        """
        shaft = seat.shaft
        stiffness, row = loaded.stiffness_n_per_m, AXES.index(seat.axis)
        lines = (stiffness @ loaded.passing_lines_m(VARYING_LINES, self._sense[shaft]))[row] / stiffness[row, row]
        found = np.zeros(course.length)
        for end in "ab":
            rng = course.of_record(f"background.bearings.{shaft}.{end}.cage")
            slip = SLIP[0] + (SLIP[1] - SLIP[0]) * rng.random()
            order = course.shafts[shaft] * loaded.bearing.outer_order * (1.0 - slip)
            number = np.arange(1.0, 1.0 + min(VARYING_LINES, int(course.top_order / order)))
            rates = np.exp(2j * pi * rng.random() * number) * 2j * pi * number * order * course.point.speed_hz
            found += harmonic_sum(course.turns(order), lines[: number.size] * rates / BEARINGS)
        return found


def _taps(levels: BearingLevels, course: BackgroundCourse, shaft: str) -> FloatArray:
    shaft_hz = course.point.speed_hz * course.shafts[shaft]
    return shape_taps(lambda f: velocity_density(levels, shaft_hz, f), TAPS, course.fs_hz)


def _level(shaft: str, levels: BearingLevels, course: BackgroundCourse) -> LevelCourse:
    memory = levels.level_time_s * course.fs_hz
    rng = course.of_record(f"background.bearings.{shaft}.level")
    return LevelCourse(levels.level_std, memory, rng)


def _strength(levels: BearingLevels, course: BackgroundCourse, seat: _Seat) -> FloatArray:
    """Return the power (k,) of a bearing's noise, of mean 1, as its shaft turns."""
    turn = PHASE_SPREAD * (2.0 * course.uniform(f"background.bearings.{seat.stream}.turn") - 1.0)
    return shaft_course([course.shaft_lines(seat.shaft, course.shafts[seat.shaft], levels.shaft_depth, turn)])
