"""Force of rough flanks along the line of action: n(t) √M(t) + bursts, part of n replayed by both gears.

A flank carries its roughness with it; the rolling speed u turns its waves into frequencies (derived):
S_F(f) = (k La^p)² S_z(f) |W(f)|², with k the mean stiffness of the mesh, La the share of the load on asperities,
S_z the profile's spectrum at f = u κ/2π, and W the mean over the contact's width. So both corners move with the speed,
and the film takes back a part. M of mean 1 by mesh, shafts and chance (`siggen.sensing.modulation`).
"""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt, tan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.gearbox.background import BurstLevels, RubbingLevels
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.mesh.asperities import rubbing_course
from siggen.names import Side
from siggen.record.background_course import BackgroundCourse, turning
from siggen.record.forced_ways import AXES, EVEN, MESH_STIFFNESS_PA, SET_MESHES
from siggen.record.friction import contact_half_width_m
from siggen.sensing.filters import frequencies
from siggen.sensing.modulation import LevelCourse, periodic_course, replayed, shaft_course
from siggen.sensing.noise import ShapedNoise, contact_bandwidth_hz, contact_filter, noise_spectrum, shape_taps

CONTACT_TAPS = 2048
"""Of the filter of both corners: at 51.2 kHz 25 Hz apart."""


class RubbingForce:
    """The force of one record from the first sample of `course` on, over `length` samples, and its labels."""

    def __init__(self, rubbing: RubbingLevels, course: BackgroundCourse, length: int) -> None:
        self._rubbing, spectrum = rubbing, force_spectrum(rubbing, course)
        taps = shape_taps(spectrum.density, CONTACT_TAPS, course.fs_hz)
        self._noise = ShapedNoise(taps, course.fs_hz, course.of_record("background.rubbing"))
        self._level = level_process(rubbing, course)
        self._share = rubbing.replayed_share
        self._patterns = {
            gear: gear_pattern(spectrum, course, gear, order)
            for gear, order in (course.gears.items() if self._share > 0.0 else ())
        }
        self._bursts = None if rubbing.bursts is None else drawn_bursts(rubbing.bursts, course, length)
        self._done = 0
        self._rms = spectrum.rms_n(0.5 * course.fs_hz)
        self.labels = rubbing_labels(rubbing, self._rms, course.asperity_share)
        if self._bursts is not None:
            self.labels["burst_count"] = self.burst_count

    @property
    def burst_count(self) -> int:
        """Bursts that begin within the record."""
        return 0 if self._bursts is None else self._bursts.recorded

    def take(self, course: BackgroundCourse) -> FloatArray:
        """Return the force (k,) [N] over the next samples, those of `course`."""
        noise = sqrt(1.0 - self._share) * self._noise.take(course.length)
        for gear, pattern in self._patterns.items():
            noise += sqrt(0.5 * self._share) * replayed(course.angle_rad, course.gears[gear], pattern)
        strength = np.sqrt(modulation(self._rubbing, course, self._level.take(course.length)))
        if self._bursts is not None:
            strength += burst_rise(self._bursts, self._done, course.length)
        self._done += course.length
        return np.asarray(noise * strength)


def rubbing_labels(rubbing: RubbingLevels, rms_n: float, asperity_share: float) -> dict[str, object]:
    """Return the labels but for bursts."""
    return {
        "rubbing_force_n": rms_n,
        "rubbing_asperity_share": asperity_share,
        "rubbing_level_std": rubbing.level_std,
        "rubbing_pinion_depth": rubbing.pinion_depth,
        "rubbing_gear_depth": rubbing.gear_depth,
    }


