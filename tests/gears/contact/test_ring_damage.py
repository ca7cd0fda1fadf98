"""Damage on the hollow flank of a ring: how far a planet sinks, where, and how much of the flank is gone."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.arrays import FloatArray
from siggen.damage.outlines import rectangle
from siggen.damage.spalls import FlankSpall
from siggen.gears.gear_pair import GearPair
from siggen.gears.planetary import InternalPair, ring_round
from siggen.mesh.contact_table import ContactTable, contact_table
from siggen.mesh.damage_summary import damage_summary
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions
from tests.gears.builders import spur_gear

HALF_M = 0.5e-3
SHARP = TableOptions(edge_radius_m=0.0)


def planet_in_ring() -> InternalPair:
    return ring_round(GearPair(spur_gear(25, 2e-3, 8e-3), spur_gear(26, 2e-3, 8e-3), 20e-3, 206e9, 0.3), 77)


def spalled(
    pair: InternalPair, position_m: float, across_m: float = 20e-3, half_m: float = HALF_M
) -> tuple[FlankSpall, ...]:
    """Return a spall of a ring's tooth about the contact at a position."""
    height = float(pair.gear.height_m((position_m - pair.line_of_action_m) / pair.gear.base_radius_m))
    return (FlankSpall("gear", 3, rectangle((height - half_m, height + half_m), (0.0, across_m)), 1e-4),)


def sink_of_outlines_m(pair: InternalPair, position_m: float, spall: FlankSpall) -> float:
    """Return by how much the planet turns until its flank meets the ring's beside a spall, along the line of action.

    From points of both involutes round the ring's centre; nothing is shared with the contact's own geometry.
    """
    planet, ring, angle = pair.pinion, pair.gear, pair.working_pressure_angle_rad
    roll = np.linspace(planet.involute_start_roll_rad, planet.tip_roll_rad, 40_001)
    turned = angle - position_m / planet.base_radius_m + roll - np.arctan(roll)
    radius = planet.base_radius_m * np.hypot(1.0, roll)
    x, y = pair.working_centre_distance_m + radius * np.cos(turned), radius * np.sin(turned)
    from_ring = np.hypot(x, y)
    on_flank = (from_ring > ring.tip_radius_m) & (from_ring < ring.root_radius_m)
    slant = np.arccos(ring.base_radius_m / from_ring[on_flank])
    origin = angle - (position_m - pair.line_of_action_m) / ring.base_radius_m
    gap = np.abs(np.arctan2(y, x)[on_flank] - (origin + np.tan(slant) - slant)) * ring.base_radius_m
    height = ring.height_m(np.tan(slant))
    low, high = spall.outline.height_range_m
    return float(gap[(height < low) | (height > high)].min())


def touch_um(table: ContactTable, pair: InternalPair, position_m: FloatArray) -> FloatArray:
    places = np.linspace(pair.contact_start_m, pair.contact_end_m, table.touch_m.shape[1])
    return 1e6 * np.interp(position_m, places, table.touch_m[1])


@pytest.mark.parametrize("half_m", [HALF_M, 0.25 * HALF_M])
@pytest.mark.parametrize("share", [0.4, 0.6])
def test_a_planet_sinks_into_a_spall_of_the_ring_as_far_as_the_outlines_let_it(share: float, half_m: float) -> None:
    pair = planet_in_ring()
    position = pair.contact_start_m + share * (pair.contact_end_m - pair.contact_start_m)
    (spall,) = spalled(pair, position, half_m=half_m)
    table = contact_table(pair, (spall,), StiffnessOptions(), SHARP)
    places = position + np.array([-half_m, 0.0, half_m])
    expected = [1e6 * sink_of_outlines_m(pair, float(place), spall) for place in places]
    # edges stand on a parabola: the next term of the involutes' gap is the length over the radius of curvature
    assert touch_um(table, pair, places) == pytest.approx(expected, rel=2.0 * half_m / position)


def test_a_spall_over_half_the_face_leaves_land_that_carries_and_no_sink() -> None:
    pair = planet_in_ring()
    damage = spalled(pair, pair.pitch_point_m, 10e-3)
    table = contact_table(pair, damage, StiffnessOptions(), SHARP)
    assert table.touch_m[1].max() < 1e-12
    assert damage_summary(pair, damage).contact_length_loss_m == pytest.approx(10e-3, rel=1e-9)


def test_the_lost_area_is_that_of_the_arc_between_both_edges() -> None:
    pair = planet_in_ring()
    (spall,) = spalled(pair, pair.pitch_point_m)
    roll = np.asarray(pair.gear.roll_at_height(np.array(spall.outline.height_range_m)))
    arc = 0.5 * pair.gear.base_radius_m * float(np.diff(roll**2)[0])
    found = damage_summary(pair, (spall,))
    assert found.union_area_m2 == pytest.approx(arc * 20e-3, rel=1e-9)
    assert found.through_face
    assert 0.0 < found.area_share < 1.0
