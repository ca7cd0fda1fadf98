"""What a table of one damaged state costs, and what fewer slices cost in force."""

from __future__ import annotations

from math import radians
from time import process_time

import numpy as np

from benchmarks.contact.case import FACE_M, REST_M_PER_N, spalled_face
from siggen.gears.contact.face_gaps import face_gaps
from siggen.gears.contact.force_curve import force_curve
from siggen.gears.contact.newton_matrix import solver_room
from siggen.gears.contact.pair_faces import FaceOptions, pair_faces
from siggen.gears.contact.pair_rest import rigid_rest
from siggen.gears.damage.flank_chords import flank_chords
from siggen.gears.damage.outlines import Polygon
from siggen.gears.damage.spall import Spall
from siggen.gears.geometry.gear_pair import GearPair, SpurGear

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


def state_cost(slices: int = 100, approaches: int = 9, positions: int = 120) -> tuple[float, float]:
    """Return the CPU time [s] of geometry and of solutions for a skewed spall over the whole path of contact."""
    gears = [SpurGear(z, 3e-3, radians(20.0), 0.0, 1.0, 0.25, b) for z, b in ((18, 12.5e-3), (47, 20e-3))]
    pair = GearPair(gears[0], gears[1], face_width_m=FACE_M, youngs_modulus_pa=206e9, poisson_ratio=0.3)
    spall = Spall("pinion", 0, Polygon(((1.5e-3, 4e-3), (1.7e-3, 15e-3), (2.6e-3, 15e-3), (2.3e-3, 4e-3))), 0.2e-3)
    position, nodes = (
        np.linspace(pair.contact_start_m, pair.contact_end_m, positions),
        np.linspace(0, 16e-6, approaches),
    )
    spent = []
    for _ in range(4):
        start = process_time()
        flanks = (flank_chords(g, d, FACE_M, slices) for g, d in ((pair.pinion, (spall,)), (pair.gear, ())))
        gaps = face_gaps(pair, *flanks, position)
        faces = pair_faces(
            pair, gaps, position, rigid_rest(np.full(positions, REST_M_PER_N)), FaceOptions(60e3, 0.05e-3)
        )
        middle = process_time()
        for face in faces:
            force_curve(face, nodes, 0.0, np.zeros(slices), solver_room(slices), NO_ENERGY)
        spent.append((middle - start, process_time() - middle))
    # the first round compiles
    return min(s[0] for s in spent[1:]), min(s[1] for s in spent[1:])
