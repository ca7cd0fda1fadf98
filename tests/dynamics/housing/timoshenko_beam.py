"""Lowest bending mode of a free square tube with end plates by beam elements with shear."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from siggen.drivetrain.box import Material

ELEMENTS = 120


def free_bending_hz(length_m: float, side_m: float, wall_m: float, material: Material) -> float:
    """First bending frequency; shear factor of a thin square tube after Cowper (1966)."""
    e, nu, rho = material.youngs_modulus_pa, material.poisson_ratio, material.density_kg_m3
    outer, inner = side_m + wall_m, side_m - wall_m
    area, inertia = outer**2 - inner**2, (outer**4 - inner**4) / 12.0
    shear = 20.0 * (1.0 + nu) / (48.0 + 39.0 * nu) * e / (2.0 * (1.0 + nu)) * area
    step = length_m / ELEMENTS
    size = 2 * (ELEMENTS + 1)
    stiffness, mass = np.zeros((size, size)), np.zeros((size, size))
    soft = 12.0 * e * inertia / (shear * step**2)
    own = e * inertia / ((1.0 + soft) * step**3) * np.array([
        [12.0, 6 * step, -12.0, 6 * step],
        [6 * step, (4 + soft) * step**2, -6 * step, (2 - soft) * step**2],
        [-12.0, -6 * step, 12.0, -6 * step],
        [6 * step, (2 - soft) * step**2, -6 * step, (4 + soft) * step**2],
    ])  # fmt: skip
    lumped = 0.5 * step * rho * np.array([area, inertia, area, inertia])
    for n in range(ELEMENTS):
        stiffness[2 * n : 2 * n + 4, 2 * n : 2 * n + 4] += own
        mass[2 * n : 2 * n + 4, 2 * n : 2 * n + 4] += np.diag(lumped)
    plate = rho * side_m**2 * wall_m
    for end in (0, size - 2):
        mass[end, end] += plate
        mass[end + 1, end + 1] += plate * side_m**2 / 12.0
    values = eigh(stiffness, mass, eigvals_only=True)
    return float(np.sqrt(values[2]) / (2.0 * np.pi))