class ForceSpectrum(NamedTuple):
    """Force at no frequency [N] of all roughness, and where flanks' profile and contact cut [Hz]."""

    rough_n: float
    roll_off_hz: float
    hurst_exponent: float
    contact_hz: float

    def density(self, frequency_hz: FloatArray) -> FloatArray:
        """Return the one-sided density (k,) [N/√Hz]."""
        steepness = self.hurst_exponent + 0.5
        profile = contact_filter(frequency_hz, self.roll_off_hz, steepness)
        profile /= sqrt(contact_bandwidth_hz(self.roll_off_hz, steepness))
        # never 0, of which a filter of least phase has none: a film that parts the flanks leaves no asperity to rub
        return self.rough_n * profile * contact_filter(frequency_hz, self.contact_hz, 1.0) + 1e-30

    def rms_n(self, highest_hz: float) -> float:
        """Return the rms of what lies below a frequency."""
        frequency = np.linspace(0.0, highest_hz, 20_001)
        return float(np.sqrt(np.trapezoid(self.density(frequency) ** 2, frequency)))


def force_spectrum(rubbing: RubbingLevels, course: BackgroundCourse) -> ForceSpectrum:
    """Return the spectrum at the nominal speed and torque."""
    pair = course.pair
    stiffness = MESH_STIFFNESS_PA * pair.face_width_m
    averaged = max(pair.face_width_m / rubbing.correlation_m, 1.0)
    roughness_m = course.roughness_m / sqrt(averaged)
    # both flanks roll over the pitch point at R_b1 tan(α_w) Ω_1
    rolling_m_s = 2.0 * pi * course.point.speed_hz * pair.pinion.base_radius_m * tan(pair.working_pressure_angle_rad)
    return ForceSpectrum(
        rough_n=stiffness * roughness_m * course.asperity_share**rubbing.asperity_exponent,
        roll_off_hz=rolling_m_s / rubbing.roll_off_m,
        hurst_exponent=rubbing.hurst_exponent,
        contact_hz=rolling_m_s / (2.0 * pi * contact_half_width_m(pair, course.point)),
    )


