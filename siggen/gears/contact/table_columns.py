r"""Columns of the contact table: answers of one kind of pair at points of the path to approaches beyond first touch.

Forces, moments and their slopes are the solver's own, so that few approaches do; nodes lie at D (k/(n - 1))² up to the
largest approach D.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.gears.contact.face_gaps import FaceGaps, face_gaps
from siggen.gears.contact.face_slices import FaceSlices
from siggen.gears.contact.force_curve import force_curve
from siggen.gears.contact.newton_matrix import solver_room
from siggen.gears.contact.pair_faces import FaceOptions, contact_kappa, pair_faces
from siggen.gears.contact.pair_rest import PairRest, pair_rest
from siggen.gears.damage.flank_chords import flank_chords
from siggen.gears.damage.tooth_damage import Damage, pits_of
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.compliance import tooth_compliance
from siggen.gears.stiffness.hertz import centre_line_depth, contact_half_width
from siggen.gears.stiffness.mesh_stiffness import rolls_at
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

FORCE, SLOPE, CARRYING, ROUGH, MOMENT, MOMENT_SLOPE, TURNING, TURNING_SLOPE = range(8)
"""Columns of the curves: force [N], dF/dd [N/m], carrying share of the face, share of the load on damage; where gears
tilt, also the moment at no tilt M [N m], dM/dd [N], dM/dθ = M_θ [N m], and dM_θ/dd [N]."""
NO_ENERGY = np.zeros((2, 0))
TOLERANCE = 2e-2
"""Of the last Newton step of a column's loads: the force errs by 1e-4 of 1,200 N at most, by 1e-5 rms (measured)."""
FEWEST_SLICES, MOST_SLICES = 40, 100


class TableOptions(NamedTuple):
    """How finely the contact is tabulated.

    `largest_force_n`: at which the nodes end; `edge_radius_m`: of damage; `cell_widths`: width of a slice in Hertz half
    widths of that force; `nodes`: approaches; `healthy_columns`; `finest`: intervals of the fine grid below which
    columns are not refined; `section_loss`: whether damage also weakens the tooth's sections; `coupled`: whether slices
    feel each other; `tilts`: whether gears do.
    """

    largest_force_n: float
    edge_radius_m: float = 0.1e-3
    cell_widths: float = 1.6
    nodes: int = 10
    healthy_columns: int = 65
    finest: int = 2
    section_loss: bool = False
    coupled: bool = True
    tilts: bool = False


class KindRow(NamedTuple):
    """One kind of pair on the fine grid (points,): positions, gaps, compliance of all but the contact, radius of edges.

    The radius is the mean of those that the damage of both teeth states, or else that of the options.
    """

    position_m: FloatArray
    gaps: FaceGaps
    rest: PairRest
    edge_radius_m: float


class TableSolver(NamedTuple):
    """What all columns of a pair share."""

    pair: GearPair
    options: TableOptions
    lead_m: FloatArray
    node_m: FloatArray


def face_slices(pair: GearPair, options: TableOptions) -> int:
    """Return the number of slices: cells of the width at which the kernel holds, within bounds of cost."""
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m)])
    width = options.cell_widths * float(half_width(pair, middle, options.largest_force_n)[0])
    return int(np.clip(round(pair.face_width_m / width), FEWEST_SLICES, MOST_SLICES))


def pits_of_kind(damage: Damage, kind: tuple[int, int]) -> tuple[Damage, Damage]:
    """Return the damage of pinion and gear tooth of a kind of pair."""
    return pits_of(damage, "pinion", kind[0]), pits_of(damage, "gear", kind[1])


def kind_row(
    pair: GearPair, stiffness: StiffnessOptions, options: TableOptions, points: int, pits: tuple[Damage, Damage]
) -> KindRow:
    """Return one kind of pair on a grid of points from s_A to s_E."""
    position = np.linspace(pair.contact_start_m, pair.contact_end_m, points)
    members = tuple(zip(("pinion", "gear"), rolls_at(pair, position), pits, strict=True))
    chords = [
        flank_chords(pair.member(which), of_tooth, pair.face_width_m, face_slices(pair, options))
        for which, _, of_tooth in members
    ]
    # What shows on no flank acts through the tooth alone, as in `slice_law`.
    teeth = [
        tooth_compliance(
            pair, which, roll, stiffness, tuple(d for d in damage if options.section_loss or d.outline is None)
        )
        for which, roll, damage in members
    ]
    rest = pair_rest(pair, (teeth[0], teeth[1]), stiffness)
    stated = np.concatenate([radius.ravel() for c in chords for radius in (c.low_radius_m, c.high_radius_m)])
    stated = stated[stated > 0.0]
    edge_radius = float(stated.mean()) if stated.size else options.edge_radius_m
    return KindRow(position, face_gaps(pair, chords[0], chords[1], position), rest, edge_radius)


