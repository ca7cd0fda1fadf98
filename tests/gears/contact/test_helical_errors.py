"""Errors and friction of helical slices against a contact solved with the errors themselves, and plain sums."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.gears.errors import with_errors
from siggen.gears.flank_waves import ORDERS, FlankWaves, with_waves
from siggen.gears.helical import slice_shifts_m
from siggen.gears.missing_material import TipRelief, missing_material
from siggen.mesh.contact_table import TYPICAL_SHARE, kind_row, load_shares, row_faces, table_solver
from siggen.mesh.face_force import face_force, solver_room
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions
from tests.gears.erroneous_gears import drawn
from tests.gears.geometry.test_helical import helical_pair

STIFFNESS = StiffnessOptions()


def options(pair):
    return TableOptions(1000.0, healthy_columns=33, relief=TipRelief(6e-6, 0.25 * pair.base_pitch_m))


def waves(teeth, amplitude_m, own_m):
    return FlankWaves(
        np.array([float(9 * teeth + 2)]), np.array([amplitude_m]), np.array([0.4]),
        own_m * np.exp(1j * ORDERS) / ORDERS, np.zeros((teeth, ORDERS.size), dtype=complex),
    )  # fmt: skip


def approaches_m(pair, missing_m, chosen):
    """Return the approach of a healthy pair under a typical force, each slice missing what it does, by halving."""
    row, count = kind_row(pair, STIFFNESS, options(pair), 33), missing_m.shape[1]
    row = row._replace(slice_missing_m=row.slice_missing_m + missing_m)
    force, room, found = TYPICAL_SHARE * pair.reference_force_n, solver_room(count), []
    for slices in row_faces(table_solver(pair, STIFFNESS, options(pair), np.zeros(count)), row, chosen):
        low, high = 0.0, 1e-4
        for _ in range(40):
            middle = 0.5 * (low + high)
            given = face_force(slices, middle, 0.0, np.zeros(count), room).force_n
            low, high = (middle, high) if given < force else (low, middle)
        found.append(middle)
    return np.array(found)


@pytest.mark.parametrize(("size", "allowed_m"), [(0.25, 5e-9), (1.0, 8e-8)])
def test_the_mean_over_the_load_is_how_far_slices_with_errors_move_a_pair_apart(size, allowed_m):
    pair = helical_pair(15.0)
    shares = load_shares(pair, STIFFNESS, options(pair))
    position, chosen = np.linspace(shares.start_m, shares.end_m, 33), np.arange(2, 31, 4)

    def met(place):  # a wave and a slope of class 6
        return size * (2e-6 * np.sin(900.0 * place) + 3e-4 * (place - pair.pitch_point_m))

    missing = met(position[:, None] + slice_shifts_m(pair, shares.shift_m.size))
    moved = approaches_m(pair, missing, chosen) - approaches_m(pair, 0.0 * missing, chosen)
    seen = shares.mean(position, lambda place: met(place)[None])[0, chosen]
    # What shifts of the load change is of second order: 16 times less for a quarter of the errors.
    assert moved == pytest.approx(seen, abs=allowed_m)
    assert np.ptp(seen) > 5e-6 * size


def test_where_the_middle_of_a_helical_face_lies_below_its_base_circle_a_wave_is_no_steeper_than_anywhere():
    """The ends of the face still touch, on flanks above it: no curvature of the middle, which is none, counts."""
    pair = helical_pair(15.0)
    shares, plain = load_shares(pair, STIFFNESS, options(pair)), missing_material(pair, None)
    position = np.linspace(plain.start_m, plain.end_m, plain.pinion.profile_m.shape[1])
    assert position[0] < -0.1 * pair.base_pitch_m < pair.contact_start_m
    number, height = 164.0, 1e-6
    teeth = with_waves(plain, pair, waves(18, height, 0.0), waves(47, 0.0, 0.0), 1e5, shares).pinion
    wave = teeth.profile_m - plain.pinion.profile_m
    steepest = height * number / pair.pinion.base_radius_m
    # The band under the load grows along the path: its wave fades by up to a tenth of its height a period.
    assert np.abs(np.diff(wave, axis=1)).max() < 1.02 * steepest * (position[1] - position[0])
    assert np.abs(wave).max() < height


def test_helical_teeth_of_no_helix_miss_what_spur_teeth_do():
    near, spur = helical_pair(1e-7), helical_pair(0.0)
    shares = load_shares(near, STIFFNESS, options(near))
    both = []
    for pair, given in ((near, shares), (spur, None)):
        errors = drawn(pair, "pinion", 6), drawn(pair, "gear", 6)
        plain = missing_material(pair, None)
        of_waves = with_waves(plain, pair, waves(18, 2e-7, 1e-6), waves(47, 1e-7, 2e-6), 1e5, given)
        both.append((with_errors(plain, pair, *errors, given), of_waves))
    for one, other in zip(*both, strict=True):
        for which in ("pinion", "gear"):
            found, expected = getattr(one, which), getattr(other, which)
            # Profiles of a few µm, linear between points: 1e-10 m is what half a cell of the table changes.
            assert found.profile_m == pytest.approx(expected.profile_m, abs=1e-9)
            assert np.array_equal(found.offset_m, expected.offset_m)


def test_waves_of_the_machine_meet_all_slices_at_once_and_the_form_one_after_the_other():
    pair = helical_pair(20.0)
    shares, plain = load_shares(pair, STIFFNESS, options(pair)), missing_material(pair, None)
    inside = slice(600, 1400)

    def swing(table_m, form_m):
        teeth = with_waves(plain, pair, waves(18, table_m, form_m), waves(47, 0.0, 0.0), 0.0, shares).pinion
        return np.ptp((teeth.profile_m - plain.pinion.profile_m)[0, inside])

    assert swing(2e-7, 0.0) == pytest.approx(4e-7, rel=1e-2)
    spur = helical_pair(0.0)
    flat = missing_material(spur, None)
    whole = with_waves(flat, spur, waves(18, 0.0, 1e-6), waves(47, 0.0, 0.0), 0.0).pinion
    assert swing(0.0, 1e-6) < 0.5 * np.ptp(whole.profile_m[0, inside] - flat.pinion.profile_m[0, inside])


@pytest.mark.parametrize("helix_deg", [-25.0, 15.0])
def test_both_parts_of_the_load_have_the_sums_of_all_slices(helix_deg):
    pair = helical_pair(helix_deg)
    shares = load_shares(pair, STIFFNESS, options(pair))
    position = np.linspace(pair.engagement_start_m, pair.engagement_end_m, 501)
    before, first, second = shares.about(pair.pitch_point_m, position)
    place = position[:, None] + shares.shift_m
    cells = np.abs(shares.shift_m[1] - shares.shift_m[0])
    # force and moment about the pinion of a constant coefficient, slice by slice; fine parts of each slice
    parts = place[:, :, None] + cells * ((np.arange(200) + 0.5) / 200 - 0.5)
    sign = np.where(parts < pair.pitch_point_m, 1.0, -1.0).mean(axis=2)
    arm = np.where(parts < pair.pitch_point_m, parts, -parts).mean(axis=2)
    last = len(shares.share) - 1
    along = np.linspace(0.0, last, 501)
    load = np.stack([np.interp(along, np.arange(last + 1), column) for column in shares.share.T], axis=1)
    assert 2.0 * before - 1.0 == pytest.approx((load * sign).sum(axis=1), abs=2e-3)
    moment = before * (position + first) - (1.0 - before) * (position + second)
    assert moment == pytest.approx((load * arm).sum(axis=1), abs=2e-3 * pair.pitch_point_m)
    assert load.sum(axis=1) == pytest.approx(1.0, abs=1e-12)
