"""ForcedMotion: what small external forces do to a gear stage in mesh, as responses in frequency.

Derived. With the mean stiffness k and damping c of the mesh, the small motion obeys
(K + k p pᵀ + iω (C + c p pᵀ) - ω² M) q = d F. Solved at every frequency by elimination with pivoting, in own code: the
last bits of a library's would depend on its number of threads. What it leaves out: the stiffness changes over a pitch,
and a force that takes teeth out of contact; both matter for forces that are not small against the mesh force.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import ComplexArray, FloatArray
from siggen.compiled import entry, njit
from siggen.drivetrain.structure import Structure

# Responses of a linear structure to harmonic forces: elimination with pivoting at many frequencies side by side.
#
# (K + iω C - ω² M) q = d at every ω (derived). `TOGETHER` frequencies are eliminated together, real and imaginary
# parts apart, so that the compiler works on several of them at once. Each is pivoted by itself and gets the
# operations, in their order, that it would get alone. What is 0 at all of them is left out.

TOGETHER = 104
"""Frequencies side by side: no power of two, so that columns do not fall on the same places of a cache; 1 MB in all."""
DOUBTFUL = 1e-12
"""Relative difference of two squared sizes below which the sizes themselves say which pivot is larger."""


@entry(cache=True)
def forced_responses(
    mass: FloatArray,
    damping: FloatArray,
    stiffness: FloatArray,
    directions: FloatArray,
    rows: FloatArray,
    omega_rad_s: FloatArray,
) -> ComplexArray:
    """Return (outputs, inputs, k) of rows (outputs, 3, n): r_0 q + r_1 q̇ + r_2 q̈.

    Parameters
    ----------
    mass, damping, stiffness : (n, n)
    directions : (inputs, n) generalised forces
    rows : (outputs, 3, n)
    omega_rad_s : (k,)
    """
    n, inputs = mass.shape[0], directions.shape[0]
    result = np.zeros((rows.shape[0], inputs, omega_rad_s.size), dtype=np.complex128)
    matrices, omega = np.empty((n, n + inputs, 2, TOGETHER)), np.empty(TOGETHER)
    for first in range(0, omega_rad_s.size, TOGETHER):
        for lane in range(TOGETHER):
            omega[lane] = omega_rad_s[min(first + lane, omega_rad_s.size - 1)]
        for i in range(n):
            for j in range(n):
                _dynamic(stiffness[i, j], damping[i, j], mass[i, j], omega, matrices[i, j])
            for j in range(inputs):
                matrices[i, n + j, 0], matrices[i, n + j, 1] = directions[j, i], 0.0
        _eliminate(matrices, n)
        _write(rows, omega, matrices, result[:, :, first : first + TOGETHER])
    return result


@njit(cache=True)
def _dynamic(stiffness: float, damping: float, mass: float, omega: FloatArray, value: FloatArray) -> None:
    """Write K + iω C - ω² M (2, lanes)."""
    for lane in range(TOGETHER):
        value[0, lane] = stiffness - omega[lane] * omega[lane] * mass
        value[1, lane] = omega[lane] * damping


@njit(cache=True)
def _eliminate(matrices: FloatArray, n: int) -> None:
    """Solve in place: columns from n on of the matrices (n, n + m, 2, lanes) become the solutions of the first n."""
    pivot, live = np.empty(TOGETHER, dtype=np.int64), np.empty(matrices.shape[1], dtype=np.int64)
    inverse, factor = np.empty((n, 2, TOGETHER)), np.empty((2, TOGETHER))
    for column in range(n):
        _find_pivots(matrices, column, n, pivot)
        _swap(matrices, column, pivot)
        for lane in range(TOGETHER):
            one = 1.0 / complex(matrices[column, column, 0, lane], matrices[column, column, 1, lane])
            inverse[column, 0, lane], inverse[column, 1, lane] = one.real, one.imag
        count = _live(matrices[column], column + 1, live)
        for i in range(column + 1, n):
            if not _is_zero(matrices[i, column]):
                _multiply(matrices[i, column], inverse[column], factor)
                _subtract(factor, matrices[column], live[:count], matrices[i])
    for column in range(n - 1, -1, -1):
        count = _live(matrices[column], n, live)
        for k in range(count):
            _multiply(matrices[column, live[k]], inverse[column], matrices[column, live[k]])
        for i in range(column):
            if not _is_zero(matrices[i, column]):
                _subtract(matrices[i, column], matrices[column], live[:count], matrices[i])


@njit(cache=True)
def _find_pivots(matrices: FloatArray, column: int, n: int, pivot: NDArray[np.int64]) -> None:
    """Write the first row of largest size from `column` on, for each lane."""
    for lane in range(TOGETHER):
        best, largest = column, _square(matrices[column, column, 0, lane], matrices[column, column, 1, lane])
        for i in range(column + 1, n):
            size = _square(matrices[i, column, 0, lane], matrices[i, column, 1, lane])
            if size <= largest * (1.0 - DOUBTFUL):
                continue
            if size > largest * (1.0 + DOUBTFUL) or (
                math.hypot(matrices[i, column, 0, lane], matrices[i, column, 1, lane])
                > math.hypot(matrices[best, column, 0, lane], matrices[best, column, 1, lane])
            ):
                best, largest = i, size
        pivot[lane] = best


@njit(cache=True)
def _square(real: float, imaginary: float) -> float:
    return real * real + imaginary * imaginary


@njit(cache=True)
def _swap(matrices: FloatArray, column: int, pivot: NDArray[np.int64]) -> None:
    for lane in range(TOGETHER):
        row = pivot[lane]
        if row != column:
            for j in range(column, matrices.shape[1]):
                for part in range(2):
                    kept = matrices[column, j, part, lane]
                    matrices[column, j, part, lane] = matrices[row, j, part, lane]
                    matrices[row, j, part, lane] = kept


@njit(cache=True)
def _live(row: FloatArray, first: int, live: NDArray[np.int64]) -> int:
    """Write the columns from `first` on of a row (columns, 2, lanes) that are not 0; return how many they are."""
    count = 0
    for j in range(first, row.shape[0]):
        if not _is_zero(row[j]):
            live[count] = j
            count += 1
    return count


@njit(cache=True)
def _is_zero(value: FloatArray) -> bool:
    found = 0
    for lane in range(TOGETHER):
        found += (value[0, lane] != 0.0) + (value[1, lane] != 0.0)
    return found == 0


@njit(cache=True)
def _multiply(left: FloatArray, right: FloatArray, product: FloatArray) -> None:
    """Write the product of two values (2, lanes), lane by lane."""
    for lane in range(TOGETHER):
        a, b, c, d = left[0, lane], left[1, lane], right[0, lane], right[1, lane]
        product[0, lane], product[1, lane] = a * c - b * d, a * d + b * c


@njit(cache=True)
def _subtract(factor: FloatArray, row: FloatArray, live: NDArray[np.int64], other: FloatArray) -> None:
    """Subtract a factor (2, lanes) times a row (columns, 2, lanes) from another one at the columns `live`."""
    for k in range(live.size):
        j = live[k]
        for lane in range(TOGETHER):
            a, b, c, d = factor[0, lane], factor[1, lane], row[j, 0, lane], row[j, 1, lane]
            other[j, 0, lane] -= a * c - b * d
            other[j, 1, lane] -= a * d + b * c


@njit(cache=True)
def _write(rows: FloatArray, omega: FloatArray, solved: FloatArray, result: ComplexArray) -> None:
    """Write the outputs (outputs, inputs, k) of solved matrices at the first k of the frequencies."""
    n, weight, columns = rows.shape[2], np.empty((2, TOGETHER)), solved.shape[1]
    total = np.empty((columns, 2, TOGETHER))
    for o in range(rows.shape[0]):
        total[:] = 0.0
        for i in range(n):
            if rows[o, 0, i] != 0.0 or rows[o, 1, i] != 0.0 or rows[o, 2, i] != 0.0:
                _dynamic(rows[o, 0, i], rows[o, 1, i], rows[o, 2, i], omega, weight)
                _add(weight, solved[i], n, total)
        for j in range(n, columns):
            for lane in range(result.shape[2]):
                result[o, j - n, lane] = complex(total[j, 0, lane], total[j, 1, lane])


@njit(cache=True)
def _add(factor: FloatArray, row: FloatArray, first: int, other: FloatArray) -> None:
    """Add a factor (2, lanes) times a row (columns, 2, lanes) to another one from column `first` on."""
    for j in range(first, row.shape[0]):
        for lane in range(TOGETHER):
            a, b, c, d = factor[0, lane], factor[1, lane], row[j, 0, lane], row[j, 1, lane]
            other[j, 0, lane] += a * c - b * d
            other[j, 1, lane] += a * d + b * c


@dataclass(frozen=True, slots=True)
class MeanMesh:
    """The mesh as a constant spring and damper along the line of action [N/m, N s/m]."""

    stiffness_n_per_m: float
    damping_n_s_per_m: float


@dataclass(frozen=True, slots=True)
class ForcedMotion:
    """Responses (inputs, k): place/axis -> acceleration [m/s² per N], and -> force on the housing [N per N].

    `shaft` are those of `Structure.shaft_readings`.
    """

    acceleration: Mapping[str, ComplexArray]
    bearing_force: Mapping[str, ComplexArray]
    shaft: Mapping[str, ComplexArray]


def forced_decay_per_s(structure: Structure, meshes: Sequence[MeanMesh]) -> float:
    """Return the decay rate of the slowest mode of a structure with constant meshes [1/s]."""
    stiffness, damping = _with_meshes(structure, meshes)
    n = len(structure.coordinates)
    matrix = np.zeros((2 * n, 2 * n))
    matrix[:n, n:] = np.eye(n)
    matrix[n:, :n], matrix[n:, n:] = (-np.linalg.solve(structure.mass, one) for one in (stiffness, damping))
    return float(max(0.0, -np.linalg.eigvals(matrix).real.max()))


def _with_meshes(structure: Structure, meshes: Sequence[MeanMesh]) -> tuple[FloatArray, FloatArray]:
    """Return stiffness and damping (n, n) with constant meshes."""
    stiffness, damping = structure.stiffness, structure.damping
    for p, mean in zip((one.vector for one in structure.meshes), meshes, strict=True):
        stiffness = stiffness + mean.stiffness_n_per_m * p[:, None] * p[None, :]
        damping = damping + mean.damping_n_s_per_m * p[:, None] * p[None, :]
    return stiffness, damping


def forced_motion(
    structure: Structure,
    mesh: MeanMesh | Sequence[MeanMesh],
    directions: FloatArray,
    motions: tuple[str, ...],
    frequency_hz: FloatArray,
    readings: tuple[str, ...] = (),
) -> ForcedMotion:
    """Return the responses to inputs along generalised forces (inputs, n) at frequencies (k,).

    Parameters
    ----------
    structure : Structure; one that turns freely has no response at frequency 0
    mesh : MeanMesh, or one for each mesh of the structure
    directions : (inputs, n)
    motions : names of `structure.motions` that are wanted
    frequency_hz : (k,)
    readings : names of `structure.shaft_readings` that are wanted
    """
    stiffness, damping = _with_meshes(structure, (mesh,) if isinstance(mesh, MeanMesh) else mesh)
    bearings = structure.bearing_forces
    zero = np.zeros(len(structure.coordinates))
    rows = [(zero, zero, structure.motions[name]) for name in motions]
    rows += [(k, c, zero) for k, c in bearings.values()]
    of_shafts = structure.shaft_readings
    rows += [(*of_shafts[name], zero) for name in readings]
    found = forced_responses(
        np.ascontiguousarray(structure.mass),
        np.ascontiguousarray(damping),
        np.ascontiguousarray(stiffness),
        np.ascontiguousarray(directions),
        np.array(rows).reshape(len(rows), 3, len(structure.coordinates)),
        2.0 * np.pi * frequency_hz,
    )
    # a bearing's motion and its force bear the same name
    first, end = len(motions), len(motions) + len(bearings)
    return ForcedMotion(
        dict(zip(motions, found[:first], strict=True)),
        dict(zip(bearings, found[first:end], strict=True)),
        dict(zip(readings, found[end:], strict=True)),
    )
