"""Tables of the contact across the face: against direct solutions, and the limit of a whole face without neighbours."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from siggen.damage.flank_chords import flank_chords
from siggen.damage.outlines import Polygon, rectangle
from siggen.damage.part import Damage
from siggen.damage.spalls import FlankSpall
from siggen.mesh.contact_table import CARRYING, FORCE, SLOPE, TYPICAL_SHARE, ContactTable, contact_table, node_places_m
from siggen.mesh.face_slices import FaceOptions, FaceSlices, face_gaps, pair_faces, pair_rest
from siggen.mesh.hertz import weber_banaschek_compliance
from siggen.mesh.mesh_stiffness import rolls_at
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions, face_slices
from siggen.mesh.tooth_compliance import tooth_compliance
from tests.damage.test_kind_without_outline import Hinge
from tests.dynamics.pair_runs import gear_pair
from tests.gears.contact.contact_table_error import contact_table_error
from tests.gears.contact.faces import force_curve

STIFFNESS = StiffnessOptions()
FORCE_N = 1200.0
OPTIONS = TableOptions(largest_force_n=3.0 * FORCE_N)
TYPICAL = TYPICAL_SHARE * gear_pair().reference_force_n / 20e-3
POINTS = 1025
SLICES = face_slices(gear_pair(), OPTIONS)


def pitch_height() -> float:
    pair = gear_pair()
    return float(pair.pinion.height_m(np.array([pair.pitch_point_m / pair.pinion.base_radius_m]))[0])


def through_the_face() -> Damage:
    heights = (pitch_height() - 0.4e-3, pitch_height() + 0.4e-3)
    return (FlankSpall("pinion", 3, rectangle(heights, (-5e-3, 25e-3)), 0.2e-3, "flat"),)


def skewed() -> Damage:
    low, high, slant = pitch_height() - 0.4e-3, pitch_height() + 0.4e-3, 0.3e-3
    corners = ((low, 4e-3), (low + slant, 16e-3), (high + slant, 16e-3), (high, 4e-3))
    return (FlankSpall("pinion", 3, Polygon(corners), 0.2e-3, "flat"),)


@cache
def table(damage: Damage) -> ContactTable:
    return contact_table(gear_pair(), damage, STIFFNESS, OPTIONS, POINTS)


def from_table(found: ContactTable, row: int, place: float, approach_m: np.ndarray) -> np.ndarray:
    """Force at a place on the fine grid, read as the module says."""
    cell = min(int(place), POINTS - 2)
    weight = place - cell
    touch = found.touch_m[row, cell] * (1.0 - weight) + found.touch_m[row, cell + 1] * weight
    column = found.column[row, cell] + found.gain[row, cell] * weight
    first = min(int(column), len(found.curves) - 2)
    node = node_places_m(found.unit_m, found.curves.shape[1])
    values = [
        CubicHermiteSpline(node, curve[:, FORCE], curve[:, SLOPE])(approach_m - touch)
        for curve in found.upright[first : first + 2]
    ]
    return values[0] + (column - first) * (values[1] - values[0])


def solved(damage: Damage, place: float, approach_m: np.ndarray) -> np.ndarray:
    """Force of the solver itself at the same place, with edges of its own."""
    return force_curve(slices_at(damage, place), approach_m, 0.0).force_n


def slices_at(damage: Damage, place: float) -> FaceSlices:
    pair = gear_pair()
    fine = np.linspace(pair.contact_start_m, pair.contact_end_m, POINTS)
    position = np.array([np.interp(place, np.arange(POINTS), fine)])
    pits = [[d for d in damage if d.gear == which] for which in ("pinion", "gear")]
    chords = [
        flank_chords(pair.member(which), of_tooth, pair.face_width_m, SLICES)
        for which, of_tooth in zip(("pinion", "gear"), pits, strict=True)
    ]
    rolls = rolls_at(pair, position)
    rest = pair_rest(
        pair,
        (tooth_compliance(pair, "pinion", rolls[0], STIFFNESS), tooth_compliance(pair, "gear", rolls[1], STIFFNESS)),
        STIFFNESS,
    )
    options = FaceOptions(TYPICAL, OPTIONS.edge_radius_m)
    return pair_faces(pair, face_gaps(pair, *chords, position), position, rest, options)[0]


@pytest.mark.parametrize("damage", [through_the_face(), skewed()], ids=["through the face", "skewed, with land"])
def test_the_table_gives_the_force_of_the_solver(damage: Damage) -> None:
    found = table(damage)
    rng = np.random.default_rng(3)
    damaged = np.flatnonzero(found.column[1] >= OPTIONS.healthy_columns)
    errors = []
    for cell in rng.choice(damaged, 40):
        place = float(cell + rng.random())
        touch = np.interp(place, np.arange(POINTS), found.touch_m[1])
        approach = touch + np.array([3e-6, 6e-6, 10e-6])
        errors.append(from_table(found, 1, place, approach) - solved(damage, place, approach))
    share = np.abs(errors) / FORCE_N
    # Columns are halved until they bend by less than 4e-3; kinks at edges rule the largest error, not the mean one.
    assert np.sqrt(np.mean(np.square(share))) < 1.5e-3
    assert share.max() < 1.5e-2


def test_a_crack_that_shows_on_no_flank_is_felt_along_the_whole_path() -> None:
    cracked = (Hinge("pinion", 3, depth_m=1e-3, spring_nm_per_rad=2e4),)
    found, approach = table(cracked), np.array([4e-6, 8e-6])
    for place in (400.0, 640.5, POINTS - 30.25):  # lower on the pinion the load passes through the root's hinge
        share = from_table(found, 1, place, approach) / from_table(found, 0, place, approach)
        assert (share < 0.999).all()
    np.testing.assert_array_equal(found.touch_m[1], found.touch_m[0])


def test_forces_rise_from_first_touch_with_a_continuous_slope() -> None:
    for damage in ((), through_the_face(), skewed()):
        found = table(damage)
        assert (np.diff(found.upright[:, :, FORCE], axis=1) > 0.0).all()
        assert (found.upright[:, 0, FORCE] == 0.0).all()
        assert (found.upright[:, 0, SLOPE] == 0.0).all()
        assert (found.upright[:, 1:, SLOPE] > 0.0).all()
        assert (found.upright[:, :, CARRYING] <= 1.0 + 1e-9).all()


def test_a_spall_through_the_face_sinks_by_its_rigid_sink_at_first_touch() -> None:
    pair = gear_pair()
    middle = pair.pitch_point_m
    radius = middle * (pair.line_of_action_m - middle) / pair.line_of_action_m + OPTIONS.edge_radius_m
    # The arc of 0.8 mm of height is longer by the slope of the flank against the tooth's middle.
    edges = pair.pinion.height_m(np.linspace(0.2, 0.6, 100_001))
    rolls = np.interp(pitch_height() + np.array([-0.4e-3, 0.4e-3]), edges, np.linspace(0.2, 0.6, 100_001))
    arc = np.diff(0.5 * pair.pinion.base_radius_m * rolls**2)[0]
    assert table(through_the_face()).touch_m[1].max() == pytest.approx(arc**2 / (8.0 * radius), rel=0.01)
    assert table(through_the_face()).touch_m[0].max() == 0.0
    assert table(skewed()).touch_m[1].max() == 0.0  # the land beside it touches first


def test_slices_that_do_not_feel_each_other_are_weber_and_banaschek_on_the_whole_face() -> None:
    pair = gear_pair()
    alone = contact_table(pair, (), STIFFNESS, OPTIONS._replace(coupled=False), POINTS)
    fine = np.linspace(pair.contact_start_m, pair.contact_end_m, POINTS)
    for place in (320.0, 512.0, 704.0):
        position = np.array([fine[int(place)]])
        rolls = rolls_at(pair, position)
        rest = sum(
            tooth_compliance(pair, which, roll, STIFFNESS).total[0]
            for which, roll in zip(("pinion", "gear"), rolls, strict=True)
        )
        for force in (300.0, 1200.0, 2400.0):
            contact = weber_banaschek_compliance(pair, *rolls, np.array([pair.face_width_m]), force)[0]
            found = from_table(alone, 0, place, np.array([force * (rest + contact)]))[0]
            # 0.2 %: cubics between 16 approaches; the solver itself meets the secant to 1e-9 (test_face_force).
            assert found == pytest.approx(force, rel=2e-3)


def test_missing_material_across_the_face_is_carried_by_the_near_end_first() -> None:
    lead = 6e-6 * ((np.arange(SLICES) + 0.5) / SLICES - 0.5)
    tilted = contact_table(gear_pair(), (), STIFFNESS, OPTIONS, POINTS, lead)
    even = table(())
    assert tilted.lead_m == pytest.approx(lead.min())
    middle = OPTIONS.healthy_columns // 2
    assert tilted.upright[middle, 4, CARRYING] < 0.5 * even.upright[middle, 4, CARRYING]
    assert tilted.upright[middle, 4, FORCE] < even.upright[middle, 4, FORCE]


def test_the_stated_error_is_that_of_direct_solutions() -> None:
    pair = gear_pair()
    fine = contact_table_error(pair, skewed(), STIFFNESS, OPTIONS, table(skewed()), FORCE_N, places=15)
    coarse_options = OPTIONS._replace(nodes=8, finest=128)
    coarse = contact_table(pair, skewed(), STIFFNESS, coarse_options, POINTS)
    rough = contact_table_error(pair, skewed(), STIFFNESS, coarse_options, coarse, FORCE_N, places=15)
    assert fine.rms < 1.5e-3
    assert rough.rms > 3.0 * fine.rms
    assert fine.rms <= fine.largest
