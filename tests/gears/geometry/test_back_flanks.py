"""Where back flanks touch, against involutes that are drawn point by point."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from siggen.gears.back_flanks import back_flanks, driven_pair, pitches_ahead
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import missing_material
from siggen.gears.spur_gear import SpurGear


def pair_of(teeth: tuple[int, int], shifts: tuple[float, float]) -> GearPair:
    pinion, gear = (SpurGear(z, 3e-3, np.deg2rad(20.0), x, 1.0, 0.25, 0.01) for z, x in zip(teeth, shifts, strict=True))
    return GearPair(pinion, gear, 0.02, 206e9, 0.3)


def flank(gear: SpurGear, roll: float, side: float) -> complex:
    """Return a point of the flank of a tooth that is centred on the real axis, ahead of it (1) or behind it (-1)."""
    point = gear.base_radius_m * np.exp(1j * gear.base_half_angle_rad) * np.exp(-1j * roll) * (1 + 1j * roll)
    return complex(point) if side > 0.0 else complex(np.conj(point))


def roll_on_line(gear: SpurGear, side: float, turned: float, centre: float, pair: GearPair, line: float) -> float:
    """Return at which roll angle a flank, turned about a centre, crosses the line of action (1: drive, -1: back)."""
    alpha = pair.working_pressure_angle_rad
    along = np.exp(1j * (np.pi / 2 - line * alpha))  # both lines pass through the pitch point
    pitch = pair.pinion.base_radius_m / np.cos(alpha)

    def beside(roll: float) -> float:
        point = centre + flank(gear, roll, side) * np.exp(1j * turned)
        return float(((point - pitch) * np.conj(along)).imag)

    return float(brentq(beside, 1e-3, gear.tip_roll_rad * 1.3, xtol=1e-15))


@pytest.mark.parametrize(("teeth", "shifts"), [((18, 47), (0.0, 0.0)), ((19, 31), (0.3, -0.1)), ((25, 25), (0.0, 0.0))])
def test_back_flanks_touch_where_drawn_involutes_cross_the_other_line_of_action(
    teeth: tuple[int, int], shifts: tuple[float, float]
):
    """The flank of the gear that closes there is that of the next tooth: without backlash both pass one point."""
    pair = pair_of(teeth, shifts)
    pinion, gear, step = pair.pinion, pair.gear, 2 * np.pi / pair.gear.teeth
    turned, distance = 0.03, pair.working_centre_distance_m
    on_drive = pinion.base_radius_m * roll_on_line(pinion, 1.0, turned, 0.0, pair, 1.0)
    # The gear turns the other way, and its teeth point at the pinion; both rolls add to the line of action.
    half = gear.base_half_angle_rad + pair.working_pressure_angle_rad
    about = np.pi - half + (pair.line_of_action_m - on_drive) / gear.base_radius_m
    from_gear = gear.base_radius_m * roll_on_line(gear, -1.0, about + step, distance, pair, -1.0)
    assert gear.base_radius_m * roll_on_line(gear, 1.0, about, distance, pair, 1.0) == pytest.approx(
        pair.line_of_action_m - on_drive, abs=1e-9
    )
    on_back = pinion.base_radius_m * roll_on_line(pinion, -1.0, turned, 0.0, pair, -1.0)
    assert from_gear == pytest.approx(pair.line_of_action_m - on_back, abs=1e-9)
    pitches = (on_drive - pair.contact_start_m) / pair.base_pitch_m + pitches_ahead(pair)
    told = driven_pair(pair).contact_start_m + pitches * pair.base_pitch_m
    assert told == pytest.approx(from_gear, abs=1e-9)  # a nanometre: roots are found to 1e-15 of a turn


def test_a_tooth_out_of_place_is_late_on_one_flank_and_early_on_the_other():
    pair = pair_of((18, 47), (0.0, 0.0))
    missing = missing_material(pair)
    pinion, gear = np.zeros(18), np.zeros(47)
    pinion[5], gear[7] = 3e-6, 2e-6
    placed = replace(
        missing,
        pinion=replace(missing.pinion, offset_m=pinion),
        gear=replace(missing.gear, offset_m=gear),
    )
    back = back_flanks(placed, pair)
    # pair 5 is that of pinion tooth 5 and gear tooth 6; gear tooth 7 meets pinion tooth 6
    assert (back.pinion.offset_m[5], back.gear.offset_m[6]) == (-3e-6, -2e-6)
    assert np.count_nonzero(back.pinion.offset_m) == np.count_nonzero(back.gear.offset_m) == 1


def test_back_flanks_miss_what_drive_flanks_of_the_driven_pair_would():
    pair = pair_of((18, 47), (0.2, -0.2))
    found, expected = back_flanks(missing_material(pair), pair), missing_material(driven_pair(pair))
    assert (found.start_m, found.end_m) == pytest.approx((expected.start_m, expected.end_m), abs=1e-12)
    # tips and relief of the gear that is in front stand first there
    assert found.gear.profile_m == pytest.approx(expected.pinion.profile_m, abs=1e-12)
    assert found.pinion.profile_m == pytest.approx(expected.gear.profile_m, abs=1e-12)
