"""What a table of one damaged state costs, and what fewer slices cost in force."""

from __future__ import annotations

from time import process_time

import numpy as np

from benchmarks.contact.case import FACE_M, spalled_face
from siggen.gears.contact.force_curve import force_curve
from siggen.gears.contact.newton_matrix import solver_room

APPROACHES_M = np.linspace(0.2e-6, 16e-6, 33)
NO_ENERGY = np.zeros((2, 0))
OFFSETS_M = np.linspace(-0.75e-3, 0.75e-3, 120)
SPALLS = {
    "1.2 x 11 mm, edges parallel": {},
    "1.2 x 11 mm, skewed and wavy": {"skew": 0.02, "wave_m": 0.08e-3},
    "through the face, edges parallel": {"whole": True},
    "through the face, skewed and wavy": {"whole": True, "skew": 0.02, "wave_m": 0.05e-3},
}


def table(slices: int, options: dict, tilt_rad: float = 0.0) -> tuple[np.ndarray, np.ndarray, float]:
    """Return forces and moments (120, 33) and the CPU time [s] of the solutions, without the geometry."""
    faces = [spalled_face(float(s), slices, **options) for s in OFFSETS_M]
    room = solver_room(slices)
    force_curve(faces[0], APPROACHES_M, tilt_rad, np.zeros(slices), room, NO_ENERGY)
    start = process_time()
    curves = [force_curve(face, APPROACHES_M, tilt_rad, np.zeros(slices), room, NO_ENERGY) for face in faces]
    cost = process_time() - start
    return np.array([c.force_n for c in curves]), np.array([c.moment_n_m for c in curves]), cost


def slice_errors(slices: int, options: dict, finest: int = 200) -> tuple[float, float, float]:
    """Return largest and rms error of the force and the largest of the moment against 200 slices.

    Over 1,200 N, and over 1,200 N on half the face; approaches up to 16 µm reach 3,000 N.
    """
    exact, fine, _ = table(finest, options)
    force, moment, _ = table(slices, options)
    error = (force - exact) / 1200.0
    turned = (moment - fine) / (1200.0 * 0.5 * FACE_M)
    return float(np.abs(error).max()), float(np.sqrt(np.mean(error**2))), float(np.abs(turned).max())
