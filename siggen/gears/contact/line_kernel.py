r"""Displacement of a line contact across the face: the kernel K and its form as a sum of exponentials.

Derived. A line load q(y) on two half spaces displaces the line, relative to the points at the depth h below it, by

    u(y) = κ Σ_j K_ij q_j,   K = ½ [f(t + w/2) - f(t - w/2)],   t = y_i - y_j,   κ = 2/(π E*)
    f(t) = arsinh(t/ε) - arsinh(t/h) - t/(2 (1 - ν) √(t² + h²)),   ε = a/(2 √e)

for cells of width w: Boussinesq's solution at the surface, with a width ε that gives an endless line exactly the
secant compliance of Weber and Banaschek, ln(2 h/a) - ν/(2 (1 - ν)); their depth h takes away the rest. Cells are part
of the model: from w = 0.7 to 3 a the losses of pair stiffness are those of the contact in three dimensions to 0.9
points (`tests.reference.contact.comparisons`); narrower cells let the short waves become too soft.

The law of a is written as an energy (`face_force`): ½ u·K u with a of the load itself gives Weber and Banaschek's
secant only with ε e^-¼ in place of ε, since a grows with the load that does the work. `diagonal` and `strengths`
hold that ε.

K between different cells is a sum of `EXPONENTIALS` decaying exponentials, so that a product or a solution of n cells
takes n steps (`exponential_matrix`). Fitted error: 1e-3 κ at most on each entry, 5e-3 κ on the sum of a row, against
4 κ (20 mm, w = 0.1 mm).
"""

from __future__ import annotations

from functools import lru_cache
from math import asinh, exp, log, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.gears.contact.exponential_matrix import EXPONENTIALS

SHORTEST_CELLS, LONGEST_DEPTHS = 0.5, 1.8
"""Decay lengths of the exponentials: geometric from half a cell to 1.8 h."""
ENERGY_WIDTH = 0.5 * exp(-0.75)
"""ε e^-¼ over a."""
POWERS = 4
"""Coefficients are a polynomial in t = x²/(x² + 1/4), x = ε e^-¼/w: short-range softness of a wide contact."""
WIDEST_EXACT, WIDEST = 1.5, 3.0
"""See `reckoned_width`, in cells."""
LARGEST_WIDTH = 1.0
"""Largest x of the fit; a wider contact keeps it off the diagonal."""


class LineKernel(NamedTuple):
    """K of equal cells at one position (a named tuple, since compiled code takes no dataclass).

    `decay` (m,): of each exponential from cell to cell; `near` (POWERS, m): polynomial of their strengths in t;
    `below` (m,), `below_diagonal`: what the depth takes away; `cell_m`: w; `depth_m`: h; `bracket`: ν/(2 (1 - ν));
    `coupled`: whether cells act on each other; if not every cell is a plane contact after Weber and Banaschek.
    """

    decay: FloatArray
    near: FloatArray
    below: FloatArray
    below_diagonal: float
    cell_m: float
    depth_m: float
    bracket: float
    coupled: bool


class KernelFamily(NamedTuple):
    """What kernels of all positions with equal cells share: `decay` (m,), `near` (POWERS, m), `fit` (m, n - 1)."""

    decay: FloatArray
    near: FloatArray
    fit: FloatArray
    cell_m: float


@lru_cache(maxsize=8)
def kernel_family(cells: int, cell_m: float, depth_m: float) -> KernelFamily:
    """Return the exponentials of a face of equal cells; `depth_m` is a typical h, which sets the longest decay.

    Raises
    ------
    ValueError
        If there are fewer than two cells, or their width or the depth is not positive.
    """
    if cells < 2 or not cell_m > 0.0 or not depth_m > 0.0:
        raise ValueError(
            f"kernel of {cells} cells of {cell_m} m at the depth {depth_m} m; "
            "allowed: at least 2 cells, lengths above 0"
        )
    lengths = np.geomspace(SHORTEST_CELLS, max(LONGEST_DEPTHS * depth_m / cell_m, 2.0), EXPONENTIALS)
    decay = np.exp(-1.0 / lengths)
    offset = np.arange(1, cells)
    fit = np.asarray(np.linalg.pinv(decay[None, :] ** offset[:, None]), dtype=np.float64)
    widths = np.linspace(0.02, LARGEST_WIDTH, 60)
    t = widths**2 / (widths**2 + 0.25)
    at_widths = np.stack([fit @ _near(offset, x) for x in widths])
    near = np.linalg.lstsq(t[:, None] ** np.arange(POWERS), at_widths, rcond=None)[0]
    family = KernelFamily(decay, np.array(near, dtype=np.float64), fit, cell_m)
    for array in family[:3]:
        array.setflags(write=False)
    return family


