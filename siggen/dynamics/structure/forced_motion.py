"""ForcedMotion: what small external forces do to a gear stage in mesh, as responses in frequency.

Derived. With the mean stiffness k and damping c of the mesh, the small motion obeys
(K + k p pᵀ + iω (C + c p pᵀ) - ω² M) q = d F. Solved at every frequency by elimination with pivoting, in own code: the
last bits of a library's would depend on its number of threads. What it leaves out: the stiffness changes over a pitch,
and a force that takes teeth out of contact; both matter for forces that are not small against the mesh force.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.compiled import njit
from siggen.dynamics.structure.structure import Structure


@dataclass(frozen=True, slots=True)
class MeanMesh:
    """The mesh as a constant spring and damper along the line of action [N/m, N s/m]."""

    stiffness_n_per_m: float
    damping_n_s_per_m: float


@dataclass(frozen=True, slots=True)
class ForcedMotion:
    """Responses (inputs, k): place/axis -> acceleration [m/s² per N], and -> force on the housing [N per N]."""

    acceleration: Mapping[str, ComplexArray]
    bearing_force: Mapping[str, ComplexArray]


def forced_motion(
    structure: Structure, mesh: MeanMesh, directions: FloatArray, motions: tuple[str, ...], frequency_hz: FloatArray
) -> ForcedMotion:
    """Return the responses to inputs along generalised forces (inputs, n) at frequencies (k,).

    Parameters
    ----------
    structure : Structure; one that turns freely has no motion at frequency 0, where all responses are set to 0
    mesh : MeanMesh
    directions : (inputs, n)
    motions : names of `structure.motions` that are wanted
    frequency_hz : (k,)
    """
    p = structure.mesh_vector
    stiffness = structure.stiffness + mesh.stiffness_n_per_m * p[:, None] * p[None, :]
    damping = structure.damping + mesh.damping_n_s_per_m * p[:, None] * p[None, :]
    bearings = structure.bearing_forces
    zero = np.zeros(len(structure.coordinates))
    rows = [(zero, zero, structure.motions[name]) for name in motions]
    rows += [(k, c, zero) for k, c in bearings.values()]
    found = _responses(
        np.ascontiguousarray(structure.mass),
        np.ascontiguousarray(damping),
        np.ascontiguousarray(stiffness),
        np.ascontiguousarray(directions),
        np.array(rows).reshape(len(rows), 3, len(structure.coordinates)),
        2.0 * np.pi * frequency_hz,
    )
    # a bearing's motion and its force bear the same name
    return ForcedMotion(
        dict(zip(motions, found[: len(motions)], strict=True)), dict(zip(bearings, found[len(motions) :], strict=True))
    )


@njit(cache=True)
def _responses(
    mass: FloatArray,
    damping: FloatArray,
    stiffness: FloatArray,
    directions: FloatArray,
    rows: FloatArray,
    omega_rad_s: FloatArray,
) -> ComplexArray:
    """Return (outputs, inputs, k) of rows (outputs, 3, n): r_0 q + r_1 q̇ + r_2 q̈."""
    n, inputs, outputs = mass.shape[0], directions.shape[0], rows.shape[0]
    result = np.zeros((outputs, inputs, omega_rad_s.size), dtype=np.complex128)
    a = np.empty((n, n + inputs), dtype=np.complex128)
    for k in range(omega_rad_s.size):
        omega = omega_rad_s[k]
        if omega == 0.0:
            continue
        for i in range(n):
            for j in range(n):
                a[i, j] = complex(stiffness[i, j] - omega * omega * mass[i, j], omega * damping[i, j])
            for j in range(inputs):
                a[i, n + j] = directions[j, i]
        _eliminate(a, n)
        for o in range(outputs):
            for j in range(inputs):
                total = 0.0j
                for i in range(n):
                    weight = complex(rows[o, 0, i] - omega * omega * rows[o, 2, i], omega * rows[o, 1, i])
                    total += weight * a[i, n + j]
                result[o, j, k] = total
    return result


@njit(cache=True)
def _eliminate(a: ComplexArray, n: int) -> None:
    """Solve in place: columns from n on of `a` (n, n + m) become the solutions of its first n columns."""
    for column in range(n):
        pivot = column
        for i in range(column + 1, n):
            if abs(a[i, column]) > abs(a[pivot, column]):
                pivot = i
        for j in range(column, a.shape[1]):
            a[column, j], a[pivot, j] = a[pivot, j], a[column, j]
        inverse = 1.0 / a[column, column]
        for i in range(column + 1, n):
            factor = a[i, column] * inverse
            if factor != 0.0:
                for j in range(column + 1, a.shape[1]):
                    a[i, j] -= factor * a[column, j]
    for column in range(n - 1, -1, -1):
        inverse = 1.0 / a[column, column]
        for j in range(n, a.shape[1]):
            a[column, j] *= inverse
        for i in range(column):
            for j in range(n, a.shape[1]):
                a[i, j] -= a[i, column] * a[column, j]
