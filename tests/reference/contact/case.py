"""The case of all comparisons: teeth 18/47 of module 3 mm at the pitch point, 20 mm wide, and the library's faces."""

from __future__ import annotations

from math import pi, sqrt
from typing import NamedTuple

import numpy as np

from siggen.mesh.contact_edges import NO_EDGE
from siggen.mesh.face_force import face_force, solver_room
from siggen.mesh.face_slices import FaceGaps, FaceSlices, carrying_length, spread_of_cells
from siggen.mesh.line_kernel import kernel_family, line_kernel, tooth_kernel, unit_tooth
from siggen.mesh.table_options import CELL_WIDTHS

RADIUS_M, DEPTH_M, FACE_M, POISSON = 6.676e-3, 2.2e-3, 20e-3, 0.3
KAPPA = 4.0 * (1.0 - POISSON**2) / (pi * 206e9)
REST_M_PER_N = 0.78 / 1.99e8
"""The contact is 22 % of the healthy pair's compliance at 1,200 N."""
LINE_LOADS = (30e3, 60e3, 100e3)


def half_width(line_load_n_per_m: float) -> float:
    """Return Hertz's half width [m]."""
    return sqrt(2.0 * RADIUS_M * KAPPA * line_load_n_per_m)


class Teeth(NamedTuple):
    """Length [m] and compliance [m/N] of the teeth that bend across the face; the rest stays rigid."""

    length_m: float = np.inf
    compliance_m_per_n: float = 0.0


RIGID, BENDING = Teeth(), Teeth(4.92e-3, 2.83e-9)
"""The finite-element teeth of 18/47: all but the torsion of the bodies bends, over 1.64 modules."""


def face_of(
    left_m: np.ndarray,
    right_m: np.ndarray,
    depth_m: np.ndarray,
    teeth: Teeth = RIGID,
    covered: np.ndarray | None = None,
) -> FaceSlices:
    """Return the library's face of slices with edges at these distances (n,) and gaps of this depth (n,).

    `covered` (n,): the part of a slice that has them.
    """
    count = left_m.size
    covered = np.where(left_m > -NO_EDGE, 1.0, 0.0) if covered is None else covered
    cell = FACE_M / count
    none = np.zeros(count)
    gaps = FaceGaps(left_m, right_m, depth_m, depth_m, none, covered, np.full((count, 2), -NO_EDGE))
    return FaceSlices(
        left_m=left_m,
        right_m=right_m,
        notch_m=depth_m,
        floor_m=depth_m,
        rough=((left_m > 0.0) & (right_m > 0.0)).astype(np.float64),
        covered=covered,
        lead_m=none,
        face_m=cell * (np.arange(count) + 0.5) - 0.5 * FACE_M,
        tips_m=gaps.tips_m,
        spread=spread_of_cells(CELL_WIDTHS),
        kernel=line_kernel(kernel_family(count, cell, DEPTH_M), DEPTH_M, POISSON),
        teeth=tooth_kernel(unit_tooth(count, FACE_M, teeth.length_m), teeth.compliance_m_per_n, FACE_M, KAPPA),
        radius_m=RADIUS_M,
        radii_m=np.full(count, RADIUS_M),
        rounding_m=0.0,
        kappa_per_pa=KAPPA,
        compliance_m_per_n=REST_M_PER_N - teeth.compliance_m_per_n,
        carrying_m=float(carrying_length(gaps, none, cell, np.array(RADIUS_M), KAPPA * 60e3)),
    )


def face_of_land(land: np.ndarray, teeth: Teeth = RIGID) -> FaceSlices:
    """Return the face of which the part `land` (n,) of every slice carries: elsewhere the edges are 1 m away."""
    away = np.where(land == 1.0, -NO_EDGE, 1.0)
    return face_of(away, away, np.zeros(land.size), teeth, 1.0 - land)


def approach_under(slices: FaceSlices, force_n: float) -> float:
    """Return the approach [m] of the pair at a force; raises as `answer_under`."""
    return answer_under(slices, force_n)[0]


def answer_under(slices: FaceSlices, force_n: float, tilt_rad: float = 0.0) -> tuple[float, float]:
    """Return approach [m] and moment [N m] of the pair at a force and a tilt, by Newton's method.

    Raises
    ------
    RuntimeError
        If it does not converge.
    """
    room, loads = solver_room(slices.face_m.size), np.zeros(slices.face_m.size)
    approach = force_n * (REST_M_PER_N + 1.2e-9)
    for _ in range(60):
        answer = face_force(slices, approach, tilt_rad, loads, room)
        if abs(answer.force_n / force_n - 1.0) < 1e-9:
            return approach, answer.moment_n_m
        approach += (force_n - answer.force_n) / answer.stiffness_n_per_m if answer.force_n else 5e-6
    raise RuntimeError(f"no approach found for {force_n} N")
