"""The table at any tilt against direct solutions: from no load to three times the rated one, sound and spalled."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.damage.outlines import rectangle
from siggen.damage.part import Damage
from siggen.damage.spalls import FlankSpall
from siggen.gearbox.plan import record_ids_of
from siggen.gears.missing_material import TipRelief, missing_material
from siggen.mesh import pair_law as layout
from siggen.mesh.contact_table import (
    ContactTable,
    KindRow,
    contact_table,
    first_touch,
    kind_row,
    pits_of_kind,
    row_faces,
    table_solver,
)
from siggen.mesh.face_slices import FaceSlices
from siggen.mesh.mesh_tables import pair_kinds
from siggen.mesh.pair_law import MeshConstants, PairLaw, pair_law
from siggen.mesh.springs import PairPlace, pair_spring
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions, face_slices
from siggen.mesh.tilt_rays import RAYS
from siggen.record.contact import whole_face
from siggen.sets.drawn import simulated
from tests.dynamics.pair_runs import RELIEF, gear_pair, law
from tests.gears.contact.faces import force_curve
from tests.gears.contact.test_contact_table import pitch_height, through_the_face
from tests.gears.geometry.test_helical import helical_pair

TEETH, OPTIONS, POINTS = StiffnessOptions(), TableOptions(tilts=True), 513
RATED_N = 2400.0
"""60 N m on the pinion of 18 teeth, as in quickstart."""
TILTS_RAD = np.array([0.0, 2e-5, 1e-4, 2e-4, 3e-4])
SHARES_OF_APPROACH = np.array([-0.9, -0.5, -0.1, 0.1, 0.5, 1.0])
"""Of the lift of the ends: from where a corner touches to where the whole face does."""


def one_end() -> Damage:
    heights = (pitch_height() - 0.5e-3, pitch_height() + 0.5e-3)
    return (FlankSpall("pinion", 3, rectangle(heights, (-1e-3, 7e-3)), 0.2e-3, "flat"),)


def lead_m(slices: int) -> np.ndarray:
    across = (np.arange(slices) + 0.5) / slices - 0.5
    return 3e-6 * across + 2e-6 * 4.0 * across**2


def made(damage: Damage, lead: np.ndarray) -> tuple[ContactTable, PairLaw]:
    pair = gear_pair()
    table = contact_table(pair, damage, TEETH, OPTIONS, POINTS, lead)
    return table, law(missing_material(pair, RELIEF), whole_face(pair, damage, TEETH, POINTS), contact=table)


def rows(damage: Damage) -> tuple[KindRow, int]:
    """Return the row of the damaged pair, or of sound ones, and its number in the table."""
    pair = gear_pair()
    healthy = kind_row(pair, TEETH, OPTIONS, POINTS)
    if not damage:
        return healthy, 0
    return kind_row(pair, TEETH, OPTIONS, POINTS, pits_of_kind(damage, pair_kinds(damage)[1]), healthy), 1


def from_table(table: ContactTable, chosen: PairLaw, row: int, point: int, where: np.ndarray) -> np.ndarray:
    """Return force [N] and moment [N m] (k, 2) at approaches beyond first touch and tilts (k, 2), as the loop reads."""
    column, first = float(table.column[row, point]), min(int(table.column[row, point]), len(table.curves) - 2)
    begins = chosen.places[layout.CURVES_AT] + first * table.curves[0].size
    place = PairPlace(0.0, 0.0, float(begins), column - first, 0.0)
    answers = (pair_spring(chosen, place, float(tilt), float(approach)) for approach, tilt in where)
    return np.array([(answer.force, answer.moment) for answer in answers])


def solved(slices: FaceSlices, touch_m: float, where: np.ndarray) -> np.ndarray:
    found = []
    for approach, tilt in where:
        one = force_curve(slices, np.array([touch_m + approach]), tilt)
        found.append((one.force_n[0], one.moment_n_m[0]))
    return np.array(found)


def places(half_face_m: float) -> np.ndarray:
    """Return approaches beyond first touch and tilts (k, 2), to both sides."""
    found = []
    for tilt in np.concatenate([TILTS_RAD, -TILTS_RAD[1:]]):
        near = SHARES_OF_APPROACH * abs(tilt) * half_face_m
        found += [(approach, tilt) for approach in (*near[near != 0.0], 2e-6, 5e-6, 10e-6, 18e-6, 28e-6, 38e-6)]
    return np.array(found)


@pytest.mark.parametrize("damage", [(), one_end(), through_the_face()], ids=["sound", "one end", "through the face"])
@pytest.mark.parametrize("uneven", [False, True], ids=["even", "misaligned, crowned"])
def test_force_and_moment_are_those_of_direct_solutions(damage: Damage, uneven: bool) -> None:
    slices = face_slices(gear_pair(), OPTIONS)
    lead = lead_m(slices) if uneven else np.zeros(slices)
    table, chosen = made(damage, lead)
    row, number = rows(damage)
    solver = table_solver(gear_pair(), TEETH, OPTIONS, lead - lead.min())
    differs = np.flatnonzero((table.column[number] >= OPTIONS.healthy_columns) | (number == 0))
    chosen_points = np.linspace(0.1, 0.9, 7) * (differs.size - 1) if damage else np.array([150.0, 256.0, 401.0])
    points = differs[chosen_points.astype(np.int64)]
    touch, faces = first_touch(gear_pair(), row, points, solver.lead_m), row_faces(solver, row, points)
    where = places(table.half_face_m)
    found, forces = [], []
    for point, touched, face in zip(points.tolist(), touch, faces, strict=True):
        exact = solved(face, float(touched), where)
        found.append(np.abs(from_table(table, chosen, number, point, where) - exact) / (1.0, table.half_face_m))
        forces.append(exact[:, 0])
    force, moment = np.moveaxis(np.array(found) / RATED_N, -1, 0)
    assert np.max(forces) > 3.0 * RATED_N
    assert np.median(force) < 5e-4
    assert np.median(moment) < 5e-4
    # Where columns of a spall at one end are read between those that were solved on all rays.
    assert force.max() < 1e-2
    assert moment.max() < 3e-2


@pytest.mark.parametrize("helix_deg", [-15.0, 25.0])
def test_force_and_moment_of_helical_pairs_are_those_of_direct_solutions(helix_deg: float) -> None:
    pair, points = helical_pair(helix_deg), np.array([30, 150, 256, 350, 490])
    options = OPTIONS._replace(relief=TipRelief(6e-6, 0.25 * pair.base_pitch_m))
    lead = np.zeros(face_slices(pair, options))
    table = contact_table(pair, (), TEETH, options, POINTS, lead)
    constants = MeshConstants(pair.line_of_action_m, 0.2, 80e-6)
    chosen = pair_law(
        whole_face(pair, (), TEETH, POINTS), missing_material(pair, None), constants, damping_ratio=0.0, contact=table
    )
    row, solver = kind_row(pair, TEETH, options, POINTS), table_solver(pair, TEETH, options, lead)
    touch, faces = first_touch(pair, row, points, lead), row_faces(solver, row, points)
    # Up to a tilt of 0.2 mrad, twice what shafts of quickstart give.
    where = np.array([one for one in places(table.half_face_m) if abs(one[1]) <= 2e-4])
    found, moments = [], []
    for point, touched, face in zip(points.tolist(), touch, faces, strict=True):
        exact = solved(face, float(touched), where)
        found.append(np.abs(from_table(table, chosen, 0, point, where) - exact) / (1.0, table.half_face_m))
        moments.append(exact[0, 1])
    force, moment = np.moveaxis(np.array(found) / RATED_N, -1, 0)
    assert np.median(force) < 5e-4
    assert np.median(moment) < 5e-4
    # Where a pair enters or leaves, an end carries alone: rays to the other end are flat, then bend.
    assert force.max() < 1e-2
    assert moment.max() < 2e-2
    # A pair that enters carries at one end of the face, one that leaves at the other.
    assert moments[0] * moments[-1] < 0.0


def test_the_outermost_rays_are_those_on_which_a_corner_just_touches() -> None:
    """There the ends' lift makes up for the gap: d = -|τ| in p = τ/(√(d² + τ²) + d)."""
    lift = np.array([-1.0, 1.0])
    np.testing.assert_allclose(RAYS[[0, -1]], lift / (np.sqrt(2.0) - 1.0), rtol=1e-12)