def gear_pattern(spectrum: ForceSpectrum, course: BackgroundCourse, gear: Side, order: float) -> FloatArray:
    """Return what one gear replays over its revolution (points,), of the same density as n at the nominal speed.

    Four points per sample: read linearly between them, it is damped by 10 % at half the sampling rate at most.
    """
    shaft_hz = course.point.speed_hz * order
    top = int(0.5 * course.fs_hz / shaft_hz)
    points = 8 * (top + 1)
    rate_hz = points * shaft_hz
    waves = np.zeros(points // 2 + 1, dtype=np.complex128)
    waves[: top + 1] = noise_spectrum(
        1.0, 2 * top + 1, rate_hz, course.of_gearbox(f"background.rubbing.{gear}.pattern")
    ) * sqrt(points / (2 * top + 1))
    return np.asarray(np.fft.irfft(waves * spectrum.density(frequencies(points, rate_hz)), points))


def level_process(rubbing: RubbingLevels, course: BackgroundCourse) -> LevelCourse:
    """Return the random level, from the first sample on."""
    memory = rubbing.level_time_s * course.fs_hz
    return LevelCourse(rubbing.level_std, memory, course.of_record("background.rubbing.level"))


def modulation(rubbing: RubbingLevels, course: BackgroundCourse, level: FloatArray) -> FloatArray:
    """Return M (length,) of a random level (length,)."""
    table = rubbing_course(course.pair, rubbing.sliding_exponent)
    mesh = periodic_course(course.angle_rad, course.pair.pinion.teeth, table)
    depths = {Side.DRIVER: rubbing.pinion_depth, Side.DRIVEN: rubbing.gear_depth}
    shafts = [course.shaft_lines(gear, order, depths[gear]) for gear, order in course.gears.items()]
    return np.asarray(mesh * shaft_course(shafts) * level)


class DrawnBursts(NamedTuple):
    """First samples (bursts,), their peak and decay in samples, and how many begin within the record."""

    begin: NDArray[np.int64]
    peak: float
    decay: float
    recorded: int


def drawn_bursts(bursts: BurstLevels, course: BackgroundCourse, length: int) -> DrawnBursts:
    """Return the bursts of `length` samples from the first one of the course on."""
    rng = course.of_record("background.rubbing.bursts")
    count = int(rng.poisson(bursts.rate_hz * length / course.fs_hz))
    begin = np.floor(rng.random(count) * length).astype(np.int64)
    return DrawnBursts(begin, bursts.peak, bursts.decay_s * course.fs_hz, int((begin >= course.history).sum()))


def burst_rise(drawn: DrawnBursts, first: int, count: int) -> FloatArray:
    """Return the rise (count,) by all bursts from sample `first` on."""
    rise = np.zeros(count)
    for begin in drawn.begin:
        _add_burst(rise, begin - first, drawn.peak, drawn.decay)
    return rise


@entry(cache=True)
def _add_burst(rise: FloatArray, first: int, peak: float, memory: float) -> None:
    """Add peak e^(-i/memory) from sample `first` on, which may lie before the array, as long as it matters."""
    last = min(rise.size, first + int(memory * 12.0))
    for i in range(max(first, 0), last):
        rise[i] += peak * np.exp(-(i - first) / memory)


# Rubbing of a planetary set: each of its meshes by itself, and how all of them push as the carrier turns.
#
# Derived: what the mesh of a planet at the angle β in space does to a sensor at rest is a + b cos β + c sin β
# (`siggen.record.forced_ways.mesh_directions`), so all noises n_i together are three inputs, Σ n, Σ n cos β, Σ n sin
# β: planets pass. Sun, planets and ring turn against the carrier here. Roughness that gears replay is each mesh's own.


class SetRubbing:
    """The forces of one record from the first sample of `course` on, over `length` samples, and their labels."""

    def __init__(self, rubbing: RubbingLevels, course: BackgroundCourse, length: int, specimen: Specimen) -> None:
        planets = specimen.planets
        assert planets is not None
        teeth = planets.teeth
        self._carrier = float(teeth.carrier_turns)
        self._places = 2.0 * pi * np.array([float(place) for place in teeth.places])
        of_sun = planets.of_one_mesh(course.point)
        share = teeth.planet / teeth.sun
        of_planet = OperatingPoint(of_sun.speed_hz / share, of_sun.torque_nm * share)
        meshes = (planets.pair, of_sun, 1.0), (planets.ring, of_planet, 1.0 / share)
        self._meshes = dict(zip(SET_MESHES, meshes, strict=True))
        self._forces = {
            mesh: [RubbingForce(rubbing, self._own(course, mesh, i), length) for i in range(len(teeth.places))]
            for mesh in SET_MESHES
        }
        every = [force for forces in self._forces.values() for force in forces]
        self.labels = dict(every[0].labels)
        if rubbing.bursts is not None:
            self.labels["burst_count"] = sum(force.burst_count for force in every)

    def take(self, course: BackgroundCourse) -> dict[str, FloatArray]:
        """Return the next forces (k,) [N] by input of the background."""
        found: dict[str, FloatArray] = {}
        frame = self._carrier * course.angle_rad
        for mesh, forces in self._forces.items():
            noises = np.array([force.take(self._own(course, mesh, i)) for i, force in enumerate(forces)])
            angle = frame + self._places[:, None]
            found[f"{mesh}/{EVEN}"] = noises.sum(axis=0)
            for axis, wave in zip(AXES, (np.cos(angle), np.sin(angle)), strict=True):
                found[f"{mesh}/{axis}"] = (noises * wave).sum(axis=0)
        return found

    def _own(self, course: BackgroundCourse, mesh: str, planet: int) -> BackgroundCourse:
        """Return a course as one mesh has it: its driving gear turns against the carrier."""
        pair, point, turns = self._meshes[mesh]
        angle_rad = course.angle_rad * ((1.0 - self._carrier) * turns)
        return replace(
            course,
            angle_rad=angle_rad,
            turns=turning(angle_rad),
            shafts={},
            pair=pair,
            point=point,
            of_record=lambda name: course.of_record(f"{name}.{mesh}.{planet}"),
            of_gearbox=lambda name: course.of_gearbox(f"{name}.{mesh}.{planet}"),
        )
