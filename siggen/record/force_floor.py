"""Noise of forces in the mesh, at every bearing and of both machines, as spectra; independent of each other."""

from __future__ import annotations

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.config import Floor, constant
from siggen.record.background_course import Course
from siggen.sensing.force_density import rising_floor, tabulated
from siggen.sensing.modulation import level_course, shaft_course
from siggen.sensing.noise_spectrum import noise_spectrum
from siggen.sensing.spectral_filter import frequencies
from siggen.specimen.background import MACHINES, SHAFTS
from siggen.specimen.measured_path import INPUTS

PHASE_SPREAD = 0.1
"""Noise of one shaft's bearings rises at the same angle, within this share of a turn to either side."""


def floor_spectra(floor: Floor, course: Course) -> dict[str, ComplexArray]:
    """Return input -> spectrum (length // 2 + 1,) of its force; that of bearings is modulated by their shafts."""
    shape, depth = _shape(floor, course), constant(floor.shaft_depth)
    mesh = constant(floor.density_n_per_sqrt_hz)
    levels = {"mesh": mesh, **dict.fromkeys(INPUTS, mesh * constant(floor.elsewhere))}
    levels |= dict.fromkeys(MACHINES, constant(floor.machines_n_per_sqrt_hz))
    random = _random_levels(floor, course)
    found = {}
    for name, level in levels.items():
        rng = course.of_record(f"background.floor.{name}")
        spectrum = noise_spectrum(level, course.length, course.fs_hz, rng)
        shaft = name.partition("_")[0]
        if shaft in random:
            # before the shape: a level of milliseconds would spread its strong low frequencies over all others
            strength = _shaft_strength(floor, course, name, shaft) * random[shaft]
            found[name] = _modulated(spectrum, strength) * shape
        elif shaft in SHAFTS and depth > 0.0:
            found[name] = _modulated(spectrum * shape, _shaft_strength(floor, course, name, shaft))
        else:
            found[name] = spectrum * shape
    return found


def _shaft_strength(floor: Floor, course: Course, name: str, shaft: str) -> FloatArray:
    """Return the power (length,) of a bearing's noise over time, as its shaft turns; of mean 1."""
    turn = PHASE_SPREAD * (2.0 * course.uniform(f"background.floor.{name}.turn") - 1.0)
    return shaft_course([course.shaft_lines(shaft, constant(floor.shaft_depth), turn)])


def _modulated(spectrum: ComplexArray, strength: FloatArray) -> ComplexArray:
    return np.asarray(np.fft.rfft(np.sqrt(strength) * np.fft.irfft(spectrum, strength.size)))


def _random_levels(floor: Floor, course: Course) -> dict[str, FloatArray]:
    """Return shaft -> exp(s U - s²/2) (length,) of its bearings, of mean 1; none where s is 0."""
    std, memory = constant(floor.level_std), 1e-3 * constant(floor.level_time_ms) * course.fs_hz
    if std == 0.0:
        return {}
    draws = {shaft: course.of_record(f"background.floor.{shaft}.level") for shaft in SHAFTS}
    return {shaft: level_course(course.length, std, memory, rng) for shaft, rng in draws.items()}


def _shape(floor: Floor, course: Course) -> FloatArray:
    """Return how all densities run over frequency (k,), 1 above the low corner."""
    grid = frequencies(course.length, course.fs_hz)
    shape = rising_floor(grid, constant(floor.low_corner_hz), constant(floor.low_exponent))
    if floor.spectrum is not None:
        shape = shape * tabulated(grid, floor.spectrum.frequency_hz, floor.spectrum.density)
    return shape
