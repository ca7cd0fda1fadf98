r"""Half width of a slice under its own load, where the kernel across the face reckons with one for all slices.

Derived. `line_kernel` holds ½ u·K(a) u with the half width a of the mean square of the loads. A load that changes
slowly across the face makes each place as wide as it is loaded: the energy lacks

    -½ Σ u_j² [λ(u_j) - λ(u_m)],   λ = ln ρ(√(2 R u)),   u_m² = w Σ u²/L,

which is 0 for an even load and takes ½ from the compliance of waves. It is exact where they are long beside a: a strip
that sinks with the wave sin ky has ln(4/ka) - γ, K alone ½ more. Without it a face gives way to a tilt by 10 % more
than in three dimensions. In λ(u_j) stands the radius of the slice: those of helical teeth differ. ρ is a up to `EXACT`
cells and stops at `WIDEST`, with two continuous derivatives: the short waves of K, whose eigenvalue falls to ½ at one
cell, could not bear more.
"""

from __future__ import annotations

from math import log, sqrt
from typing import NamedTuple

from siggen.compiled import entry, njit
from siggen.gears.contact.face_slices import FaceSlices

EXACT, WIDEST = 0.5, 3.0
"""In cells: what the shortest wave meets stays above 0.05 κ at any mean width, for loads to five times the mean."""
SPAN = log(WIDEST / EXACT)


class OwnWidth(NamedTuple):
    """λ of a load, counted from the width `EXACT`, and its first and second derivative to ln a."""

    logarithm: float
    growth: float
    bend: float


class MeanWidth(NamedTuple):
    """What slices share: a² over the load and `EXACT`² [1/m], whether slices act on each other, and λ of the mean load.

    Slices that do not act on each other have no widest width.
    """

    scale_per_m: float
    coupled: bool
    mean: OwnWidth


@njit(cache=True, _nrt=False, error_model="numpy")
def own_width(load_m: float, scale_per_m: float, coupled: bool) -> OwnWidth:
    """Return λ of a load κq > 0 [m]."""
    over = 0.5 * log(scale_per_m * load_m)
    if over <= 0.0 or not coupled:
        return OwnWidth(over, 1.0, 0.0)
    if over >= SPAN:
        return OwnWidth(0.5 * SPAN, 0.0, 0.0)
    x = over / SPAN
    return OwnWidth(over * (1.0 - x * x * (1.0 - 0.5 * x)), 1.0 - x * x * (3.0 - 2.0 * x), 6.0 * x * (x - 1.0) / SPAN)


@entry(cache=True, _nrt=False, error_model="numpy")
def mean_width(slices: FaceSlices, square: float) -> MeanWidth:
    """Return what slices share under loads with the sum of squares `square` > 0."""
    cell = slices.kernel.cell_m
    scale, coupled = 2.0 * slices.radius_m / (EXACT * cell) ** 2, slices.kernel.coupled
    return MeanWidth(scale, coupled, own_width(sqrt(cell * square / slices.carrying_m), scale, coupled))


@entry(cache=True, _nrt=False, error_model="numpy")
def own_law(load_m: float, radius_share: float, shared: MeanWidth) -> tuple[float, float]:
    """Return what the own width of a slice under κq > 0 [m] adds to its approach over the load, and to the slope.

    `radius_share`: its radius over that of the pair.
    """
    own = own_width(load_m, radius_share * shared.scale_per_m, shared.coupled)
    factor = shared.mean.logarithm - own.logarithm + 0.25 * (shared.mean.growth - own.growth)
    return factor, factor - 0.5 * own.growth - 0.125 * own.bend
