"""Ways to get force and moment in the time loop: error and cost of each against the solver itself.

The face: a spall of 1.2 x 11 mm, 2.5 mm off the middle, with skewed and wavy edges; 31 positions, approaches between 2
and 15 µm at random, about a loaded tilt of 0.05 mrad. Errors count over 1,200 N, and over 1,200 N on half the face.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from time import process_time

import numpy as np
from numba import njit
from scipy.interpolate import CubicHermiteSpline

from benchmarks.contact.case import FACE_M, spalled_face
from benchmarks.contact.cost import NO_ENERGY, SPALLS
from siggen.gears.contact.face_force import face_force
from siggen.gears.contact.face_slices import FaceSlices
from siggen.gears.contact.force_curve import ForceCurve, force_curve
from siggen.gears.contact.newton_matrix import SolverRoom, solver_room
from siggen.gears.contact.stored_energy import energy_nodes

SLICES, PLACE_M, TILT_RAD = 80, 2.5e-3, 0.05e-3
REFERENCE_M = 7e-6
NODES = energy_nodes()


@dataclass(frozen=True, slots=True)
class Option:
    """Errors of one way: largest and rms of the force and of the moment."""

    name: str
    force_largest: float
    force_rms: float
    moment_largest: float
    moment_rms: float


def options() -> Iterator[Option]:
    """Yield the errors of every way."""
    faces = [spalled_face(float(s), SLICES, **_SHAPE) for s in np.linspace(-0.75e-3, 0.75e-3, 31)]
    approach = np.sort(np.random.default_rng(0).uniform(2e-6, 15e-6, 60))
    exact = [_curve(f, approach, TILT_RAD) for f in faces]
    yield from _approach_axis(faces, approach, exact)
    yield from _tilt_axis(faces, approach, exact)
    yield from _expansion(faces, approach)


_SHAPE = {"skew": 0.02, "wave_m": 0.08e-3, "place_m": PLACE_M}


def _curve(face: FaceSlices, approach: np.ndarray, tilt: float) -> ForceCurve:
    return force_curve(face, approach, tilt, np.zeros(SLICES), solver_room(SLICES), NODES)


def _option(name: str, found: list[tuple[np.ndarray, np.ndarray]], exact: list[ForceCurve]) -> Option:
    force = np.array([f - e.force_n for (f, _), e in zip(found, exact, strict=True)]) / 1200.0
    moment = np.array([m - e.moment_n_m for (_, m), e in zip(found, exact, strict=True)]) / (600.0 * FACE_M)
    sizes = [(float(np.abs(e).max()), float(np.sqrt(np.mean(e**2)))) for e in (force, moment)]
    return Option(name, *sizes[0], *sizes[1])


def _approach_axis(faces: list[FaceSlices], approach: np.ndarray, exact: list[ForceCurve]) -> Iterator[Option]:
    for count in (33, 17, 9):
        nodes = np.linspace(0.0, 16e-6, count)
        curves = [_curve(f, nodes, TILT_RAD) for f in faces]
        linear = [(np.interp(approach, nodes, c.force_n), np.interp(approach, nodes, c.moment_n_m)) for c in curves]
        yield _option(f"table, linear over {count} approaches", linear, exact)
        cubic = [
            (
                CubicHermiteSpline(nodes, c.force_n, c.stiffness_n_per_m)(approach),
                CubicHermiteSpline(nodes, c.moment_n_m, c.turning_n)(approach),
            )
            for c in curves
        ]
        yield _option(f"table, cubic with slopes over {count} approaches", cubic, exact)


def _tilt_axis(faces: list[FaceSlices], approach: np.ndarray, exact: list[ForceCurve]) -> Iterator[Option]:
    """Yield errors between two tilts, of F and M one by one, and of both from one energy (a quarter of the way)."""
    for spacing in (0.1e-3, 0.05e-3, 0.025e-3):
        low, high = (TILT_RAD - 0.25 * spacing, TILT_RAD + 0.75 * spacing)
        ends = [(_curve(f, approach, low), _curve(f, approach, high)) for f in faces]
        linear = [(0.75 * a.force_n + 0.25 * b.force_n, 0.75 * a.moment_n_m + 0.25 * b.moment_n_m) for a, b in ends]
        yield _option(f"tilt axis, linear, every {1e3 * spacing:g} mrad", linear, exact)
        energy = []
        for a, b in ends:
            force = CubicHermiteSpline([low, high], [a.force_n, b.force_n], [a.turning_n, b.turning_n])
            stored = CubicHermiteSpline([low, high], [a.energy_j, b.energy_j], [a.moment_n_m, b.moment_n_m])
            energy.append((force(TILT_RAD), stored.derivative()(TILT_RAD)))
        yield _option(f"tilt axis, one energy, every {1e3 * spacing:g} mrad", energy, exact)


def _expansion(faces: list[FaceSlices], approach: np.ndarray) -> Iterator[Option]:
    """Yield errors of W to the second order about the loaded tilt, fitted at three tilts 0.03 mrad apart."""
    step = 0.03e-3
    three = [[_curve(f, approach, TILT_RAD + k * step) for k in (-1, 0, 1)] for f in faces]
    for away in (0.01e-3, 0.02e-3, 0.05e-3, 0.1e-3):
        found, exact = [], []
        for side in (away, -away):
            for (low, here, high), face in zip(three, faces, strict=True):
                x = side / step
                bend = high.force_n - 2.0 * here.force_n + low.force_n
                force = here.force_n + 0.5 * x * (high.force_n - low.force_n) + 0.5 * x * x * bend
                moment = here.moment_n_m + 0.5 * x * (high.moment_n_m - low.moment_n_m)
                found.append((force, moment))
                exact.append(_curve(face, approach, TILT_RAD + side))
        yield _option(f"expansion about the loaded tilt, {1e3 * away:g} mrad away", found, exact)


def position_errors() -> Iterator[tuple[str, float, float, float]]:
    """Yield spall, spacing [m], largest and rms error of F over 1,200 N midway between two positions, linear."""
    approach = np.linspace(2e-6, 15e-6, 14)
    for name, shape in SPALLS.items():
        for spacing in (25e-6, 12.5e-6, 6.25e-6):
            # a spacing that shares no multiple with the spall's length
            middle = np.arange(-0.75e-3, 0.75e-3, 37e-6)
            low, here, high = (
                np.array([_force(float(s + k * 0.5 * spacing), shape, approach) for s in middle]) for k in (-1, 0, 1)
            )
            error = (0.5 * (low + high) - here) / 1200.0
            yield name, spacing, float(np.abs(error).max()), float(np.sqrt(np.mean(error**2)))


def _force(offset: float, shape: dict, approach: np.ndarray) -> np.ndarray:
    return _curve(spalled_face(offset, SLICES, **shape), approach, 0.0).force_n


@njit
def _walk(face: FaceSlices, approach: np.ndarray, tilt: np.ndarray, loads: np.ndarray, room: SolverRoom) -> float:
    total = 0.0
    for j in range(approach.size):
        total += face_force(face, approach[j], tilt[j], loads, room, 1e-3).force_n
    return total


def direct_cost(slices: int, steps: int = 4000) -> float:
    """Return the CPU time [s] of one force from the solver itself, step by step along a vibration."""
    face, time = spalled_face(0.3e-3, slices, **_SHAPE), np.arange(steps)
    approach, tilt = REFERENCE_M + 1.5e-6 * np.sin(time / 40.0), TILT_RAD + 0.02e-3 * np.sin(time / 57.0)
    loads, room = np.zeros(slices), solver_room(slices)
    _walk(face, approach[:5], tilt[:5], loads, room)
    start = process_time()
    _walk(face, approach, tilt, loads, room)
    return (process_time() - start) / steps


def tilt_table_cost(approaches: int = 17, tilts: int = 5, positions: int = 120) -> float:
    """Return the CPU time [s] of a table of energy, force, moment and dM/dd over position, approach and tilt."""
    faces = [spalled_face(float(s), SLICES, **_SHAPE) for s in np.linspace(-0.75e-3, 0.75e-3, positions)]
    nodes, angles = np.linspace(0.0, 16e-6, approaches), np.linspace(-0.05e-3, 0.15e-3, tilts)
    _curve(faces[0], nodes, 0.0)
    start = process_time()
    for face in faces:
        for tilt in angles:
            _curve(face, nodes, tilt)
    return process_time() - start


def approach_table_cost(approaches: int, slices: int = SLICES, positions: int = 120) -> float:
    """Return the CPU time [s] of a table at one tilt, without energies."""
    faces = [spalled_face(float(s), slices, **_SHAPE) for s in np.linspace(-0.75e-3, 0.75e-3, positions)]
    nodes, room = np.linspace(0.0, 16e-6, approaches), solver_room(slices)
    force_curve(faces[0], nodes, TILT_RAD, np.zeros(slices), room, NO_ENERGY)
    start = process_time()
    for face in faces:
        force_curve(face, nodes, TILT_RAD, np.zeros(slices), room, NO_ENERGY)
    return process_time() - start
