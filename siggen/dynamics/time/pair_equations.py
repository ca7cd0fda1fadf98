"""PairEquations: constant numbers of the equations of motion under the forces of tooth pairs (`pair_motion`)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.shaft_lines import rolling, without_drift
from siggen.dynamics.structure.structure import MeshVectors, Structure, vector
from siggen.dynamics.time.equations import Equations, inverse_times

FORCE, APPROACH, TILT = range(3)
"""Columns of `PairEquations.static`."""
UPRIGHT, TILTING = 6, 9
"""Rows of a mesh in `PairEquations.rows`, without and with tilt."""


class PairEquations(NamedTuple):
    """Constant numbers of the equations of motion and how sliding enters them.

    `rows` (2n + 6 meshes, n), one array for speed (see `packed_tables`): the columns of -M⁻¹K and of -M⁻¹C; then of
    each mesh p, r_0, r_1, M⁻¹ p, M⁻¹ r_0, M⁻¹ r_1, and where gears tilt t, M⁻¹ t and M⁻¹ t_x; those of the
    friction without drift (`shaft_lines.without_drift`). `static` (meshes, 3):
    force, approach and tilt that deviations count from. `rigid_sliding` (meshes, 2): sliding speed at s of the rigid
    rotation is the first plus s times the second [m/s, 1/s]. `places` (meshes, 2): base pitches that a mesh has turned
    are the first times those of the first mesh, plus the second. `external_input` (m, n): see `Equations`.
    """

    rows: FloatArray
    static: FloatArray
    rigid_sliding: FloatArray
    places: FloatArray
    external_input: FloatArray


def pair_equations(structure: Structure, equations: Equations, speed_hz: float, places: FloatArray) -> PairEquations:
    """Return the numbers of a structure about a state, at a mean speed of its first shaft."""
    omega = 2.0 * np.pi * speed_hz
    parts = [-equations.stiffness_by_mass.T, -equations.damping_by_mass.T]
    static, rigid = [], []
    for number, mesh in enumerate(structure.meshes):
        parts += _mesh_rows(structure, equations, number)
        tilt = 0.0 if mesh.tilt is None else float(mesh.tilt @ equations.static_deflection)
        static.append([equations.static_force[number], equations.static_approach[number], tilt])
        rigid.append(mesh.sliding @ _rolling(structure, mesh) * omega)
    return PairEquations(
        np.ascontiguousarray(np.concatenate(parts)), np.array(static), np.array(rigid), places,
        equations.external_input,
    )  # fmt: skip


def _mesh_rows(structure: Structure, equations: Equations, number: int) -> list[FloatArray]:
    mesh = structure.meshes[number]
    inputs = inverse_times(structure.mass, without_drift(structure, mesh.sliding).T).T
    rows = [mesh.vector[None], mesh.sliding, equations.mesh_input[number][None], inputs]
    if mesh.tilt is not None:
        arms = np.stack([mesh.tilt, mesh.friction_tilt], axis=1)
        rows += [mesh.tilt[None], inverse_times(structure.mass, arms).T]
    return rows


def _rolling(structure: Structure, mesh: MeshVectors) -> FloatArray:
    """Return how fast the gears of a mesh turn (n,) per speed of the first shaft when nothing deforms."""
    turning = rolling(structure)
    return vector(structure.coordinates, {name: turning[structure.coordinates.index(name)] for name in mesh.turning})
