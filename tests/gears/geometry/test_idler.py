"""Phase of both meshes of an idler: closed forms, and a tooth that is turned until it touches."""

from __future__ import annotations

from math import acos, hypot, pi, radians, tan

import pytest

from siggen.gears.gear_pair import GearPair, SpurGear, idler_ahead_pitches


def gear(teeth: int, shift: float = 0.0) -> SpurGear:
    return SpurGear(teeth, 2e-3, radians(20.0), shift, 1.0, 0.25, 8e-3)


def pairs(teeth: tuple[int, int, int], shift: float = 0.0) -> tuple[GearPair, GearPair]:
    a, b, c = gear(teeth[0]), gear(teeth[1], shift), gear(teeth[2])
    return GearPair(a, b, 20e-3, 206e9, 0.3), GearPair(b, c, 20e-3, 206e9, 0.3)


def of_pitch_points(front: GearPair, behind: GearPair, between_rad: float) -> float:
    """Return by how much of a pitch contact is past one pitch point when it is at the other, 0 to below 1."""
    to_first, to_second = ((one.pitch_point_m - one.contact_start_m) / one.base_pitch_m for one in (front, behind))
    return (idler_ahead_pitches(front, behind, between_rad) + to_first - to_second) % 1.0


@pytest.mark.parametrize("teeth", [26, 27])
@pytest.mark.parametrize("between_deg", [180.0, 120.0, 97.3])
def test_the_phase_between_both_pitch_points_is_by_teeth_and_angle_alone(teeth: int, between_deg: float) -> None:
    """Half a tooth lies between both flanks: z χ/2π + 1/2. In one line that is 1/2 for even teeth, and 0 for odd."""
    found = of_pitch_points(*pairs((18, teeth, 35)), radians(between_deg))
    expected = (teeth * between_deg / 360.0 + 0.5) % 1.0
    assert (found - expected + 0.5) % 1.0 == pytest.approx(0.5, abs=1e-12)


def test_a_gear_behind_that_is_one_pitch_farther_on_is_met_one_tooth_later() -> None:
    front, behind = pairs((18, 27, 35), 0.3)
    one, next_one = (idler_ahead_pitches(front, behind, angle) for angle in (2.0, 2.0 - 2.0 * pi / 27))
    assert one - next_one == pytest.approx(1.0, abs=1e-12)


def flank_angle(idler: SpurGear, radius: float) -> float:
    """Return half the angle of a tooth at a radius: s/2r = s_0/2r_0 + inv(alpha_0) - inv(alpha)."""

    def involute(r: float) -> float:
        angle = acos(idler.base_radius_m / r)
        return tan(angle) - angle

    pitch = idler.pitch_radius_m
    thickness = idler.module_m * (0.5 * pi + 2.0 * idler.profile_shift * tan(idler.pressure_angle_rad))
    return 0.5 * thickness / pitch + involute(pitch) - involute(radius)


@pytest.mark.parametrize("shift", [0.0, 0.4])
def test_a_tooth_turned_until_it_touches_either_gear_says_the_same(shift: float) -> None:
    """Angles of the middle of tooth 0, which turns forwards: its tip meets one gear, the other's tip meets it."""
    front, behind = pairs((18, 27, 35), shift)
    idler, between, at_front = behind.pinion, 2.3, 0.7
    tip, inner = idler.tip_radius_m, hypot(idler.base_radius_m, behind.contact_start_m)
    # contact lies on the line of action, whose foot is ahead of the gear in front and short of that behind
    touches = at_front + front.working_pressure_angle_rad - acos(idler.base_radius_m / tip)
    entered = touches + flank_angle(idler, tip)
    touches = at_front - between - behind.working_pressure_angle_rad + acos(idler.base_radius_m / inner)
    later = touches - flank_angle(idler, inner)
    expected = (entered - later) * idler.teeth / (2.0 * pi)
    found = idler_ahead_pitches(front, behind, between)
    assert (found - expected + 0.5 * idler.teeth) % idler.teeth == pytest.approx(0.5 * idler.teeth, abs=1e-9)
