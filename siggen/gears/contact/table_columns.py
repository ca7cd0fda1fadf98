r"""Columns of the contact table: answers of one kind of pair at points of the path to approaches beyond first touch.

Forces, moments and their slopes are the solver's own, so that few approaches do. Nodes lie at u k², u of the pair
alone.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.gears.contact import tilt_rays
from siggen.gears.contact.face_slices import FaceSlices
from siggen.gears.contact.force_curve import ForceCurve, write_curves
from siggen.gears.contact.kind_row import KindRow, first_touch
from siggen.gears.contact.newton_matrix import solver_room
from siggen.gears.contact.pair_faces import FaceOptions, contact_kappa, pair_faces
from siggen.gears.contact.table_options import TableOptions, half_width
from siggen.gears.contact.tilt_rays import RAYS, UPRIGHT, along_rays, ray_way
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.helical import carrying_middle_m, slice_radii_m
from siggen.gears.stiffness.compliance import tooth_compliance
from siggen.gears.stiffness.hertz import centre_line_depth
from siggen.gears.stiffness.mesh_stiffness import rolls_at
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.names import Side

FORCE, SLOPE, CARRYING, ROUGH, ACROSS, ACROSS_SLOPE, ENERGY = range(7)
"""Values of the curves: force [N], its slope [N/m], carrying share of the face, share of the load on rough land.

Where gears tilt, for every ray of `tilt_rays`: W_r [N] and W_rr, both shares, W_p [J], W_pr and W [J]; without tilt W_r
is F."""
VALUES, TILTING_VALUES = 4, 8
TOLERANCE = 2e-2
"""Of the last Newton step of a column's loads: the force errs by 1e-4 of 1,200 N at most, by 1e-5 rms (measured)."""


REACH = 1.25
"""How far nodes go over the approach of a force in the middle of the path."""
TYPICAL_SHARE = 0.25
"""Of the reference force: a load that decides from which depth slices count as not carrying."""


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
    reference = pair.reference_force_n
    unit = REACH * approach_under_m(pair, stiffness, reference) / (options.nodes - 1.0) ** 2
    reach = REACH * approach_under_m(pair, stiffness, max(options.largest_force_n, reference))
    nodes = max(options.nodes, int(np.ceil(np.sqrt(reach / unit))) + 1)
    return TableSolver(pair, options, lead_m, node_places_m(unit, nodes), options.nodes - 1)


def approach_under_m(pair: GearPair, stiffness: StiffnessOptions, force_n: float) -> float:
    """Return the approach of one healthy pair under a force in the middle of the path [m]."""
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m)])
    rolls = rolls_at(pair, middle)
    members = tuple(zip(Side, rolls, strict=True))
    depth = float(np.sqrt(np.prod([centre_line_depth(pair, side, roll) for side, roll in members])))
    rest = sum(float(tooth_compliance(pair, side, roll, stiffness).total[0]) for side, roll in members)
    width = float(half_width(pair, middle, force_n)[0])
    contact = contact_kappa(pair) * force_n / pair.face_width_m * (np.log(2.0 * depth / width) + 0.5)
    return float(force_n * rest + contact)


def row_faces(solver: TableSolver, row: KindRow, chosen: IntArray) -> list[FaceSlices]:
    """Return the slices at fine points (chosen,)."""
    options = solver.options
    typical = TYPICAL_SHARE * solver.pair.reference_force_n / solver.pair.face_width_m
    return pair_faces(
        solver.pair,
        row.gaps_at(chosen),
        carrying_middle_m(solver.pair, row.position_m[chosen]),
        row.rest.at(chosen),
        FaceOptions(typical, row.edge_radius_m, options.coupled),
        row.lead_at(chosen, solver.lead_m),
        None
        if solver.pair.helix_rad == 0.0
        else slice_radii_m(solver.pair, row.position_m[chosen], solver.lead_m.size),
        None if row.rough is None else row.rough[chosen],
    )


def column_curves(solver: TableSolver, row: KindRow, chosen: IntArray) -> FloatArray:
    """Return the curves (chosen, nodes, 1, values) without tilt at fine points (chosen,), ascending."""
    curves = ray_curves(solver, row, chosen, RAYS[UPRIGHT : UPRIGHT + 1])
    keep_rising(solver.node_m, curves)
    return curves


def ray_curves(solver: TableSolver, row: KindRow, chosen: IntArray, rays: FloatArray) -> FloatArray:
    """Return the curves (chosen, nodes, rays, values) on rays (rays,) of p at fine points (chosen,), as solved."""
    touch, room = first_touch(solver.pair, row, chosen, solver.lead_m), solver_room(solver.lead_m.size)
    node, half_face = solver.node_m[1:], 0.5 * solver.pair.face_width_m
    way = ray_way(rays, node, half_face)
    found = np.zeros((chosen.size, len(ForceCurve._fields), rays.size, node.size))
    for i, slices in enumerate(row_faces(solver, row, chosen)):
        if not write_curves(slices, touch[i] + way.approach_m, way.tilt_rad, room, TOLERANCE, found[i]):
            raise ValueError("the contact across the face was not solved; allowed: finite slices and approaches")
    found = np.moveaxis(found, 0, 1)
    values = along_rays(rays, node, half_face, found)
    parts = [values[0], values[1], found[tilt_rays.CARRYING] / solver.pair.face_width_m, found[tilt_rays.ON_ROUGH]]
    parts += [values[2], values[3]] if solver.options.tilts else []
    count = TILTING_VALUES if solver.options.tilts else VALUES
    curves = np.zeros((chosen.size, solver.node_m.size, rays.size, count))
    for number, part in enumerate(parts):
        curves[:, 1:, :, number] = np.moveaxis(part, -1, 1)
    curves[:, 0, :, CARRYING : ROUGH + 1] = curves[:, 1, :, CARRYING : ROUGH + 1]
    return curves


def keep_rising(node_m: FloatArray, curves: FloatArray) -> None:
    """Cut slopes to three times the secants beside them: such a cubic rises (Fritsch and Carlson 1980)."""
    secant = 3.0 * np.diff(curves[..., FORCE], axis=1) / np.diff(node_m)[:, np.newaxis]
    curves[:, 1:, :, SLOPE] = np.minimum(curves[:, 1:, :, SLOPE], secant)
    curves[:, :-1, :, SLOPE] = np.minimum(curves[:, :-1, :, SLOPE], secant)
