"""Unbalance by chipped and missing teeth: against a rectangle, a sum over cells, opposite teeth and the centre line."""

from __future__ import annotations

from math import atan2, cos, inf, pi, radians, sin, tan

import numpy as np
import pytest

from siggen.damage.chip import PartChip, WholeChip, lost_outline, tooth_height_m
from siggen.damage.part import STEEL_KG_M3, Parts, lost_moment_kg_m
from siggen.drivetrain.drive import Turning
from siggen.drivetrain.excitation import turning_sense
from siggen.drivetrain.structure import Structure
from siggen.gears.gear_pair import GearPair
from siggen.record.drive import lost_mass_sources
from siggen.record.structure import structure
from tests.damage.test_damage import config_with
from tests.gears.builders import pair_18_47

PAIR = pair_18_47()
WIDTH, TIP, PITCH = PAIR.face_width_m, PAIR.pinion.tip_radius_m, PAIR.pinion.pitch_radius_m


def part_chip(height_m: float, width_m: float) -> PartChip:
    return PartChip("pinion", 3, height_m, width_m, lost_outline(PAIR.pinion, height_m, width_m))


def test_a_sliver_of_the_tip_is_a_rectangle_at_the_tip_radius() -> None:
    sliver, land = 1e-6, 2.0 * PAIR.pinion.tip_half_thickness_m
    rectangle = STEEL_KG_M3 * WIDTH * land * sliver * (TIP - 0.5 * sliver)
    # 1 µm down a tooth is wider by 2 tan 30° µm at most: half of that over a land of 2.5 mm is 5e-4.
    assert lost_moment_kg_m(PAIR.pinion, WholeChip("pinion", 0, sliver), WIDTH) == pytest.approx(rectangle, rel=5e-4)


def test_the_moment_is_a_sum_over_cells_inside_of_the_flanks_of_the_textbook() -> None:
    """Tooth thickness 2 r (π/2z + inv α0 - inv α) on the circle of radius r, r cos α = R_b."""
    height_m, part = 2e-3, part_chip(2e-3, 0.5 * WIDTH)
    found = lost_moment_kg_m(PAIR.pinion, part, WIDTH)
    along, across = np.meshgrid(np.linspace(24e-3, 36e-3, 1201), np.linspace(-4e-3, 4e-3, 801), indexing="ij")
    radius = np.hypot(along, across)
    pressure = np.arccos(np.minimum(PAIR.pinion.base_radius_m / radius, 1.0))
    half = pi / 36 + (tan(radians(20)) - radians(20)) - (np.tan(pressure) - pressure)
    inside = (radius > TIP - height_m) & (radius < TIP) & (np.abs(np.arctan2(across, along)) < half)
    cell = 1e-5 * 1e-5
    slow = STEEL_KG_M3 * cell * 0.5 * WIDTH * float((along * inside).sum())
    # Cells of 10 µm on a tip of 2.5 mm.
    assert found == pytest.approx(slow, rel=2e-3)


def test_shares_of_the_face_add_up_and_a_whole_tooth_weighs_about_three_square_modules() -> None:
    whole = lost_moment_kg_m(PAIR.pinion, WholeChip("pinion", 0, 2e-3), WIDTH)
    parts = [lost_moment_kg_m(PAIR.pinion, part_chip(2e-3, share * WIDTH), WIDTH) for share in (0.3, 0.7)]
    assert sum(parts) == pytest.approx(whole, rel=1e-12)
    gone = lost_moment_kg_m(PAIR.pinion, WholeChip("pinion", 0, inf), WIDTH)
    area = gone / (STEEL_KG_M3 * WIDTH * PITCH)
    # 2.25 modules high, half a pitch thick in the middle: 3.5 square modules, and the fillets' feet.
    assert area == pytest.approx(2.25 * pi / 2.0 * PAIR.pinion.module_m**2, rel=0.1)
    assert gone == lost_moment_kg_m(PAIR.pinion, WholeChip("pinion", 0, tooth_height_m(PAIR.pinion)), WIDTH)


def machine() -> tuple[Structure, GearPair]:
    config = config_with({"kind": "chip", "height_mm": 1.0})
    specimen = config.gearbox(0)
    return structure(specimen), specimen.pair


def forces_n(parts: Parts, angle_rad: float) -> dict[str, np.ndarray]:
    """Return the force of each source on its shaft at 30 Hz, horizontal and vertical."""
    found, pair = machine()
    turning = Turning(np.zeros(1), np.array([angle_rad]), np.array([60.0 * pi]), np.zeros(1))
    sources = lost_mass_sources(pair, found, parts)
    return {part: source.inputs(turning)[0] for part, source in zip(("pinion", "gear"), sources, strict=False)}


def test_a_missing_tooth_pulls_with_m_r_omega_squared_and_its_opposite_cancels_it() -> None:
    one, other = WholeChip("pinion", 0, inf), WholeChip("pinion", 9, inf)
    force = forces_n((one,), 0.4)["pinion"]
    pair = machine()[1]
    expected = lost_moment_kg_m(pair.pinion, one, pair.face_width_m) * (60.0 * pi) ** 2
    assert np.hypot(*force) == pytest.approx(expected, rel=1e-12)
    assert np.hypot(*forces_n((one, other), 0.4)["pinion"]) < 1e-12 * expected
    assert forces_n((), 0.4) == {}


def test_missing_teeth_push_away_from_each_other_when_they_would_meet_at_the_pitch_point() -> None:
    """Then a tooth's centre line is half a tooth behind (driving) or in front of (driven) the line of centres."""
    found, pair = machine()
    alpha, number = radians(20.0), 5
    pitch_point = pair.pinion.pitch_radius_m * sin(alpha)
    angle = 2.0 * pi * (number + (pitch_point - pair.contact_start_m) / pair.base_pitch_m) / 18
    pulls = forces_n((WholeChip("pinion", number, inf), WholeChip("gear", number, inf)), angle)
    for which, teeth, side in (("pinion", 18, -1.0), ("gear", 47, 1.0)):
        place = f"{which}_bearing"
        sense = turning_sense(found, place)
        rows = [found.coordinates.index(f"{axis}_{which}") for axis in "xy"]
        shown = np.array([found.bearing_directions[f"{place}/{axis}"][rows] for axis in ("horizontal", "vertical")])
        # Flanks move along the line of action: 90° in front of the way to the mate, less α (driving) or more (driven).
        along = shown @ (found.mesh.vector[rows] * (1.0 if which == "pinion" else -1.0))
        to_mate = atan2(along[1], along[0]) - sense * (0.5 * pi + side * alpha)
        tooth = to_mate + sense * side * 0.5 * pi / teeth
        unit = pulls[which] / np.hypot(*pulls[which])
        np.testing.assert_allclose(unit, [-cos(tooth), -sin(tooth)], atol=1e-9)
