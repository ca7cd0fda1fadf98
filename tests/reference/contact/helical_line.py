"""Load along the sloping contact line of a helical pair under tilts of its shafts, beside contact in three dimensions.

In the plane of the flank's normal the line is a cylinder whose radius changes along it, on half spaces
(`face_contact`), and on two teeth each of which gives way as at its own height there. The library reckons in the
transverse plane, with one radius for all slices and one kernel for both teeth. Lengths along the line are those of the
face over cos β_b.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, radians, tan

import numpy as np

from siggen.gears.contact.kind_row import kind_row
from siggen.gears.contact.loads_under_force import loads_under_force
from siggen.gears.contact.pair_rest import bending_length_m
from siggen.gears.contact.table_columns import row_faces, table_solver
from siggen.gears.contact.table_options import TableOptions, face_slices
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.helical import transverse_gear
from siggen.gears.stiffness.body_coupling import ring_torsion
from siggen.gears.stiffness.compliance import axial_part, tooth_compliance
from siggen.gears.stiffness.hertz import centre_line_depth
from siggen.gears.stiffness.mesh_stiffness import rolls_at
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from tests.reference.contact.face_contact import FaceCase
from tests.reference.finite_elements.spatial_pair import bench_pair, spatial_pair

HELICES_DEG, FORCES_N, TILTS_RAD = (15.0, 25.0), (300.0, 1200.0), (0.0, 5e-5, -5e-5, 2e-4, -2e-4)
CELLS, PARTS = 200, 20
TEETH = StiffnessOptions()


@dataclass(frozen=True, slots=True)
class HelicalLine:
    """Moment about the middle of the face of library and solver, and largest error of the load of any 1 mm of it.

    Errors are over the mean load of 1 mm.
    """

    helix_deg: float
    force_n: float
    tilt_rad: float
    moment_nm: float
    solver_moment_nm: float
    largest: float


def helical_lines() -> Iterator[HelicalLine]:
    """Yield forces and tilts; the middle of the face is in the middle of the path, the whole line is on it."""
    for helix_deg in HELICES_DEG:
        pair = _pair(helix_deg)
        for force in FORCES_N:
            for tilt in TILTS_RAD:
                yield _compared(pair, helix_deg, force, tilt)


def _pair(helix_deg: float) -> GearPair:
    spur, helix = bench_pair(), radians(helix_deg)
    gears = [transverse_gear(spur.member(which), helix) for which in ("pinion", "gear")]
    return GearPair(gears[0], gears[1], spur.face_width_m, 206e9, 0.3, helix_rad=helix)


def _compared(pair: GearPair, helix_deg: float, force_n: float, tilt_rad: float) -> HelicalLine:
    face, library = _library(pair, force_n, tilt_rad)
    across, solver = _three_dimensions(pair, force_n, tilt_rad)
    width = pair.face_width_m
    moments = (float(load @ y) * width / y.size for y, load in ((face, library), (across, solver)))
    error = (_parts(library) - _parts(solver)) / (force_n / width)
    return HelicalLine(helix_deg, force_n, tilt_rad, *moments, float(np.abs(error).max()))


def _parts(load: np.ndarray) -> np.ndarray:
    """Return mean loads (PARTS,) of equal parts of the face from those of equal slices (k,)."""
    total = np.concatenate([[0.0], np.cumsum(load)]) / load.size
    return np.diff(np.interp(np.linspace(0.0, 1.0, PARTS + 1), np.linspace(0.0, 1.0, total.size), total)) * PARTS


def _library(pair: GearPair, force_n: float, tilt_rad: float) -> tuple[np.ndarray, np.ndarray]:
    """Return places of the slices from the middle of the face [m] and their loads per face width [N/m]."""
    options, points = TableOptions(tilts=True), 3
    solver = table_solver(pair, TEETH, options, np.zeros(face_slices(pair, options)))
    middle = row_faces(solver, kind_row(pair, TEETH, options, points), np.array([1]))[0]
    return middle.face_m, loads_under_force(middle, force_n, tilt_rad) / middle.kappa_per_pa


def _three_dimensions(pair: GearPair, force_n: float, tilt_rad: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the same of cells, by pressures in the plane of the normal."""
    share = cos(pair.base_helix_rad)
    across = pair.face_width_m * ((np.arange(CELLS) + 0.5) / CELLS - 0.5)
    place = 0.5 * (pair.contact_start_m + pair.contact_end_m) + across * tan(pair.base_helix_rad)
    radius = place * (pair.line_of_action_m - place) / pair.line_of_action_m / share
    depths = [
        centre_line_depth(pair, w, roll) for w, roll in zip(("pinion", "gear"), rolls_at(pair, place), strict=True)
    ]
    case = FaceCase(
        face_width_m=pair.face_width_m / share,
        radius_m=float(radius.mean()),
        depth_m=float(np.sqrt(depths[0] * depths[1])[CELLS // 2]),
        cell_m=pair.face_width_m / share / CELLS,
    )
    teeth = share**2 * sum(_tooth(pair, which, place) for which in ("pinion", "gear"))
    found = spatial_pair(case, teeth, np.ones(CELLS, bool), -share * tilt_rad * across, force_n / share, radius)
    return across, found.line_load


def _tooth(pair: GearPair, which: str, place_m: np.ndarray) -> np.ndarray:
    """Return how one tooth gives way in the transverse plane from cell to cell (cells, cells) [m/N].

    Derived: springs of the tooth at every height hang together over the length l: p t - mean(p) l² t'' = C b q with
    free ends, C the least compliance along the line and p its share of that at the place. Differences of second order.
    """
    rolls = dict(zip(("pinion", "gear"), rolls_at(pair, place_m), strict=True))[which]
    rigid = ring_torsion(pair.member(which), pair.poisson_ratio) / (pair.youngs_modulus_pa * pair.face_width_m)
    own = tooth_compliance(pair, which, rolls, TEETH).total - axial_part(pair, which, rolls, TEETH) - rigid
    spring = own.min() / own
    cell = pair.face_width_m / place_m.size
    ends = np.full(place_m.size, 2.0)
    ends[[0, -1]] = 1.0
    curve = np.diag(ends) - np.eye(place_m.size, k=1) - np.eye(place_m.size, k=-1)
    hanging = spring.mean() * (bending_length_m(pair) / cell) ** 2 * curve
    return np.linalg.inv(np.diag(spring) + hanging) * own.min() * place_m.size
