"""Numbers of the library beside those of the independent solvers: edges, gaps, notches, losses across the face."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from siggen.mesh import contact_edges as two_edges
from tests.reference.contact.case import (
    KAPPA,
    RADIUS_M,
    REST_M_PER_N,
    RIGID,
    Teeth,
    answer_under,
    approach_under,
    face_of_land,
)
from tests.reference.contact.face_contact import FaceCase, approach_at, land_of_gap, land_of_pits

AHEAD = (1.5, 1.0, 0.5, 0.0, -1.0, -3.7, -6.0, -11.0)
SHARES = (0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.2)
"""Offsets of the normal from mid-gap over half its length."""
LANDS = {
    "gap of 30 % in the middle": lambda case: land_of_gap(case, 0.3),
    "gap of 50 % in the middle": lambda case: land_of_gap(case, 0.5),
    "gap of 80 % in the middle": lambda case: land_of_gap(case, 0.8),
    "gap of 30 % at one end": lambda case: land_of_gap(case, 0.3, 0.0),
    "gap of 50 % at one end": lambda case: land_of_gap(case, 0.5, 0.0),
    "gap of 80 % at one end": lambda case: land_of_gap(case, 0.8, 0.0),
    "10 pits of 0.6 mm": lambda case: land_of_pits(case, 10),
    "16 pits of 0.6 mm": lambda case: land_of_pits(case, 16),
}


FINE_M, SLIVER = 0.01e-3, 1e-9
"""Cells from which parts of slices are counted, and the part that does not count."""


def _law(length: float, depth: float, offset: float, line: float) -> two_edges.GapSink:
    return two_edges.gap_sink(0.5 * length + offset, 0.5 * length - offset, depth, 0.0, RADIUS_M, 0.0, KAPPA * line)


@dataclass(frozen=True, slots=True)
class Loss:
    """Loss of pair stiffness at a force, in per cent: contact in three dimensions, and the library with n slices."""

    land: str
    force_n: float
    solver: float
    library: dict[int, float]


def losses(
    force_n: float, slices: tuple[int, ...] = (200,), cell_m: float = 0.05e-3, teeth: Teeth = RIGID
) -> Iterator[Loss]:
    """Yield the losses of all `LANDS`."""
    case = face_case(cell_m, teeth)
    rest = REST_M_PER_N - teeth.compliance_m_per_n
    whole = approach_at(case, np.ones(round(case.face_width_m / cell_m), bool), force_n)[0]
    healthy = {n: approach_under(face_of_land(np.ones(n), teeth), force_n) for n in slices}
    for name, land in LANDS.items():
        damaged = approach_at(case, land(case), force_n, reach=6.0)[0]
        solver = 1.0 - (rest + whole / force_n) / (rest + damaged / force_n)
        library = {}
        for n in slices:
            face = face_of_land(_parts(land(replace(case, cell_m=FINE_M)), n), teeth)
            library[n] = 100.0 * (1.0 - healthy[n] / approach_under(face, force_n))
        yield Loss(name, force_n, 100.0 * solver, library)


def _parts(land: np.ndarray, slices: int) -> np.ndarray:
    """Return which part of every slice (slices,) is land, from cells (k,) that are or are not."""
    edges = np.linspace(0.0, land.size, slices + 1)
    below = np.concatenate([[0.0], np.cumsum(land)])
    parts = np.diff(np.interp(edges, np.arange(land.size + 1), below)) * slices / land.size
    return np.where(parts > 1.0 - SLIVER, 1.0, np.where(parts < SLIVER, 0.0, parts))


def face_case(cell_m: float, teeth: Teeth) -> FaceCase:
    """Return the case of the contact in three dimensions with these teeth."""
    return FaceCase(cell_m=cell_m, tooth_length_m=teeth.length_m, tooth_m_per_n=teeth.compliance_m_per_n)


@dataclass(frozen=True, slots=True)
class Tilted:
    """Whole face under a tilt at a force: approach [m] and moment [N m] of the library and in three dimensions."""

    tilt_rad: float
    force_n: float
    approach_m: float
    moment_n_m: float
    solver_approach_m: float
    solver_moment_n_m: float


def tilted(force_n: float, slices: int = 100, cell_m: float = 0.1e-3, teeth: Teeth = RIGID) -> Iterator[Tilted]:
    """Yield tilts of 20 to 400 µrad."""
    case = face_case(cell_m, teeth)
    count = round(case.face_width_m / cell_m)
    y = (np.arange(count) + 0.5) * cell_m - 0.5 * case.face_width_m
    rest = force_n * (REST_M_PER_N - teeth.compliance_m_per_n)
    for tilt in (2e-5, 1e-4, 2e-4, 4e-4):
        approach, line = approach_at(case, np.ones(count, bool), force_n, 4.0, tilt)
        answer = answer_under(face_of_land(np.ones(slices), teeth), force_n, tilt)
        yield Tilted(tilt, force_n, answer[0], answer[1], approach + rest, float(line @ y) * cell_m)
