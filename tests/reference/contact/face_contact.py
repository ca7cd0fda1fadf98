"""Contact of a parabolic cylinder with an interrupted face in three dimensions: pressure cells on a half space.

Independent of `siggen.mesh`: no line kernel, no Hertz width, no slices. Rectangular cells of constant pressure
(Love 1929), products by fast Fourier transforms, and the conjugate gradients of Polonsky and Keer (1999) for pressures
that never pull at a given force. Displacements count from the point at the depth h below the line, in both bodies, as
those of Weber and Banaschek do. The surface may carry where `land` says so; nothing else makes the edges. Teeth that
bend across the face add their deflection by cosine modes of free ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np


@dataclass(frozen=True, slots=True)
class FaceCase:
    """Cylinder, bodies and grid; the reference's case by default (teeth 18/47, module 3 mm, at the pitch point).

    `cells_per_width` pressure cells cover the Hertz half width of the whole face; `cell_m` is their length across the
    face; `tooth_length_m`, `tooth_m_per_n`: of teeth that bend across the face, none by default.
    """

    face_width_m: float = 20e-3
    radius_m: float = 6.676e-3
    depth_m: float = 2.2e-3
    youngs_modulus_pa: float = 206e9
    poisson_ratio: float = 0.3
    cell_m: float = 0.05e-3
    cells_per_width: int = 8
    tooth_length_m: float = np.inf
    tooth_m_per_n: float = 0.0

    @property
    def kappa(self) -> float:
        """κ = 2/(π E*) of both bodies [1/Pa]."""
        return 4.0 * (1.0 - self.poisson_ratio**2) / (pi * self.youngs_modulus_pa)


def approach_at(
    case: FaceCase, land: np.ndarray, force_n: float, reach: float = 2.6, tilt_rad: float = 0.0
) -> tuple[float, np.ndarray]:
    """Return the approach [m] and the line load (k,) [N/m] of a face of which the cells `land` (k,) carry.

    The approach is that in the middle of the face, teeth included. `reach` is the half width of the grid in Hertz half
    widths of the whole face; a positive tilt brings cells of high numbers nearer.

    Raises
    ------
    RuntimeError
        If the gradients do not converge, or the pressure reaches the grid's rim.
    """
    width = sqrt(2.0 * case.radius_m * case.kappa * force_n / case.face_width_m)
    dx = width / case.cells_per_width
    count = 2 * int(reach * case.cells_per_width) + 1
    x = (np.arange(count) - count // 2) * dx
    y = (np.arange(land.size) + 0.5) * case.cell_m - 0.5 * case.face_width_m
    gap = (x * x / (2.0 * case.radius_m))[:, None] - tilt_rad * y[None, :]
    carries = np.broadcast_to(land[None, :], gap.shape)
    operator = _Operator(case, dx, count, land.size)
    load = _gradients(operator, gap, carries, force_n)
    if load[0].any() or load[-1].any():
        raise RuntimeError(f"pressure reaches the rim of the grid; allowed: a reach above {reach}")
    touched = load > 0.0
    return float(np.mean((operator(load) + gap)[touched])), load.sum(axis=0) / case.cell_m


def _gradients(operator: _Operator, gap: np.ndarray, carries: np.ndarray, force: float) -> np.ndarray:
    """Return the loads of the cells: Polonsky and Keer's conjugate gradients with the force given."""
    load = np.where(carries & (gap < gap.min() + 0.2 * np.ptp(gap)), 1.0, 0.0)
    load *= force / load.sum()
    direction = np.zeros_like(load)
    previous, restart = 1.0, 0.0
    for _ in range(3000):
        touched = load > 0.0
        rest = operator(load) + gap
        rest = rest - rest[touched].mean()
        norm = float(np.sum(rest[touched] ** 2))
        direction = np.where(touched, rest + restart * norm / previous * direction, 0.0)
        answer = operator(direction)
        answer = answer - answer[touched].mean()
        step = float(np.sum(rest[touched] * direction[touched]) / np.sum(answer[touched] * direction[touched]))
        old = load
        load = np.where(touched, np.maximum(load - step * direction, 0.0), 0.0)
        entering = carries & (load == 0.0) & (rest < 0.0) & ~touched
        load = np.where(entering, -step * rest, load)
        restart = 0.0 if entering.any() else 1.0
        previous = norm
        load *= force / load.sum()
        if np.abs(load - old).sum() < 1e-8 * force and not entering.any():
            return load
    raise RuntimeError("the conjugate gradients did not converge within 3000 steps")


