"""Loads of the slices of a face under a given force and tilt: the approach is what is looked for (derived)."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.contact.face_force import face_force
from siggen.gears.contact.face_slices import FaceSlices, slice_of, slice_sink
from siggen.gears.contact.newton_matrix import solver_room

CLOSE = 1e-6
"""Error of the force that is left, over the force."""
MOST_STEPS = 60


def loads_under_force(slices: FaceSlices, force_n: float, tilt_rad: float = 0.0) -> FloatArray:
    """Return the loads κq (n,) [m] that add up to a force; 0 for no force.

    Raises
    ------
    ValueError
        If no approach gives the force.
    """
    loads, room = np.zeros(slices.face_m.size), solver_room(slices.face_m.size)
    if force_n <= 0.0:
        return loads
    # First touch by rigid flanks, then as if the whole pair were linear: both ends of a bracket, stretched if needed.
    sinks = np.array([slice_sink(slice_of(slices, i), 0.0).sink_m for i in range(loads.size)])
    low = float((sinks + slices.lead_m - tilt_rad * slices.face_m).min())
    teeth = slices.teeth.sum * slices.kappa_per_pa / (slices.kernel.cell_m * loads.size)
    high, step = np.inf, 2.0 * (slices.compliance_m_per_n + teeth) * force_n + 1e-7
    approach = low + step
    for _ in range(MOST_STEPS):
        found = face_force(slices, approach, tilt_rad, loads, room)
        if found.passes < 0:
            loads[:] = 0.0
            found = face_force(slices, approach, tilt_rad, loads, room)
        missing = force_n - found.force_n
        if found.passes > 0 and abs(missing) <= CLOSE * force_n:
            return loads
        low, high = (approach, high) if missing > 0.0 else (low, approach)
        wanted = approach + missing / found.stiffness_n_per_m if found.stiffness_n_per_m > 0.0 else low
        if not low < wanted < high:
            wanted = 0.5 * (low + high) if np.isfinite(high) else approach + 2.0 * step
        approach = wanted
    raise ValueError(f"force_n: received {force_n:.6g}; allowed: a force that the face carries")
