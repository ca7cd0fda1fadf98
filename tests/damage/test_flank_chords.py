from __future__ import annotations

import numpy as np
import pytest

from siggen.damage.flank_chords import depth_on_line, flank_chords
from siggen.mesh.face_slices import FaceGaps, face_gaps
from siggen.mesh.sections import contact_length_loss
from tests.gears.builders import layers, pair_18_47, pit
from tests.gears.pit_shapes import arc_of, chord_pit

PAIR = pair_18_47(module_m=3e-3)
WIDTH = PAIR.face_width_m
CENTRE = PAIR.pitch_point_m - 0.3e-3


def gaps(pinion_pits=(), gear_pits=(), position=(CENTRE,), slices=200) -> FaceGaps:
    pinion = flank_chords(PAIR.pinion, pinion_pits, WIDTH, slices)
    gear = flank_chords(PAIR.gear, gear_pits, WIDTH, slices)
    return face_gaps(PAIR, pinion, gear, np.atleast_1d(np.asarray(position, dtype=np.float64)))


def edge_of(found: FaceGaps) -> np.ndarray:
    """Distance to the nearer edge of the damage under the contact (positions, slices), 0 on land [m]."""
    return np.where(found.on_damage > 0.0, np.minimum(found.left_m, found.right_m), 0.0)


@pytest.mark.parametrize("which", ["pinion", "gear"])
@pytest.mark.parametrize("offset", [-0.9, -0.3, 0.0, 0.4, 0.9])
def test_a_chord_is_measured_as_an_arc_along_the_damaged_flank(which: str, offset: float) -> None:
    length = 1.5e-3
    wide = chord_pit(PAIR, length, CENTRE, which=which)
    target = arc_of(PAIR, which, CENTRE) + offset * 0.5 * length
    travel = np.sqrt(2.0 * target * PAIR.member(which).base_radius_m)
    position = travel if which == "pinion" else PAIR.line_of_action_m - travel
    found = gaps(**{f"{which}_pits": (wide,)}, position=position)
    # The ellipse is 1 m wide: its chord narrows by 5e-5 over the face.
    np.testing.assert_allclose(edge_of(found), 0.5 * length * (1.0 - abs(offset)), atol=1e-4 * length)
    np.testing.assert_array_equal(found.floor_m, 1e-3)


def test_an_arc_of_a_millimetre_lasts_several_in_the_path_of_contact() -> None:
    wide = chord_pit(PAIR, 1.5e-3, PAIR.pitch_point_m)
    position = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 4001)
    inside = position[gaps((wide,), position=position).on_damage[:, 100] > 0.0]
    # Published 4.2 mm, to two digits; to first order 1.5 mm R_b1/s.
    assert inside[-1] - inside[0] == pytest.approx(4.2e-3, abs=0.06e-3)


def test_the_damaged_share_of_the_face_is_the_exact_union() -> None:
    pits = layers(3, 8, step_face_mm=0.5, step_height_mm=0.15, height_mm=1.5, stagger_mm=0.25)
    position = np.linspace(CENTRE - 2e-3, CENTRE + 2e-3, 101)
    found = gaps(pits, position=position, slices=4000).on_damage.mean(axis=1) * WIDTH
    height = PAIR.pinion.height_m(position / PAIR.pinion.base_radius_m)
    exact = contact_length_loss(pits, WIDTH, height)
    assert exact.max() > 4e-3
    # Every end of the union is off by half a slice at the most, 2.5 µm; 8 columns have up to 16 ends.
    np.testing.assert_allclose(found, exact, atol=16 * 2.5e-6)


def test_pits_of_mating_flanks_join_where_they_touch() -> None:
    first = chord_pit(PAIR, 0.6e-3, CENTRE, depth_m=20e-6)
    second = chord_pit(PAIR, 1.4e-3, CENTRE, depth_m=30e-6, which="gear")
    alone, both = gaps((first,)), gaps((first,), (second,))
    assert edge_of(alone)[0, 100] == pytest.approx(0.3e-3, rel=1e-3)
    assert edge_of(both)[0, 100] == pytest.approx(0.7e-3, rel=1e-3)
    assert both.floor_m[0, 100] == pytest.approx(50e-6, rel=1e-12)


def test_the_floor_of_a_dish_is_deepest_in_its_middle() -> None:
    dish = chord_pit(PAIR, 1.5e-3, CENTRE, depth_m=0.1e-3, semi_face_m=4e-3, floor="dish")
    depth = gaps((dish,), slices=201).floor_m[0]
    assert depth.max() == pytest.approx(0.1e-3, rel=1e-3)
    assert (np.diff(depth[60:101]) > 0.0).all()
    assert depth[0] == 0.0


def test_the_floor_of_crowded_pits_is_the_deepest_one_that_holds_the_point() -> None:
    rng = np.random.default_rng(3)
    crowd = [pit(*rng.uniform((1.0, 0.0, 0.2, 0.1, 0.1), (3.0, 20.0, 1.0, 0.5, 0.4)), floor) for floor in ["dish"] * 60]
    flank = flank_chords(PAIR.pinion, crowd, WIDTH, 40)
    for height in np.linspace(1e-3, 3e-3, 21):
        found = [depth_on_line(j, height, flank.face_m, flank.pits, *flank.lines) for j in range(40)]
        u = (height - np.array([p.height_m for p in crowd])) / [p.semi_axis_profile_m for p in crowd]
        v = (flank.face_m[:, None] - [p.face_m for p in crowd]) / [p.semi_axis_face_m for p in crowd]
        square = np.square([p.depth_m for p in crowd]) * (1.0 - u**2 - v**2)
        assert found == pytest.approx(np.sqrt(np.maximum(square.max(axis=1), 0.0)), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", ["a_mm", "b_mm", "depth_mm"])
def test_pits_without_extent_are_no_pits(name: str) -> None:
    none = flank_chords(PAIR.pinion, (), WIDTH, 20)
    for got, expected in zip(flank_chords(PAIR.pinion, (pit(**{name: 0.0}),), WIDTH, 20), none, strict=True):
        np.testing.assert_equal(got, expected)
