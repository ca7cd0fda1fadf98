"""SlicePressures: line load and largest elastic pressures of the slices of a loaded face.

Derived. A slice away from damage has Hertz's pressure 2q/(πa) of its own load, a² = 2Rκq. Where it meets a gap of the
damage its load rests on the edges in the shares of `two_edges`, each with the pressure of `edge_pressure`, unless the
floor of the gap carries. Tips count as plain: their corners have no radius in the model.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.gears.contact.covered_slice import load_apart
from siggen.gears.contact.edge_law import NO_EDGE
from siggen.gears.contact.edge_pressure import largest_edge_pressure
from siggen.gears.contact.face_slices import FaceSlices, slice_of, slice_sink


class SlicePressures(NamedTuple):
    """Of every slice (n,): load per length [N/m], and largest pressure [Pa], Hertz's or that at edges of damage.

    `at_edge` (n,): 1 where edges of damage carry more than Hertz's pressure, else 0.
    """

    line_load_n_per_m: FloatArray
    pressure_pa: FloatArray
    at_edge: FloatArray


def slice_pressures(slices: FaceSlices, loads_m: FloatArray) -> SlicePressures:
    """Return loads and pressures of slices that carry κq = `loads_m` (n,) [m].

    Edges need a radius (`rounding_m` > 0): the pressure at a sharp one is infinite, and is given as such.
    """
    pressure, at_edge = _pressures(slices, np.ascontiguousarray(loads_m))
    return SlicePressures(loads_m / slices.kappa_per_pa, pressure, at_edge)


@entry(cache=True)
def _pressures(slices: FaceSlices, loads: FloatArray) -> tuple[FloatArray, FloatArray]:
    kappa, rounding = slices.kappa_per_pa, slices.rounding_m
    pressure, at_edge = np.zeros(loads.size), np.zeros(loads.size)
    for i in range(loads.size):
        load, radius = loads[i], slices.radii_m[i]
        if load <= 0.0:
            continue
        one = slice_of(slices, i)
        gap = slice_sink(one, load)
        land = load
        if 0.0 < slices.covered[i] < 1.0:
            apart = load_apart(one, load)
            land, load = load + slices.covered[i] * apart, load - (1.0 - slices.covered[i]) * apart
        pressure[i] = np.sqrt(2.0 * max(land, load) / radius) / (np.pi * kappa)
        left, right = slices.left_m[i], slices.right_m[i]
        on_floor = slices.floor_m[i] > 0.0 and gap.sink_m >= slices.floor_m[i]
        if load <= 0.0 or slices.notch_m[i] <= 0.0 or on_floor or max(left, right) < -0.5 * NO_EDGE:
            continue
        for ahead, share in ((-left, gap.left_share), (-right, 1.0 - gap.left_share)):
            if share <= 1e-6 or ahead >= np.sqrt(2.0 * radius * load * share):
                continue
            found = np.inf
            if rounding > 0.0:
                found = largest_edge_pressure(ahead, radius, rounding, load * share / kappa, kappa)
            if found > pressure[i]:
                pressure[i], at_edge[i] = found, 1.0
    return pressure, at_edge
