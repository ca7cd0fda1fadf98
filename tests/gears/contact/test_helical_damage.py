"""Damage on helical flanks: every slice is a spur slice at a place of its own on the path of contact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.damage.outlines import rectangle
from siggen.damage.spalls import FlankSpall
from siggen.mesh.contact_table import contact_table, kind_row
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions, face_slices
from tests.gears.geometry.test_helical import helical_pair

OPTIONS, STIFFNESS, POINTS = TableOptions(1000.0), StiffnessOptions(), 801


def spall(pair, face_m):
    pitch = float(pair.pinion.height_m(np.array([pair.pitch_point_m / pair.pinion.base_radius_m]))[0])
    return FlankSpall("pinion", 3, rectangle((pitch - 0.3e-3, pitch + 0.3e-3), face_m), 0.2e-3, "flat")


def on_damage(pair, face_m):
    """Return positions (k,) [m] and the part of every slice whose normal lies in the spall (k, n)."""
    row = kind_row(pair, STIFFNESS, OPTIONS, POINTS, ((spall(pair, face_m),), ()))
    return row.position_m, row.gaps.on_damage


@pytest.mark.parametrize("helix_deg", [-15.0, 25.0])
def test_a_groove_through_the_face_acts_on_every_slice_at_its_shifted_phase(helix_deg):
    pair = helical_pair(helix_deg)
    position, found = on_damage(pair, (-5e-3, 25e-3))
    low, high = spall(pair, (0.0, 1.0)).outline.height_range_m
    slices = face_slices(pair, OPTIONS)
    for j in range(slices):  # slow and independent: the height that the slice touches, by its own place
        face_m = pair.face_width_m * ((j + 0.5) / slices - 0.5)
        place = position + face_m * np.tan(pair.base_helix_rad)
        on_path = np.clip(place, pair.contact_start_m, pair.contact_end_m)
        height = pair.pinion.height_m(on_path / pair.pinion.base_radius_m)
        assert np.array_equal(found[:, j] > 0.0, (height > low) & (height < high))
    assert not (found > 0.0).all(axis=1).any()  # a contact line crosses the groove aslant: some land always carries


def test_a_spall_takes_as_much_area_times_time_as_on_the_spur_pair_of_the_same_section():
    pair, face_m = helical_pair(15.0), (4.3e-3, 10.1e-3)
    taken = []
    for one in (pair, replace(pair, helix_rad=0.0)):
        position, found = on_damage(one, face_m)
        if found.shape[0] < POINTS:  # a spur row keeps the points at which damage may be felt
            assert one.helix_rad == 0.0
        taken.append(found.mean(axis=1).sum() * (position[1] - position[0]))
    # One point of the path in some 100 that the spall takes, at either of its ends.
    assert taken[0] == pytest.approx(taken[1], rel=0.02)


def test_slices_beside_a_spall_are_those_of_the_healthy_pair():
    pair = helical_pair(15.0)
    healthy = kind_row(pair, STIFFNESS, OPTIONS, POINTS)
    row = kind_row(pair, STIFFNESS, OPTIONS, POINTS, ((spall(pair, (4e-3, 10e-3)),), ()), healthy)
    middle = pair.face_width_m * (np.arange(face_slices(pair, OPTIONS)) + 0.5) / face_slices(pair, OPTIONS)
    beside = (middle < 3.7e-3) | (middle > 10.3e-3)
    for near, far in zip(row.gaps, healthy.gaps, strict=True):
        assert np.array_equal(near[:, beside], far[:, beside])
    assert (row.gaps.covered[:, (middle > 4.3e-3) & (middle < 9.7e-3)] == 1.0).all()


def test_a_spall_of_no_helix_differs_from_healthy_where_it_does_on_spur_teeth():
    near, spur = helical_pair(1e-6), helical_pair(0.0)
    kinds = []
    for pair in (near, spur):
        table = contact_table(pair, (spall(pair, (5e-3, 15e-3)),), STIFFNESS, OPTIONS, POINTS)
        kinds.append(
            (table.touch_m[1] - table.touch_m[0], table.column[1] >= OPTIONS.healthy_columns, len(table.curves))
        )
    # 1e-6 of a degree moves slices by 0.2 nm of the path; columns of their own elsewhere would hide the spall's effect.
    assert kinds[0][0] == pytest.approx(kinds[1][0], abs=1e-11)
    assert np.array_equal(kinds[0][1], kinds[1][1])
    assert kinds[0][2] == kinds[1][2]
