"""Energy stored in the contact of a tooth pair and in its compliance: what force and moment are the derivatives of."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from siggen.gears.contact.exponential_matrix import products
from siggen.gears.contact.face_slices import FaceSlices, contact_half_width, slice_sink
from siggen.gears.contact.line_kernel import diagonal, strengths
from siggen.gears.contact.newton_matrix import SolverRoom

FloatArray = NDArray[np.float64]

ENERGY_NODES = 24


def stored_energy(
    slices: FaceSlices, approach_m: float, tilt_rad: float, loads_m: FloatArray, room: SolverRoom
) -> float:
    """Return W [J] of a solution `loads_m` (n,) of `face_force` at the same approach and tilt.

    The sinks' energies are Gauss sums over the square root of the load, in which they are smooth.
    """
    kernel = slices.kernel
    total, square = float(loads_m.sum()), float(loads_m @ loads_m)
    if total == 0.0:
        return 0.0
    width = contact_half_width(slices, square)[0]
    own = diagonal(kernel, width)[0]
    strengths(kernel, width, room.strength, room.strength_slope)
    products(kernel.decay, room.strength, room.strength_slope, loads_m, room.product, room.growth)
    elastic = 0.5 * (own * square + float(loads_m @ room.product))
    node, weight = np.polynomial.legendre.leggauss(ENERGY_NODES)
    node, weight = 0.5 * (node + 1.0), 0.5 * weight
    sinks = 0.0
    for i in np.flatnonzero(loads_m > 0.0):
        values = [slice_sink(slices, i, loads_m[i] * x * x).sink_m * 2.0 * x for x in node]
        sinks += loads_m[i] * float(weight @ np.array(values))
    per_load = kernel.cell_m / slices.kappa_per_pa
    force = per_load * total
    reached = approach_m + tilt_rad * slices.face_m - slices.lead_m
    return per_load * (float(loads_m @ reached) - elastic - sinks) - 0.5 * slices.compliance_m_per_n * force**2
