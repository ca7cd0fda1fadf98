"""Shares of the load that slices of a healthy helical pair carry, solved across the face under a typical force."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.contact.kind_row import kind_row
from siggen.gears.contact.loads_under_force import loads_under_force
from siggen.gears.contact.table_columns import TYPICAL_SHARE, row_faces, table_solver
from siggen.gears.contact.table_options import TableOptions, face_slices
from siggen.gears.geometry.face_shares import FaceShares
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.helical import slice_shifts_m
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

STEP = 0.03
"""Of the force, by which it is raised and lowered."""


def load_shares(
    pair: GearPair, stiffness: StiffnessOptions, options: TableOptions, lead_m: FloatArray | None = None
) -> FaceShares:
    """Return the shares at as many positions as a healthy pair has columns; arguments as for `contact_table`.

    Source: derived. The force is that which decides in the table which slices count as carrying.
    """
    slices = face_slices(pair, options)
    lead = np.zeros(slices) if lead_m is None else np.asarray(lead_m, dtype=np.float64)
    solver = table_solver(pair, stiffness, options, lead - lead.min())
    row = kind_row(pair, stiffness, options, options.healthy_columns)
    force_n = TYPICAL_SHARE * pair.reference_force_n
    chosen = np.arange(options.healthy_columns)
    faces = row_faces(solver, row, chosen)
    low, high = (
        np.stack([loads_under_force(one, force) for one in faces])
        for force in ((1.0 - STEP) * force_n, (1.0 + STEP) * force_n)
    )
    share, yielding = (loads / loads.sum(axis=1, keepdims=True) for loads in (low + high, high - low))
    for array in (share, yielding):
        array.setflags(write=False)
    ends = float(row.position_m[0]), float(row.position_m[-1])
    return FaceShares(*ends, slice_shifts_m(pair, slices), share, yielding)
