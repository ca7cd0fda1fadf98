"""What a recess beside the contact adds to the influence of a half plane: finite elements of the cut and uncut body.

The body is a wide block in plane strain with a rectangular recess, meshed by a tensor grid that is graded to the
recess's edges and floor (quadratic quadrilaterals of scikit-fem). The same grid with and without the recess gives the
difference of the two influence matrices: outer boundaries, datum and most of the mesh error drop out of it. It is added
to the exact matrix of two half planes (`plane_contact.log_influence`), so the mate is whole and the recess is in one
body. Half of the block is meshed; loads even and odd about the recess's middle give both edges.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import pi, sqrt

import numpy as np

from tests.reference.contact.plane_contact import PlaneContact, sink, solve_cells

BLOCK_M = 60e-3
"""Half length and depth of the block: 40 to 200 times the recess."""
FINEST_M, GROWTH = 2e-8, 1.3
LAND_M, LAND_CELL_M = 0.26e-3, 3e-6
"""Width of the loaded land beside the edge and its widest pressure cell (a twentieth of a Hertz half width)."""
POISSON = 0.3
LONG_M = 6e-3
"""Length of a recess whose other edge does not matter."""


@dataclass(frozen=True, slots=True)
class RecessInfluence:
    """Added influence times 1/κ of unit loads on the cells (k, 2) of the left land [m], edge at x = 0.

    `own` (k, k): on the same land; `across` (k, k): on the mirrored cells of the right land.
    """

    ends: np.ndarray
    own: np.ndarray
    across: np.ndarray


def graded(start: float, end: float, first: float, last: float, growth: float, widest: float = np.inf) -> np.ndarray:
    """Return marks from `start` to `end` with cells that grow from both ends and are at most `widest`."""
    left, right = [first], [last]
    span = end - start
    while sum(left) + sum(right) < span:
        side = left if left[-1] <= right[-1] else right
        side.append(min(side[-1] * growth, widest))
    widths = np.array(left + right[::-1])
    return start + np.concatenate([[0.0], np.cumsum(widths * span / widths.sum())])


@lru_cache(maxsize=16)
def recess_influence(length_m: float, depth_m: float, growth: float = GROWTH) -> RecessInfluence:
    """Return the added influence of a recess of length and depth [m]."""
    half = 0.5 * length_m
    outer = graded(-BLOCK_M, -LAND_M, 5e-3, 1.5 * LAND_CELL_M, growth)
    land = graded(-LAND_M, 0.0, LAND_CELL_M, FINEST_M, growth, LAND_CELL_M)
    recess = graded(0.0, half, FINEST_M, half / 8.0, growth)
    x = np.concatenate([outer, land[1:], recess[1:]])
    upper = graded(0.0, depth_m, FINEST_M, depth_m / 50.0, growth)
    y = np.concatenate([upper, graded(depth_m, BLOCK_M, depth_m / 50.0, 5e-3, growth)[1:]])
    loaded = np.column_stack([land[:-1], land[1:]])
    even, odd = (
        _means(x, y, depth_m, loaded, symmetric=symmetric) - _means(x, y, 0.0, loaded, symmetric=symmetric)
        for symmetric in (True, False)
    )
    return RecessInfluence(loaded, 0.5 * (even + odd), 0.5 * (even - odd))


def _means(x: np.ndarray, y: np.ndarray, depth: float, loaded: np.ndarray, *, symmetric: bool) -> np.ndarray:
    """Return mean deflections (k, k) of the cells under unit loads, times E over the pair's κ E."""
    from scipy.sparse.linalg import splu
    from skfem import Basis, ElementQuad2, ElementVector, FacetBasis, LinearForm, MeshQuad
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    mesh = MeshQuad.init_tensor(x, -y[::-1])
    if depth > 0.0:
        mesh = mesh.remove_elements(mesh.elements_satisfying(lambda p: (p[0] > 0.0) & (p[1] > -depth)))
    element = ElementVector(ElementQuad2())
    basis = Basis(mesh, element)
    stiffness = linear_elasticity(*lame_parameters(1.0, POISSON)).assemble(basis)
    facets = mesh.facets_satisfying(lambda p: (abs(p[1]) < 1e-12) & (p[0] > loaded[0, 0]) & (p[0] < 0.0))
    order = np.argsort(mesh.p[0, mesh.facets[:, facets]].mean(axis=0))
    push = LinearForm(lambda v, _: -v[1])
    loads = np.column_stack([push.assemble(FacetBasis(mesh, element, facets=facets[[i]])) for i in order])
    loads = loads / (loaded[:, 1] - loaded[:, 0])
    bottom = basis.get_dofs(lambda p: p[1] < -BLOCK_M * (1.0 - 1e-9)).all()
    side = basis.get_dofs(lambda p: p[0] < -BLOCK_M * (1.0 - 1e-9)).all("u^1")
    centre = basis.get_dofs(lambda p: p[0] > x[-1] - 1e-12).all("u^1" if symmetric else "u^2")
    fixed = np.unique(np.concatenate([bottom, side, centre]))
    free = np.setdiff1d(np.arange(basis.N), fixed)
    solver = splu(stiffness[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    means = loads[free].T @ solver.solve(loads[free])
    return means / (4.0 * (1.0 - POISSON**2) / pi)


def notched_gap_sink(
    offset: float, length: float, depth: float, radius: float, load_kappa: float
) -> tuple[float, float]:
    """Return the sink [m] at `offset` from the middle of a recess with two edges, and the share of the left edge."""
    added = recess_influence(length, depth)
    left = added.ends - 0.5 * length
    right = -left[::-1, ::-1]
    across = added.across[:, ::-1]
    extra = np.block([[added.own, across], [across.T, added.own[::-1, ::-1]]])
    ends = np.vstack([left, right])
    contact = solve_cells(ends, offset, radius, load_kappa, extra)
    return sink(contact), contact.share(ends[:, 1] <= 0.0)


def notched_edge_sink(beyond: float, depth: float, radius: float, load_kappa: float) -> float:
    """Return the sink [m] at one edge of a long recess; `beyond` as in `plane_contact.edge_sink`."""
    half_width = sqrt(2.0 * radius * load_kappa)
    if beyond + half_width > LAND_M:
        raise ValueError(f"beyond: received {beyond} m; the loaded land of {LAND_M} m is too short for it")
    added = recess_influence(LONG_M, depth)
    return sink(_one_edge(added, beyond, radius, load_kappa))


def _one_edge(added: RecessInfluence, beyond: float, radius: float, load_kappa: float) -> PlaneContact:
    return solve_cells(added.ends, -beyond, radius, load_kappa, added.own)