@pytest.mark.parametrize("name", ["quickstart", "helical"])
def test_shafts_of_presets_lift_the_ends_of_a_face_by_less_than_rays_need(name: str) -> None:
    design = load_config(name, ["duration_s=0.2", "internals={quantities: [mesh_tilt_rad]}"])
    gearbox = design.gearbox(2)
    (record,) = simulated(design, record_ids_of(design, 2)[-1:])
    assert isinstance(record, SimulatedRecord)
    lift = np.abs(record.internals["mesh_tilt_rad"]).max() * gearbox.pair.face_width_m / 2.0
    assert 1e-8 < lift < 1e-6


@pytest.mark.parametrize(("damage", "errors"), [((), (1e-3, 3e-3)), (one_end(), (4e-2, 0.1))], ids=["sound", "one end"])
def test_lifts_of_8_and_15_um_err_by_what_methods_say(damage: Damage, errors: tuple[float, float]) -> None:
    lead = np.zeros(face_slices(gear_pair(), OPTIONS))
    table, chosen = made(damage, lead)
    row, number = rows(damage)
    solver = table_solver(gear_pair(), TEETH, OPTIONS, lead)
    differs = np.flatnonzero((table.column[number] >= OPTIONS.healthy_columns) | (number == 0))
    points = differs[(np.linspace(0.1, 0.9, 5) * (differs.size - 1)).astype(np.int64)]
    touch, faces = first_touch(gear_pair(), row, points, lead), row_faces(solver, row, points)
    for lift, allowed in zip((8e-6, 15e-6), errors, strict=True):
        tilt = lift / table.half_face_m
        where = np.array([(np.sqrt((20e-6) ** 2 - lift**2), sign * tilt) for sign in (1.0, -1.0)])
        for point, touched, face in zip(points.tolist(), touch, faces, strict=True):
            exact = solved(face, float(touched), where)[:, 0]
            found = from_table(table, chosen, number, point, where)[:, 0]
            assert np.max(np.abs(found / exact - 1.0)) < allowed
