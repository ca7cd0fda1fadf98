"""The table over approach and tilt that the time loop reads, beside the solver at that tilt, on damaged pairs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.contact_spring import PairPlace, pair_spring
from siggen.dynamics.mesh.pair_law import MeshConstants, PairLaw, pair_law
from siggen.gears.contact.contact_table import ContactTable, contact_table
from siggen.gears.contact.face_slices import FaceSlices
from siggen.gears.contact.force_curve import force_curve
from siggen.gears.contact.kind_row import first_touch, kind_row, pits_of_kind
from siggen.gears.contact.newton_matrix import solver_room
from siggen.gears.contact.table_columns import NO_ENERGY, row_faces, table_solver
from siggen.gears.contact.table_options import TableOptions
from siggen.gears.geometry.missing_material import missing_material
from siggen.gears.stiffness.mesh_tables import pair_kinds
from siggen.specimen.contact import whole_face
from tests.reference.contact.case import bench_damages

REFERENCE_N = 1200.0
TILTS = (2e-5, 5e-5, 1e-4, 2e-4, 3e-4)
STATES = ("slight", "face_40", "face_80", "through_060")
EVERY, POINTS = 40, 2049
"""Fine points from one compared place to the next."""


@dataclass(frozen=True, slots=True)
class TiltError:
    """Largest and median error of F over 1,200 N, and of M over 1,200 N on half the face.

    `touching`: where a corner touches but not yet the whole face; else from there to 30 µm.
    """

    state: str
    tilt_rad: float
    touching: bool
    force_largest: float
    force_median: float
    moment_largest: float
    moment_median: float


def tilt_errors() -> Iterator[TiltError]:
    """Yield the errors for damages of bench and tilts to both sides."""
    pair, teeth, damages = bench_damages(STATES)
    options = TableOptions(tilts=True)
    healthy = kind_row(pair, teeth, options, POINTS)
    for state, damage in damages.items():
        row = kind_row(pair, teeth, options, POINTS, pits_of_kind(damage, pair_kinds(pair, damage)[1]), healthy)
        table = contact_table(pair, damage, teeth, options, POINTS)
        constants = MeshConstants(pair.line_of_action_m, 1.0, 80e-6)
        whole = whole_face(pair, damage, teeth, POINTS)
        law = pair_law(whole, missing_material(pair, None), constants, damping_ratio=0.0, contact=table)
        solver = table_solver(pair, teeth, options, np.zeros(len(row.gaps.left_m[0])))
        points = np.arange(row.first, row.first + len(row.gaps.left_m), EVERY)
        touch, faces = first_touch(pair, row, points, solver.lead_m), row_faces(solver, row, points)
        for tilt in TILTS:
            lift = tilt * table.half_face_m
            for touching, ways in ((True, np.linspace(-0.9, 1.0, 12) * lift), (False, np.linspace(lift, 3e-5, 12))):
                found = np.concatenate(
                    [
                        _errors(law, table, int(point), face, float(touched), ways, side)
                        for point, face, touched in zip(points, faces, touch, strict=True)
                        for side in (tilt, -tilt)
                    ]
                ) / (REFERENCE_N, REFERENCE_N * table.half_face_m)
                force, moment = np.abs(found).T
                sizes = force.max(), np.median(force), moment.max(), np.median(moment)
                yield TiltError(state, tilt, touching, *map(float, sizes))


def _errors(
    law: PairLaw, table: ContactTable, point: int, face: FaceSlices, touch_m: float, ways_m: np.ndarray, tilt: float
) -> np.ndarray:
    """Return the errors of force and moment (k, 2) at approaches beyond first touch."""
    count = face.face_m.size
    exact = force_curve(face, touch_m + ways_m, tilt, np.zeros(count), solver_room(count), NO_ENERGY)
    cell = min(point, POINTS - 2)
    column = float(table.column[1, cell] + table.gain[1, cell] * (point - cell))
    first = min(int(column), len(table.curves) - 2)
    begins = float(law.places[layout.CURVES_AT] + first * table.curves[0].size)
    place = PairPlace(0.0, 0.0, begins, column - first, 0.0)
    read = [pair_spring(law, place, tilt, float(way)) for way in ways_m]
    return np.array([(one.force, one.moment) for one in read]) - np.stack([exact.force_n, exact.moment_n_m], axis=1)