class _Operator:
    """Displacement of the cells' middles [m] under loads on the cells [N], relative to the depth h."""

    def __init__(self, case: FaceCase, dx: float, rows: int, columns: int) -> None:
        self.rows, self.columns = rows, columns
        i, j = np.arange(-rows, rows) * dx, np.arange(-columns, columns) * case.cell_m
        # Love: the corners' sum of the integral of 1/r over a cell
        total = np.zeros((i.size, j.size))
        for p in (-0.5, 0.5):
            for q in (-0.5, 0.5):
                a, b = i[:, None] + p * dx, j[None, :] + q * case.cell_m
                total += np.sign(p * q) * (a * np.arcsinh(b / np.abs(a)) + b * np.arcsinh(a / np.abs(b)))
        kernel = 0.5 * case.kappa / (dx * case.cell_m) * total
        # Boussinesq's deflection at the depth h under a line load
        low, high = j - 0.5 * case.cell_m, j + 0.5 * case.cell_m
        below = 0.5 * case.kappa / case.cell_m * (_deep(high, case) - _deep(low, case))
        self._spectrum = np.fft.rfft2(np.fft.ifftshift(kernel - below[None, :]))
        self._teeth = _teeth(case, columns)

    def __call__(self, load: np.ndarray) -> np.ndarray:
        shape = (2 * self.rows, 2 * self.columns)
        contact = np.fft.irfft2(np.fft.rfft2(load, shape) * self._spectrum, shape)[: self.rows, : self.columns]
        return contact + (self._teeth @ load.sum(axis=0))[None, :]


def _teeth(case: FaceCase, columns: int) -> np.ndarray:
    """Deflection of the teeth at the cells under unit forces on others (columns, columns) [m/N]."""
    number = np.arange(columns)
    modes = np.cos(np.pi * number[:, None] * (number[None, :] + 0.5) / columns)
    if case.tooth_m_per_n == 0.0:
        return np.zeros((columns, columns))
    stiffness = 1.0 + (number * pi * case.tooth_length_m / case.face_width_m) ** 2
    weight = np.where(number == 0, 1.0, 2.0) / stiffness
    return case.tooth_m_per_n * (modes.T * weight) @ modes


def _deep(t: np.ndarray, case: FaceCase) -> np.ndarray:
    """Integral along the line of the deflection at depth h, times 2/κ for both bodies."""
    h = case.depth_m
    return np.arcsinh(t / h) + t / (2.0 * (1.0 - case.poisson_ratio) * np.hypot(t, h))


def land_of_gap(case: FaceCase, share: float, start: float | None = None) -> np.ndarray:
    """Return the cells (k,) that carry beside one gap of a share of the face, in the middle or from `start`, 0 to 1."""
    count = round(case.face_width_m / case.cell_m)
    y = (np.arange(count) + 0.5) / count
    first = 0.5 * (1.0 - share) if start is None else start
    return (y < first) | (y > first + share)


def land_of_pits(case: FaceCase, pits: int, length_m: float = 0.6e-3, pitch_m: float = 1e-3) -> np.ndarray:
    """Return the cells (k,) that carry beside pits about the middle of the face."""
    count = round(case.face_width_m / case.cell_m)
    y = (np.arange(count) + 0.5) * case.cell_m - 0.5 * case.face_width_m
    centres = (np.arange(pits) - 0.5 * (pits - 1)) * pitch_m
    return np.all(np.abs(y[:, None] - centres[None, :]) > 0.5 * length_m, axis=1)
