"""How far the force of a contact table is from that of the solver, between its columns and approaches."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.part import Damage
from siggen.gears.gear_pair import GearPair
from siggen.mesh.contact_table import (
    FORCE,
    SLOPE,
    ContactTable,
    KindRow,
    TableSolver,
    first_touch,
    kind_row,
    pits_of_kind,
    row_faces,
    table_solver,
)
from siggen.mesh.mesh_tables import pair_kinds
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions, face_slices
from tests.gears.contact.faces import force_curve

APPROACHES = (0.12, 0.25, 0.4, 0.6)
"""Of the approach of the reference force, at which forces are compared."""


class ContactTableError(NamedTuple):
    """Errors of the force over a reference force: root mean square, 95 % and largest."""

    rms: float
    most: float
    largest: float


def contact_table_error(
    pair: GearPair,
    damage: Damage,
    stiffness: StiffnessOptions,
    options: TableOptions,
    table: ContactTable,
    reference_n: float,
    places: int = 40,
    lead_m: FloatArray | None = None,
) -> ContactTableError:
    """Return the errors at places in the middle of fine intervals near damage, evenly spread; of sound teeth without.

    Parameters
    ----------
    pair, damage, stiffness, options
        What the table was made of.
    table : ContactTable
    reference_n : float
        Force that errors are shares of [N].
    places : int
        Per kind of damaged pair.
    lead_m : (slices,) or None
        Missing material across the face that the table was made with.
    """
    lead = np.zeros(face_slices(pair, options)) if lead_m is None else lead_m - np.min(lead_m)
    solver = table_solver(pair, stiffness, options, lead)
    fine = 2 * table.touch_m.shape[1] - 1  # every second point is the middle of an interval
    errors = [np.zeros(1)]
    kinds = pair_kinds(damage)
    for row, kind in [*enumerate(kinds)][1:] or [(0, kinds[0])]:
        middles = kind_row(pair, stiffness, options, fine, pits_of_kind(damage, kind))
        near = np.flatnonzero((table.column[row] >= options.healthy_columns) | (row == 0))
        for cell in near[:: max(1, near.size // places)].tolist():
            errors.append(_errors_at(solver, middles, table, row, cell))
    found = np.abs(np.concatenate(errors)) / reference_n
    return ContactTableError(float(np.sqrt(np.mean(found**2))), float(np.quantile(found, 0.95)), float(found.max()))


def _errors_at(solver: TableSolver, row: KindRow, table: ContactTable, number: int, cell: int) -> FloatArray:
    """Return the errors [N] in the middle of a fine interval."""
    from scipy.interpolate import CubicHermiteSpline

    place = np.array([2 * cell + 1])
    touch = float(first_touch(solver.pair, row, place, solver.lead_m)[0])
    approach = touch + np.array(APPROACHES) * solver.node_m[solver.reference]
    slices = row_faces(solver, row, place)[0]
    direct = force_curve(slices, approach, 0.0)
    column = float(table.column[number, cell] + 0.5 * table.gain[number, cell])
    first = min(int(column), len(table.curves) - 2)
    beyond = approach - float(table.touch_m[number, cell : cell + 2].mean())
    low, high = (
        CubicHermiteSpline(solver.node_m, curve[:, FORCE], curve[:, SLOPE])(np.clip(beyond, 0.0, solver.node_m[-1]))
        for curve in table.upright[first : first + 2]
    )
    return np.asarray(low + (column - first) * (high - low) - direct.force_n)
