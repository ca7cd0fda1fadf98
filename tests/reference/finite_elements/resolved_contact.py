"""Stiffness of one tooth pair by plane finite elements of both gears with the contact resolved.

The flank is meshed finely about the contact. Unit pressures on its facets give the influence of facet on facet for each
gear, body, tooth and contact in one; the sum over both gears and the gap of two involutes is solved for pressures that
never pull (`tests.reference.contact.plane_contact.least_energy`). No formula for the contact is in it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from siggen.gears.gear_pair import GearPair, SpurGear
from tests.reference.contact.plane_contact import least_energy
from tests.reference.finite_elements.tooth_compliance_fem import (
    PlaneElasticity,
    interior_functionals,
    lines_of_action,
    plane_basis,
    solve,
)
from tests.reference.finite_elements.tooth_mesh import flank, tooth_mesh

STRAIN = PlaneElasticity(plane_strain=True)
SIZE = 0.08
REACH = 1.6
"""Half length of the fine zone in Hertz half widths."""
CELLS_PER_WIDTH = 16


@dataclass(frozen=True, slots=True)
class ResolvedPair:
    """Compliance of a pair at one position under a line load, times E b: with its contact, and of that the teeth alone.

    `total`: approach over force; `teeth`: both teeth read at their centre lines; `share`: of the fine zone in contact.
    """

    total: float
    teeth: float
    share: float


def resolved_pair(
    pair: GearPair,
    position_m: float,
    line_load_n_per_m: float,
    elasticity: PlaneElasticity = STRAIN,
    cells_per_width: int = CELLS_PER_WIDTH,
    size: float = SIZE,
) -> ResolvedPair:
    """Return the pair at the position on the line of action.

    Parameters
    ----------
    pair : GearPair
        The pair.
    position_m : float
        Distance from where the line of action touches the pinion's base circle [m].
    line_load_n_per_m : float
        Force over face width.
    elasticity : PlaneElasticity
        Plane strain or stress.
    cells_per_width : int
        Facets in a Hertz half width.
    size : float
        Edge length elsewhere on the tooth, in modules.

    Raises
    ------
    ValueError
        If the fine zone leaves one of the flanks.
    RuntimeError
        If the contact reaches the end of the fine zone.
    """
    module = pair.pinion.module_m
    reach = (position_m, pair.line_of_action_m - position_m)
    radius = reach[0] * reach[1] / pair.line_of_action_m
    load = line_load_n_per_m / (pair.youngs_modulus_pa * module)
    width = sqrt(8.0 * load * radius / module * (1 - elasticity.poisson_ratio**2) / np.pi)
    count = round(REACH * cells_per_width)
    marks = np.arange(-count, count + 1) / cells_per_width * width
    first, teeth_1 = _influence(pair.pinion, reach[0], marks, elasticity, size)
    second, teeth_2 = _influence(pair.gear, reach[1], -marks[::-1], elasticity, size)
    low, high = marks[:-1], marks[1:]
    gap = (low * low + low * high + high * high) / 3.0 / (2.0 * radius / module)
    approach, pressure = least_energy(first + second[::-1, ::-1], gap, load)
    if pressure[0] > 0.0 or pressure[-1] > 0.0:
        raise RuntimeError("the contact reaches the end of the fine zone; allowed: a larger REACH")
    return ResolvedPair(approach / load, teeth_1 + teeth_2, float(np.mean(pressure > 0.0)))


def _influence(
    gear: SpurGear, reach_m: float, marks: np.ndarray, elasticity: PlaneElasticity, size: float
) -> tuple[np.ndarray, float]:
    """Return mean deflections (k, k) of the facets between marks (k + 1,) along the flank towards the tip, and c.

    c: deflection at the centre line under a unit force at the contact; all along the line of action, times E b.
    """
    from skfem import FacetBasis, LinearForm

    base = gear.base_radius_m / gear.module_m
    square = (reach_m / gear.base_radius_m) ** 2 + 2.0 * marks / base
    if square[0] <= gear.involute_start_roll_rad**2 or square[-1] >= gear.tip_roll_rad**2:
        raise ValueError(
            f"the fine zone about {1e3 * reach_m:.3f} mm leaves the involute of the {gear.teeth}-tooth gear"
        )
    roll = np.sqrt(square)
    middle = np.array([[reach_m / gear.base_radius_m]])
    crossing, way = lines_of_action(gear, middle)
    along = way[0, 0]
    mesh = tooth_mesh(gear, roll[None, :], size)
    basis = plane_basis(mesh)
    points = flank(gear, roll)
    middles = (points[1:] + points[:-1]) / 2
    facets = basis.mesh.boundary_facets()
    centres = basis.mesh.p[:, basis.mesh.facets[:, facets]].mean(axis=1).T
    index = [facets[np.argmin(np.hypot(*(centres - m).T))] for m in middles]
    push = LinearForm(lambda v, _: along[0] * v[0] + along[1] * v[1])
    loads = np.column_stack([push.assemble(FacetBasis(basis.mesh, basis.elem, facets=np.array([i]))) for i in index])
    loads = loads / np.hypot(*np.diff(points, axis=0).T)
    answer = solve(basis, mesh.bore_radius, loads, elasticity)
    read = interior_functionals(basis, crossing.reshape(-1, 2), way.reshape(-1, 2))
    centre = len(index) // 2
    teeth = float(np.asarray(read @ answer)[0, [centre - 1, centre]].mean())
    return loads.T @ answer, teeth
