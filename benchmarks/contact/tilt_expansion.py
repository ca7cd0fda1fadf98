"""The expansion in the tilt that the time loop reads, beside the solver at that tilt, on columns of damaged pairs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from benchmarks.contact.case import bench_damages
from siggen.gears.contact.face_slices import FaceSlices
from siggen.gears.contact.force_curve import force_curve
from siggen.gears.contact.kind_row import first_touch, kind_row, pits_of_kind
from siggen.gears.contact.newton_matrix import solver_room
from siggen.gears.contact.table_columns import (
    FORCE,
    MOMENT,
    MOMENT_SLOPE,
    NO_ENERGY,
    SLOPE,
    TOUCHING,
    TURNING,
    TURNING_SLOPE,
    column_curves,
    row_faces,
    table_solver,
)
from siggen.gears.contact.table_options import TableOptions
from siggen.gears.stiffness.mesh_tables import pair_kinds

LARGEST_N, REFERENCE_N = 4000.0, 1200.0
TILTS = (2e-5, 5e-5, 1e-4, 2e-4)
STATES = ("slight", "face_40", "face_80", "through_060")
EVERY = 40
"""Fine points from one compared column to the next."""


@dataclass(frozen=True, slots=True)
class TiltError:
    """Largest and rms error of F over 1,200 N and the largest of M over 1,200 N on half the face.

    `touching`: over approaches less than 5 % of the reach beyond first touch, where a tilted face comes to touch; else
    from there to 0.8 of the reach.
    """

    state: str
    tilt_rad: float
    touching: bool
    force_largest: float
    force_rms: float
    moment_largest: float


def tilt_errors() -> Iterator[TiltError]:
    """Yield the errors for damages of bench and tilts to both sides."""
    pair, teeth, damages = bench_damages(STATES)
    options = TableOptions(LARGEST_N, tilts=True)
    healthy = kind_row(pair, teeth, options, 2049)
    for state, damage in damages.items():
        kind = pair_kinds(pair, damage)[1]
        row = kind_row(pair, teeth, options, 2049, pits_of_kind(damage, kind), healthy)
        slices = len(row.gaps.left_m[0])
        solver = table_solver(pair, teeth, options, np.zeros(slices))
        chosen = np.arange(row.first, row.first + len(row.gaps.left_m), EVERY)
        touch = first_touch(pair, row, chosen, solver.lead_m)
        columns = list(zip(column_curves(solver, row, chosen), row_faces(solver, row, chosen), touch, strict=True))
        reach = solver.node_m[-1]
        way = (TOUCHING + 0.01) * reach
        for tilt in TILTS:
            for touching, beyond in (
                (True, np.linspace(0.1, 1.0, 10) * way),
                (False, np.linspace(way, 0.8 * reach, 16)),
            ):
                found = np.array([_errors(solver.node_m, *c, beyond, side) for c in columns for side in (tilt, -tilt)])
                force, moment = found[:, 0] / REFERENCE_N, found[:, 1] / (0.5 * pair.face_width_m * REFERENCE_N)
                sizes = np.abs(force).max(), np.sqrt(np.mean(force**2)), np.abs(moment).max()
                yield TiltError(state, tilt, touching, *map(float, sizes))


def _errors(
    node_m: np.ndarray, curve: np.ndarray, slices: FaceSlices, touch_m: float, beyond_m: np.ndarray, tilt_rad: float
) -> np.ndarray:
    """Return the errors of force and moment (2, k), read as `contact_spring` does."""
    count = slices.face_m.size
    exact = force_curve(slices, touch_m + beyond_m, tilt_rad, np.zeros(count), solver_room(count), NO_ENERGY)
    force, moment, turning = (
        CubicHermiteSpline(node_m, curve[:, value], curve[:, slope])
        for value, slope in ((FORCE, SLOPE), (MOMENT, MOMENT_SLOPE), (TURNING, TURNING_SLOPE))
    )
    bend = 0.5 * tilt_rad**2 * turning.derivative()(beyond_m)
    expanded = np.maximum(force(beyond_m) + tilt_rad * moment.derivative()(beyond_m) + bend, 0.0)
    turned = moment(beyond_m) + tilt_rad * turning(beyond_m)
    return np.array([expanded - exact.force_n, turned - exact.moment_n_m])
