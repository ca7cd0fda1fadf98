r"""Columns of the contact table: answers of one kind of pair at points of the path to approaches beyond first touch.

Forces, moments and their slopes are the solver's own, so that few approaches do. Nodes lie at u k², u of the pair
alone.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.gears.contact.face_slices import FaceSlices
from siggen.gears.contact.force_curve import force_curve
from siggen.gears.contact.kind_row import KindRow, first_touch
from siggen.gears.contact.newton_matrix import solver_room
from siggen.gears.contact.pair_faces import FaceOptions, contact_kappa, pair_faces
from siggen.gears.contact.table_options import TableOptions, half_width, reference_force_n
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.compliance import tooth_compliance
from siggen.gears.stiffness.hertz import centre_line_depth
from siggen.gears.stiffness.mesh_stiffness import rolls_at
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

FORCE, SLOPE, CARRYING, ROUGH, MOMENT, MOMENT_SLOPE, TURNING, TURNING_SLOPE = range(8)
"""Columns of the curves: force [N], dF/dd [N/m], carrying share of the face, share of the load on damage; where gears
tilt, also the moment at no tilt M [N m], dM/dd [N], dM/dθ = M_θ [N m], and dM_θ/dd [N]."""
NO_ENERGY = np.zeros((2, 0))
TOLERANCE = 2e-2
"""Of the last Newton step of a column's loads: the force errs by 1e-4 of 1,200 N at most, by 1e-5 rms (measured)."""


TYPICAL_SHARE = 0.25
"""Of the reference force: a load that decides from which depth slices count as not carrying."""
TOUCHING = 0.04
"""Share of the reach over which a tilted face comes to touch."""


class TableSolver(NamedTuple):
    """What all columns of a pair share; `reference` is the number of the node at the reference force."""

    pair: GearPair
    options: TableOptions
    lead_m: FloatArray
    node_m: FloatArray
    reference: int


def node_places_m(unit_m: float, nodes: int) -> FloatArray:
    """Return the approaches of the nodes (nodes,) beyond first touch [m]."""
    return unit_m * np.arange(float(nodes)) ** 2


def table_solver(pair: GearPair, stiffness: StiffnessOptions, options: TableOptions, lead_m: FloatArray) -> TableSolver:
    """Return the solver; a largest force above the reference force adds nodes at the end and moves none."""
    reference = reference_force_n(pair)
    unit = _reach_m(pair, stiffness, reference) / (options.nodes - 1.0) ** 2
    reach = _reach_m(pair, stiffness, max(options.largest_force_n, reference))
    nodes = max(options.nodes, int(np.ceil(np.sqrt(reach / unit))) + 1)
    return TableSolver(pair, options, lead_m, node_places_m(unit, nodes), options.nodes - 1)


def _reach_m(pair: GearPair, stiffness: StiffnessOptions, force_n: float) -> float:
    """Return 1.25 times the approach of a force in the middle of the path [m]."""
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m)])
    rolls = rolls_at(pair, middle)
    members = tuple(zip(("pinion", "gear"), rolls, strict=True))
    depth = float(np.sqrt(np.prod([centre_line_depth(pair, which, roll) for which, roll in members])))
    rest = sum(float(tooth_compliance(pair, which, roll, stiffness).total[0]) for which, roll in members)
    width = float(half_width(pair, middle, force_n)[0])
    contact = contact_kappa(pair) * force_n / pair.face_width_m * (np.log(2.0 * depth / width) + 0.5)
    return float(1.25 * (force_n * rest + contact))


def largest_tilt_rad(solver: TableSolver) -> float:
    """Return the tilt up to which the expansion holds: it lifts the ends of the face by `TOUCHING` of the reach."""
    return float(2.0 * TOUCHING * solver.node_m[solver.reference] / solver.pair.face_width_m)


def row_faces(solver: TableSolver, row: KindRow, chosen: IntArray) -> list[FaceSlices]:
    """Return the slices at fine points (chosen,)."""
    options = solver.options
    typical = TYPICAL_SHARE * reference_force_n(solver.pair) / solver.pair.face_width_m
    return pair_faces(
        solver.pair,
        row.gaps_at(chosen),
        row.position_m[chosen],
        row.rest.at(chosen),
        FaceOptions(typical, row.edge_radius_m, options.coupled),
        solver.lead_m,
    )


def column_curves(solver: TableSolver, row: KindRow, chosen: IntArray) -> FloatArray:
    """Return the curves (chosen, nodes, 4 or 8) at fine points (chosen,), ascending."""
    pair, options, node = solver.pair, solver.options, solver.node_m
    faces = row_faces(solver, row, chosen)
    touch = first_touch(solver.pair, row, chosen, solver.lead_m)
    curves = np.zeros((chosen.size, node.size, 8 if options.tilts else 4))
    room, guess = solver_room(solver.lead_m.size), np.zeros(solver.lead_m.size)
    for i, slices in enumerate(faces):
        found = force_curve(slices, touch[i] + node[1:], 0.0, guess, room, NO_ENERGY, TOLERANCE)
        curves[i, 1:, FORCE] = found.force_n
        curves[i, 1:, SLOPE] = found.stiffness_n_per_m
        curves[i, 1:, CARRYING] = found.carrying_m / pair.face_width_m
        curves[i, 1:, ROUGH] = found.on_damage
        if options.tilts:
            curves[i, 1:, MOMENT] = found.moment_n_m
            curves[i, 1:, MOMENT_SLOPE] = found.turning_n
            curves[i, 1:, TURNING] = found.tilting_n_m
    curves[:, 0, CARRYING:MOMENT] = curves[:, 1, CARRYING:MOMENT]
    _keep_rising(node, curves)
    if options.tilts:
        _start_turning(node, curves, TOUCHING * node[solver.reference])
    return curves


def _keep_rising(node_m: FloatArray, curves: FloatArray) -> None:
    """Cut slopes to three times the secants beside them: such a cubic rises (Fritsch and Carlson 1980)."""
    secant = 3.0 * np.diff(curves[:, :, FORCE], axis=1) / np.diff(node_m)
    curves[:, 1:, SLOPE] = np.minimum(curves[:, 1:, SLOPE], secant)
    curves[:, :-1, SLOPE] = np.minimum(curves[:, :-1, SLOPE], secant)


def _start_turning(node_m: FloatArray, curves: FloatArray, way: float) -> None:
    """Let dM/dθ grow from first touch over a way [m], and write its slopes.

    Derived: of parallel flanks it is all there at once, so that the force ½ (dM/dθ)' θ² would be a blow at first touch.
    Tilted ones touch from one end to the other while the approach grows by the lift of the ends. Over that way dM/dθ
    rises to the same value, with a slope that falls evenly.
    """
    from scipy.interpolate import pchip_interpolate

    curves[:, :, TURNING_SLOPE] = pchip_interpolate(node_m, curves[:, :, TURNING].T, node_m, der=1).T
    after = int(np.searchsorted(node_m, way))
    x = node_m[:after] / node_m[after]
    full = curves[:, after, TURNING, None]
    curves[:, :after, TURNING] = full * x * (2.0 - x)
    curves[:, :after, TURNING_SLOPE] = full * 2.0 * (1.0 - x) / node_m[after]