def line_kernel(family: KernelFamily, depth_m: float, poisson_ratio: float, *, coupled: bool = True) -> LineKernel:
    """Return the kernel at a position with Weber and Banaschek's depth h = √(h₁ h₂) [m]."""
    (kernel,) = line_kernels(family, np.array([depth_m]), poisson_ratio, coupled=coupled)
    return kernel


def line_kernels(
    family: KernelFamily, depth_m: FloatArray, poisson_ratio: float, *, coupled: bool = True
) -> list[LineKernel]:
    """Return the kernels at positions with depths (k,) [m]."""
    offset = np.arange(family.fit.shape[1] + 1)
    taken = _below(offset * family.cell_m, family.cell_m, depth_m[:, np.newaxis], poisson_ratio)
    return [
        LineKernel(
            decay=family.decay,
            near=family.near,
            below=family.fit @ below[1:],
            below_diagonal=float(below[0]),
            cell_m=family.cell_m,
            depth_m=depth,
            bracket=poisson_ratio / (2.0 * (1.0 - poisson_ratio)),
            coupled=coupled,
        )
        for depth, below in zip(depth_m.tolist(), taken, strict=True)
    ]


def _near(offset: NDArray[np.int64], width: float) -> FloatArray:
    return np.asarray(0.5 * (np.arcsinh((offset + 0.5) / width) - np.arcsinh((offset - 0.5) / width)))


def _below(t: FloatArray, cell_m: float, depth_m: float | FloatArray, poisson_ratio: float) -> FloatArray:
    def integral(y: FloatArray) -> FloatArray:
        return np.arcsinh(y / depth_m) + y / (2.0 * (1.0 - poisson_ratio) * np.hypot(y, depth_m))

    return 0.5 * (integral(t + 0.5 * cell_m) - integral(t - 0.5 * cell_m))


@entry(cache=True, _nrt=False, error_model="numpy")
def reckoned_width(half_width_m: float, cell_m: float) -> tuple[float, float, float]:
    """Return the half width that K reckons with, and the first and second derivative of its logarithm to ln a.

    It is a itself up to `WIDEST_EXACT` cells. A contact much wider than its cells would make the energy's short waves
    unstable; from there on the width grows more slowly, and stops at `WIDEST` cells, with a continuous slope.
    """
    if half_width_m <= WIDEST_EXACT * cell_m:
        return half_width_m, 1.0, 0.0
    span = log(WIDEST / WIDEST_EXACT)
    over = log(half_width_m / (WIDEST_EXACT * cell_m))
    if over >= span:
        return WIDEST_EXACT * cell_m * exp(0.5 * span), 0.0, 0.0
    return WIDEST_EXACT * cell_m * exp(over - 0.5 * over * over / span), 1.0 - over / span, -1.0 / span


@entry(cache=True, _nrt=False, error_model="numpy")
def diagonal(kernel: LineKernel, half_width_m: float) -> tuple[float, float]:
    """Return K_ii of the energy and its derivative to ln a."""
    if not kernel.coupled:
        return log(2.0 * kernel.depth_m / half_width_m) - kernel.bracket + 0.25, -1.0
    x = 0.5 * kernel.cell_m / (ENERGY_WIDTH * half_width_m)
    return asinh(x) - kernel.below_diagonal, -x / sqrt(1.0 + x * x)


@entry(cache=True, _nrt=False, error_model="numpy")
def strengths(kernel: LineKernel, half_width_m: float, strength: FloatArray, slope: FloatArray) -> None:
    """Write the strengths (m,) of the exponentials and their derivatives to ln a."""
    if not kernel.coupled:
        strength[:] = 0.0
        slope[:] = 0.0
        return
    x = ENERGY_WIDTH * half_width_m / kernel.cell_m
    t = x * x / (x * x + 0.25)
    # d t/d ln a
    t_slope = 2.0 * t * (1.0 - t)
    if x > LARGEST_WIDTH:
        t, t_slope = LARGEST_WIDTH**2 / (LARGEST_WIDTH**2 + 0.25), 0.0
    for m in range(strength.size):
        value, rise = 0.0, 0.0
        for p in range(POWERS - 1, -1, -1):
            rise = rise * t + value
            value = value * t + kernel.near[p, m]
        strength[m] = value - kernel.below[m]
        slope[m] = rise * t_slope
