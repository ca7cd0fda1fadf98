"""Columns of the contact table on all rays of approach and tilt, from those without tilt.

Derived. How a tilt takes force from a column hardly changes from one to the next, though the force itself does: along a
ray the force over that without tilt at the same radius is linear between few columns, which are solved.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.gears.contact.column_halving import halved
from siggen.gears.contact.kind_row import KindRow
from siggen.gears.contact.table_columns import (
    ACROSS,
    ACROSS_SLOPE,
    ENERGY,
    FORCE,
    ROUGH,
    SLOPE,
    TILTING_VALUES,
    TableSolver,
    keep_rising,
    ray_curves,
)
from siggen.gears.contact.tilt_rays import RAYS, UPRIGHT, energy_j

COARSEST = 16
"""Columns from one that is solved on all rays to the next, before halving."""
BEND = 1e-2
"""Largest deviation of a ray's forces from its neighbours', of the force without tilt and a tenth of the largest."""
ROUGH_BEND = 0.05
"""Largest deviation of the share of the load on rough land from its neighbours'."""

TILTED = [ray for ray in range(1, RAYS.size - 1) if ray != UPRIGHT]
"""Rays that are solved."""


def tilted_columns(solver: TableSolver, row: KindRow, chosen: IntArray, upright: FloatArray) -> FloatArray:
    """Return the columns (chosen, nodes, rays, values) at fine points (chosen,) from those without tilt.

    `upright` (chosen, nodes, 1, values): of `column_curves`, which is returned where gears do not tilt.
    """
    if not solver.options.tilts:
        return upright
    scale = _scale(solver.node_m, upright)

    def solve(places: IntArray) -> FloatArray:
        return _rays(solver, row, chosen[places]) / scale[places]

    force = upright[:, : solver.reference + 1, :, FORCE].mean(axis=0)
    counts = force / (force + 0.1 * force[-1])

    def bent(low: FloatArray, middle: FloatArray, high: FloatArray, weight: float) -> bool:
        off = np.abs((1.0 - weight) * low + weight * high - middle)[: solver.reference + 1]
        return bool(np.any(off[:, :, FORCE] * counts > BEND) or np.any(off[:, :, ROUGH] > ROUGH_BEND))

    wanted = np.unique(np.append(np.arange(0, chosen.size, COARSEST), chosen.size - 1)).tolist()
    stations, shares = halved(wanted, solve, bent, 1)
    curves = scale * _between(chosen[stations], shares, chosen)
    curves[:, :, UPRIGHT] = upright[:, :, 0]
    keep_rising(solver.node_m, curves)
    pushed, slope = (np.moveaxis(curves[..., column], 1, -1) for column in (FORCE, SLOPE))
    curves[..., ENERGY] = np.moveaxis(energy_j(solver.node_m, pushed, slope), -1, 1)
    return np.asarray(curves)


def _scale(node_m: FloatArray, upright: FloatArray) -> FloatArray:
    """Return what values of a ray are shares of (chosen, nodes, 1, values)."""
    scale = np.ones_like(upright)
    force = upright[..., FORCE]
    scale[..., FORCE], scale[..., SLOPE], scale[..., ACROSS_SLOPE] = force, upright[..., SLOPE], force
    scale[..., ACROSS] = node_m[:, np.newaxis] * force
    return np.where(scale > 0.0, scale, 1.0)


def _rays(solver: TableSolver, row: KindRow, chosen: IntArray) -> FloatArray:
    """Return solved columns (chosen, nodes, rays, values); on the last rays a rigid corner only comes to touch."""
    curves = np.zeros((chosen.size, solver.node_m.size, RAYS.size, TILTING_VALUES))
    curves[:, :, TILTED] = ray_curves(solver, row, chosen, RAYS[TILTED])
    return curves


def _between(stations: IntArray, shares: FloatArray, chosen: IntArray) -> FloatArray:
    """Return the shares at fine points (chosen,), linear between stations."""
    at = np.interp(chosen, stations, np.arange(float(stations.size)))
    first = np.minimum(at.astype(np.int64), max(stations.size - 2, 0))
    weight = (at - first)[:, np.newaxis, np.newaxis, np.newaxis]
    return np.asarray(shares[first] + weight * (shares[np.minimum(first + 1, stations.size - 1)] - shares[first]))
