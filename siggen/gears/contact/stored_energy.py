"""Energy stored in the contact of a tooth pair and in its compliance: what force and moment are the derivatives of."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.gears.contact.covered_slice import load_apart
from siggen.gears.contact.edge_law import NO_EDGE
from siggen.gears.contact.exponential_matrix import add_row_products, products
from siggen.gears.contact.face_slices import FaceSlices, contact_half_width, slice_of
from siggen.gears.contact.line_kernel import diagonal, strengths
from siggen.gears.contact.newton_matrix import SolverRoom
from siggen.gears.contact.own_width import mean_width, own_width
from siggen.gears.contact.two_edges import gap_sink

ENERGY_NODES = 6
"""Of the Gauss sums over the loads: 3e-9 J of 5e-3 J (tested against 32)."""


def energy_nodes(count: int = ENERGY_NODES) -> FloatArray:
    """Return nodes and weights (2, count) of Gauss from 0 to 1, for `stored_energy`."""
    node, weight = np.polynomial.legendre.leggauss(count)
    return np.array([0.5 * (node + 1.0), 0.5 * weight])


@entry(cache=True, _nrt=False, error_model="numpy")
def stored_energy(
    slices: FaceSlices,
    approach_m: float,
    tilt_rad: float,
    loads_m: FloatArray,
    room: SolverRoom,
    nodes: FloatArray,
) -> float:
    """Return W [J] of a solution `loads_m` (n,) of `face_force` at the same approach and tilt.

    The sinks' energies are Gauss sums (`nodes`, see `energy_nodes`) over the square root of the load, in which they are
    smooth.
    """
    kernel = slices.kernel
    total = square = 0.0
    for i in range(loads_m.size):
        total += loads_m[i]
        square += loads_m[i] * loads_m[i]
    if total == 0.0:
        return 0.0
    width = contact_half_width(slices, square)[0]
    own = diagonal(kernel, width)[0]
    strengths(kernel, width, room.strength, room.strength_slope)
    products(kernel.decay, room.strength, room.strength_slope, loads_m, room.product, room.growth)
    add_row_products(slices.teeth.strength, slices.teeth.decay, loads_m, room.product)
    shared = mean_width(slices, square)
    work = 0.0
    for i in range(loads_m.size):
        if loads_m[i] == 0.0:
            continue
        sunk = 0.0
        if slices.left_m[i] > -0.5 * NO_EDGE or slices.right_m[i] > -0.5 * NO_EDGE:
            sunk = _sink_energy(slices, i, loads_m[i], nodes) / loads_m[i]
        reached = approach_m + tilt_rad * slices.face_m[i] - slices.lead_m[i]
        scale = slices.radii_m[i] / slices.radius_m * shared.scale_per_m
        wider = own_width(loads_m[i], scale, shared.coupled).logarithm - shared.mean.logarithm
        local = own + slices.teeth.diagonal[i] - wider
        work += loads_m[i] * (reached - 0.5 * (local * loads_m[i] + room.product[i]) - sunk)
    per_load = kernel.cell_m / slices.kappa_per_pa
    force = per_load * total
    return per_load * work - 0.5 * slices.compliance_m_per_n * force * force


@njit(cache=True, _nrt=False, error_model="numpy")
def _sink_energy(slices: FaceSlices, i: int, load: float, nodes: FloatArray) -> float:
    """Return ∫ e du of slice i: of gap and land one by one, since a gap comes to carry with a bend of the sink."""
    one = slice_of(slices, i)
    gap, covered, radii = one.gap, one.covered, one.radii
    if not 0.0 < covered < 1.0:
        return _gap_energy(gap, radii, load, nodes)
    apart = load_apart(one, load)
    land = slices.tips_m[i, 0], slices.tips_m[i, 1], 0.0, 0.0
    on_land = _gap_energy(land, radii, load + covered * apart, nodes)
    on_gap = _gap_energy(gap, radii, max(load - (1.0 - covered) * apart, 0.0), nodes)
    passing: float = 0.5 * slices.spread * covered * (1.0 - covered) * apart * apart
    passing += (1.0 - covered) * on_land + covered * on_gap
    return passing


@njit(cache=True, _nrt=False, error_model="numpy")
def _gap_energy(
    gap: tuple[float, float, float, float], radii: tuple[float, float], load: float, nodes: FloatArray
) -> float:
    """Return ∫ e du of a gap up to a load."""
    total = 0.0
    for k in range(nodes.shape[1]):
        x = nodes[0, k]
        sunk = gap_sink(gap[0], gap[1], gap[2], gap[3], radii[0], radii[1], load * x * x).sink_m
        total += 2.0 * x * nodes[1, k] * sunk
    return total * load