def table_solver(pair: GearPair, stiffness: StiffnessOptions, options: TableOptions, lead_m: FloatArray) -> TableSolver:
    """Return the solver with nodes up to 1.25 times the approach of the largest force in the middle of the path."""
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m)])
    rolls = rolls_at(pair, middle)
    members = tuple(zip(("pinion", "gear"), rolls, strict=True))
    depth = float(np.sqrt(np.prod([centre_line_depth(pair, which, roll) for which, roll in members])))
    rest = sum(float(tooth_compliance(pair, which, roll, stiffness).total[0]) for which, roll in members)
    force = options.largest_force_n
    width = float(half_width(pair, middle, force)[0])
    contact = contact_kappa(pair) * force / pair.face_width_m * (np.log(2.0 * depth / width) + 0.5)
    reach = 1.25 * (force * rest + contact)
    return TableSolver(pair, options, lead_m, reach * (np.arange(options.nodes) / (options.nodes - 1.0)) ** 2)


def half_width(pair: GearPair, position_m: FloatArray, force_n: float) -> FloatArray:
    """Return Hertz's half width of the whole face (k,) [m]."""
    length = np.full(position_m.shape, pair.face_width_m)
    return contact_half_width(pair, *rolls_at(pair, position_m), length, force_n)


def first_touch(solver: TableSolver, row: KindRow, chosen: IntArray) -> FloatArray:
    """Return the least rigid sink of all slices, missing material across the face included (chosen,) [m]."""
    position, line = row.position_m[chosen], solver.pair.line_of_action_m
    radius = position * (line - position) / line + row.edge_radius_m
    gaps = row.gaps
    near = np.maximum(np.minimum(gaps.left_m[chosen], gaps.right_m[chosen]), 0.0)
    floor = np.where(gaps.floor_m[chosen] > 0.0, gaps.floor_m[chosen], np.inf)
    sunk = np.minimum(near**2 / (2.0 * radius[:, None]), floor)
    return np.asarray((sunk + solver.lead_m).min(axis=1))


def row_faces(solver: TableSolver, row: KindRow, chosen: IntArray) -> list[FaceSlices]:
    """Return the slices at fine points (chosen,)."""
    options = solver.options
    typical = 0.25 * options.largest_force_n / solver.pair.face_width_m
    return pair_faces(
        solver.pair,
        FaceGaps(*(array[chosen] for array in row.gaps)),
        row.position_m[chosen],
        row.rest.at(chosen),
        FaceOptions(typical, row.edge_radius_m, options.coupled),
        solver.lead_m,
    )


def column_curves(solver: TableSolver, row: KindRow, chosen: IntArray) -> FloatArray:
    """Return the curves (chosen, nodes, 4 or 8) at fine points (chosen,), ascending."""
    pair, options, node = solver.pair, solver.options, solver.node_m
    faces = row_faces(solver, row, chosen)
    touch = first_touch(solver, row, chosen)
    curves = np.zeros((chosen.size, options.nodes, 8 if options.tilts else 4))
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
        _turning_slopes(node, curves)
    return curves


def _keep_rising(node_m: FloatArray, curves: FloatArray) -> None:
    """Cut slopes to three times the secants beside them: such a cubic rises (Fritsch and Carlson 1980)."""
    secant = 3.0 * np.diff(curves[:, :, FORCE], axis=1) / np.diff(node_m)
    curves[:, 1:, SLOPE] = np.minimum(curves[:, 1:, SLOPE], secant)
    curves[:, :-1, SLOPE] = np.minimum(curves[:, :-1, SLOPE], secant)


def _turning_slopes(node_m: FloatArray, curves: FloatArray) -> None:
    from scipy.interpolate import pchip_interpolate

    curves[:, :, TURNING_SLOPE] = pchip_interpolate(node_m, curves[:, :, TURNING].T, node_m, der=1).T
