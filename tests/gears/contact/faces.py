"""Faces with gaps that the tests of the solver share: teeth 18/47 of module 3 mm at the pitch point, 20 mm wide."""

from __future__ import annotations

from math import pi

import numpy as np

from siggen.mesh.contact_edges import NO_EDGE
from siggen.mesh.contact_table import ForceCurve, write_curves
from siggen.mesh.face_force import FaceForce, face_force, solver_room
from siggen.mesh.face_slices import FaceGaps, FaceSlices, carrying_length, spread_of_cells
from siggen.mesh.line_kernel import kernel_family, line_kernel, tooth_kernel, unit_tooth

KAPPA = 4.0 * (1.0 - 0.3**2) / (pi * 206e9)
RADIUS, DEPTH, WIDTH = 6.676e-3, 2.2e-3, 20e-3
REST = 0.78 / 1.99e8
STIFF, BENDING = (np.inf, 0.0), (4.8e-3, 0.75 * REST)
"""Length and compliance of teeth; with soft ones a quarter of the rest stays rigid."""


def face(
    gap=None,
    left=None,
    right=None,
    depth=0.0,
    slices=200,
    coupled=True,
    lead=None,
    rounding=0.0,
    rest=REST,
    teeth=STIFF,
    covered=None,
):
    """Slices of which those of the mask `gap` have edges at the distances `left` and `right` [m].

    `covered` (slices,): the part of a slice that has them, by default all or nothing.
    """
    gap = np.zeros(slices, bool) if gap is None else gap
    x1, x2 = (np.where(gap, np.inf if x is None else x, -NO_EDGE) for x in (left, right))
    d = np.where(gap, depth, 0.0)
    cell = WIDTH / slices
    lead = np.zeros(slices) if lead is None else lead
    covered = gap.astype(float) if covered is None else covered
    gaps = FaceGaps(x1, x2, d, d, (x1 > 0.0) & (x2 > 0.0), covered, np.full((slices, 2), -NO_EDGE))
    return FaceSlices(
        left_m=x1, right_m=x2, notch_m=d, floor_m=d, rough=((x1 > 0.0) & (x2 > 0.0)).astype(float),
        covered=covered, tips_m=np.full((slices, 2), -NO_EDGE), spread=spread_of_cells(1.28),
        lead_m=lead, face_m=cell * (np.arange(slices) + 0.5) - 0.5 * WIDTH,
        kernel=line_kernel(kernel_family(slices, cell, DEPTH), DEPTH, 0.3, coupled=coupled),
        teeth=tooth_kernel(unit_tooth(slices, WIDTH, teeth[0]), teeth[1], WIDTH, KAPPA),
        radius_m=RADIUS, radii_m=np.full(slices, RADIUS), rounding_m=rounding, kappa_per_pa=KAPPA,
        compliance_m_per_n=rest,
        carrying_m=float(carrying_length(gaps, lead, cell, np.array(RADIUS), KAPPA * 60e3)),
    )  # fmt: skip


def spall(offset=0.0, length=1.2e-3, half=5.5e-3, slices=200, depth=0.2e-3, skew=0.0, **other):
    """A gap about the middle of the face; its edges shift by `skew` along the profile per metre of face."""
    y = WIDTH * ((np.arange(slices) + 0.5) / slices - 0.5)
    s = offset + skew * y
    return face(np.abs(y) < half, 0.5 * length + s, 0.5 * length - s, depth, slices, **other)


def part_spall(offset=0.0, length=1.2e-3, half=5.53e-3, slices=200, place=0.0, **other):
    """As `spall` without skew; slices at its ends are covered in part, and its middle may lie beside the face's."""
    edge = WIDTH * (np.arange(slices + 1) / slices - 0.5) - place
    covered = np.diff(np.clip(edge, -half, half)) / (WIDTH / slices)
    covered[covered > 1.0 - 1e-9] = 1.0
    left, right = 0.5 * length + offset, 0.5 * length - offset
    return face(covered > 0.0, left, right, 0.2e-3, slices, covered=covered, **other)


def pitted(pits, length, slices, pitch=1e-3, **other):
    """Pits about the middle of the face that carry nothing; slices are covered in part."""
    edge = WIDTH * (np.arange(slices + 1) / slices - 0.5)
    centres = (np.arange(pits) - 0.5 * (pits - 1)) * pitch
    covered = sum(np.diff(np.clip(edge, c - 0.5 * length, c + 0.5 * length)) for c in centres) / (WIDTH / slices)
    covered[covered > 1.0 - 1e-9] = 1.0
    covered[covered < 1e-9] = 0.0
    return face(covered > 0.0, 1.0, 1.0, 0.0, slices, covered=covered, **other)


def solve(slices, approach, tilt=0.0, guess=None) -> tuple[FaceForce, np.ndarray]:
    loads = np.zeros(slices.face_m.size) if guess is None else guess.copy()
    answer = face_force(slices, approach, tilt, loads, solver_room(loads.size))
    assert answer.passes > 0
    return answer, loads


def approach_under(slices, force: float, tilt: float = 0.0) -> float:
    """Approach of the pair at a force and a tilt, by Newton's method [m]."""
    approach = force * (slices.compliance_m_per_n + 1.2e-9)
    for _ in range(40):
        answer, _ = solve(slices, approach, tilt)
        if abs(answer.force_n / force - 1.0) < 1e-10:
            break
        approach += (force - answer.force_n) / answer.stiffness_n_per_m if answer.force_n else 5e-6
    return approach


def force_curve(slices: FaceSlices, approach_m: np.ndarray, tilt_rad: float) -> ForceCurve:
    """Return the answers to ascending approaches (k,) [m] at one tilt, the last Newton step below 1e-3."""
    found = np.zeros((7, 1, approach_m.size))
    tilts = np.full((1, approach_m.size), tilt_rad)
    assert write_curves(slices, approach_m[np.newaxis], tilts, solver_room(slices.face_m.size), 1e-3, found)
    return ForceCurve(*found[:, 0])
