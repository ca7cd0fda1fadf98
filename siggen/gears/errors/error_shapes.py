"""ErrorShapes: how the errors of one gear run over its teeth and flanks, before they are scaled to a tolerance.

Derived, in the form usual for simulated gears. Cumulative pitch: two harmonics over the teeth, of
machines that index teeth one by one, and a random part; eccentricity goes on within a tooth and is kept apart. What
both make together is held to the limits, so no harmonic of a real gear counts twice. Profile: a slope,
since cutters and settings are wrong alike for all teeth, with a scatter of 10 % between them; a wave of a few cycles
with a phase of its own on every tooth; noise down to L/30 of the length L of the flank, where the profile filter of the
standard ends what is measured, and as smooth as that filter leaves it. Waves are freed of their straight line, as the
standard does before it calls the rest form.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.uniform_spline import UniformSpline

Draws = Callable[[str], np.random.Generator]
"""Generator that belongs to a name, so that a new name shifts no other draw."""

FLANK_POINTS = 241
"""Points from the root end to the tip of the active flank: 68 per cycle of the shortest usual wave."""
NOISE_POINTS = 61
"""Two per shortest wavelength that is measured, a thirtieth of the flank."""
NOISE_SHARE = 0.05
"""Standard deviation of the noise over the amplitude of the wave: 0.1 to 0.4 µm beside waves of 3 to 8 µm."""
HARMONICS = ((1, 1.0), (2, 0.5))
"""Orders of the indexing errors over a revolution, with the largest amplitude of each; the least is 30 % of it."""
RANDOM_PLACE = 0.15
"""Standard deviation of the random places beside them: single and cumulative pitch then come near their limits."""
TOOTH_SCATTER = 0.1
"""Relative standard deviation of slopes and waves between the teeth of a gear."""


@dataclass(frozen=True, slots=True)
class ErrorShapes:
    """Shapes without a scale, missing material positive.

    `phase_rad`: of the eccentricity; `pitch` (z,), of mean 0; `slope` (z,): change from root to tip; `form` (z,
    FLANK_POINTS): over the active flank, without mean and straight line.
    """

    phase_rad: float
    pitch: FloatArray
    slope: FloatArray
    form: FloatArray


def error_shapes(waves: FloatArray, draws: Draws) -> ErrorShapes:
    """Return the shapes of a gear.

    Parameters
    ----------
    waves : (z,)
        Cycles of the profile's wave on every tooth.
    draws : callable
        Gives a generator by name: eccentricity, pitch, slope, form.
    """
    teeth = waves.size
    return ErrorShapes(
        phase_rad=2.0 * np.pi * float(draws("eccentricity").random()),
        pitch=_pitch(teeth, draws("pitch")),
        slope=_slope(teeth, draws("slope")),
        form=_form(waves, draws("form")),
    )


def _pitch(teeth: int, rng: np.random.Generator) -> FloatArray:
    angle = 2.0 * np.pi * np.arange(teeth) / teeth
    shape = np.zeros(teeth)
    for order, weight in HARMONICS:
        shape += weight * rng.uniform(0.3, 1.0) * np.cos(order * angle + 2.0 * np.pi * rng.random())
    shape += RANDOM_PLACE * rng.standard_normal(teeth)
    return np.asarray(shape - shape.mean())


def _slope(teeth: int, rng: np.random.Generator) -> FloatArray:
    sign = 1.0 if rng.random() < 0.5 else -1.0
    return sign * (1.0 + TOOTH_SCATTER * rng.standard_normal(teeth))


def _form(waves: FloatArray, rng: np.random.Generator) -> FloatArray:
    place = np.linspace(0.0, 1.0, FLANK_POINTS)
    form, noise = np.empty((waves.size, FLANK_POINTS)), np.empty((NOISE_POINTS, waves.size))
    # Tooth by tooth, so that further teeth leave those before them as they are.
    for tooth, cycles in enumerate(waves):
        phase, amplitude = 2.0 * np.pi * rng.random(), 1.0 + TOOTH_SCATTER * rng.standard_normal()
        noise[:, tooth] = NOISE_SHARE * rng.standard_normal(NOISE_POINTS)
        form[tooth] = amplitude * np.sin(2.0 * np.pi * cycles * place + phase)
    return without_line(form + UniformSpline(0.0, 1.0 / (NOISE_POINTS - 1), noise)(place).T)


def without_line(profiles: FloatArray) -> FloatArray:
    """Return profiles (z, FLANK_POINTS) without mean and least-squares line."""
    level = profiles.mean(axis=1, keepdims=True)
    return np.asarray(profiles - level - slopes(profiles)[:, None] * _centred())


def slopes(profiles: FloatArray) -> FloatArray:
    """Return the change (z,) of the least-squares line of profiles (z, FLANK_POINTS) from root end to tip."""
    centred = _centred()
    return np.asarray(profiles @ centred / (centred @ centred))


def _centred() -> FloatArray:
    return np.linspace(-0.5, 0.5, FLANK_POINTS)
