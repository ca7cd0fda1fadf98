from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.dynamics.friction.contact_kinematics import relative_radius
from siggen.dynamics.mesh.slice_law import (
    SliceLaw,
    SliceOptions,
    slice_contact_length,
    slice_law,
    slice_law_error,
    slice_on_damage,
    slice_pair_force,
)
from siggen.gears.stiffness.mesh_stiffness import contact_compliance, pair_stiffness
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from tests.gears.builders import layers, pair_18_47, pit
from tests.gears.pit_shapes import arc_of, chord_pit

PAIR = pair_18_47(module_m=3e-3, bores_m=(10e-3, 15e-3))
STIFFNESS = StiffnessOptions(beam="rack_trochoid")  # the numbers below belong to this tooth
SHARP = SliceOptions(59e3, edge_radius_m=0.0)
CENTRE = PAIR.pitch_point_m - 0.3e-3
HEALTHY = slice_law(PAIR, (), STIFFNESS, SHARP)
DEPTHS = np.array([3e-6, 5e-6, 8e-6, 45e-6])
POSITIONS = st.floats(PAIR.contact_start_m, PAIR.contact_end_m)


def law(*damage, **other) -> SliceLaw:
    return slice_law(PAIR, damage, STIFFNESS, SHARP._replace(**other))


THROUGH = law(chord_pit(PAIR, 1.5e-3, CENTRE))
LANDS = law(chord_pit(PAIR, 1.5e-3, CENTRE, semi_face_m=5e-3))


def first_touch(table: SliceLaw, position: float) -> float:
    """Penetration at which the force of row 1 sets in."""
    low, high = 0.0, 1e-3
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if slice_pair_force(table, 1, position, middle) > 0.0 else (middle, high)
    return high


@pytest.mark.parametrize("name", ["a_mm", "b_mm", "depth_mm"])
def test_pits_without_extent_leave_the_healthy_law_to_the_bit(name: str) -> None:
    for got, expected in zip(law(pit(height_mm=1.6, **{name: 0.0})), HEALTHY, strict=True):
        np.testing.assert_array_equal(got, expected)


@settings(deadline=None)
@given(position=POSITIONS, depth=st.floats(-1e-5, 1e-4))
def test_a_healthy_pair_is_one_linear_spring(position: float, depth: float) -> None:
    force = slice_pair_force(THROUGH, 0, position, depth)
    assert force == slice_pair_force(HEALTHY, 0, position, depth)
    direct = float(pair_stiffness(PAIR, position, STIFFNESS)[0]) * max(depth, 0.0)
    # Linear interpolation between 2049 points.
    assert force == pytest.approx(direct, rel=1e-5)


def test_away_from_the_pit_the_damaged_tooth_is_healthy_to_the_bit() -> None:
    for position in (PAIR.contact_start_m, CENTRE - 4e-3, CENTRE + 4e-3, PAIR.contact_end_m):
        assert slice_pair_force(THROUGH, 1, position, 5e-6) == slice_pair_force(THROUGH, 0, position, 5e-6)
        assert slice_contact_length(THROUGH, 1, position) == PAIR.face_width_m
        assert slice_on_damage(THROUGH, 1, position) == 0.0


@pytest.mark.parametrize("depth", [1e-3, 20e-6])
@pytest.mark.parametrize("share", [0.0, -0.3, 0.3, -0.6, 0.6])
def test_a_pit_through_the_face_sinks_to_its_floor_or_between_its_edges(depth: float, share: float) -> None:
    length = 1.5e-3
    table = law(chord_pit(PAIR, length, CENTRE, depth_m=depth))
    arc = arc_of(PAIR, "pinion", CENTRE) + share * 0.5 * length
    position = float(np.sqrt(2.0 * arc * PAIR.pinion.base_radius_m))
    radius = relative_radius(position, PAIR.line_of_action_m)
    expected = min(depth, (0.5 * length * (1.0 - abs(share))) ** 2 / (2.0 * radius))
    # The kink lies within one cell of 7 µm, in which the sink changes by 0.3 µm; its mean error is half of that.
    assert first_touch(table, position) == pytest.approx(expected, abs=0.2e-6)


def test_the_sink_is_continuous_at_the_ends_of_the_pit() -> None:
    position = np.linspace(CENTRE - 3e-3, CENTRE + 3e-3, 2001)
    force = np.array([slice_pair_force(THROUGH, 1, s, 5e-6) for s in position])
    # The sink's slope in s is up to 0.04, so 0.12 µm of 5 per step of 3 µm: less than 4 %.
    assert np.abs(np.diff(force)).max() < 0.04 * force.max()
    assert force.min() == 0.0


def test_lands_beside_a_pit_leave_no_displacement_excitation() -> None:
    position = np.linspace(CENTRE - 3e-3, CENTRE + 3e-3, 301)
    for depth in (0.05e-6, 1e-6, 5e-6):
        ratio = np.array(
            [slice_pair_force(LANDS, 1, s, depth) / slice_pair_force(LANDS, 0, s, depth) for s in position]
        )
        assert ratio.min() > 0.9
        assert ratio.max() <= 1.0 + 1e-12


@pytest.mark.parametrize(("lost", "published"), [(0.1, 0.007), (0.3, 0.025), (0.5, 0.056)])
def test_the_loss_of_contact_length_alone_is_small(lost: float, published: float) -> None:
    table = law(chord_pit(PAIR, 3e-3, CENTRE, semi_face_m=0.5 * lost * PAIR.face_width_m), slices=2000)
    ratio = slice_pair_force(table, 1, CENTRE, 5e-6) / slice_pair_force(table, 0, CENTRE, 5e-6)
    # Published without the position, along which the stiffness differs by 40 %; here 0.71, 2.7 and 6.0 %.
    assert 1.0 - ratio == pytest.approx(published, rel=0.1)


def test_a_pit_much_shorter_than_the_hertz_band_has_no_effect() -> None:
    table = law(chord_pit(PAIR, 2e-6, CENTRE))
    ratio = slice_pair_force(table, 1, CENTRE, 5e-6) / slice_pair_force(table, 0, CENTRE, 5e-6)
    assert ratio == pytest.approx(1.0, abs=1e-4)
    assert slice_contact_length(table, 1, CENTRE) > 0.97 * PAIR.face_width_m


@settings(deadline=None)
@given(position=POSITIONS, depth=st.floats(0.0, 1e-4), step=st.floats(1e-8, 1e-5))
def test_the_force_grows_with_the_approach(position: float, depth: float, step: float) -> None:
    for table in (THROUGH, LANDS):
        low, high = (slice_pair_force(table, 1, position, d) for d in (depth, depth + step))
        # Rounding of forces of up to 2e4 N.
        assert 0.0 <= low <= high + 1e-9
        assert high - low <= 1.0001 * slice_pair_force(table, 0, position, step) + 1e-8


@pytest.mark.parametrize(
    ("damage", "bound"),
    [
        (layers(2, 8, height_mm=1.6), 0.001),
        ((chord_pit(PAIR, 1.5e-3, CENTRE),), 0.005),
        (layers(2, 8, height_mm=1.6, a_mm=1.2, b_mm=0.5, step_face_mm=2.4), 0.04),
    ],
    ids=["16 pits", "through the face", "96 % of the face"],
)
def test_the_table_is_as_accurate_as_it_says(damage: tuple, bound: float) -> None:
    table = slice_law(PAIR, damage, STIFFNESS, SHARP)
    assert slice_law_error(PAIR, damage, STIFFNESS, SHARP, table, DEPTHS) < bound


def test_a_loss_of_sections_is_a_separate_switch() -> None:
    damage = chord_pit(PAIR, 1.5e-3, CENTRE, depth_m=0.4e-3, semi_face_m=8e-3)
    without, with_loss = law(damage), law(damage, section_loss=True)
    np.testing.assert_array_equal(without.stiffness_n_per_m[0], without.stiffness_n_per_m[1])
    position = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 2049)
    # The pair with pits, its shorter contact exchanged for the whole one: what is left are the sections.
    compliance = 1.0 / pair_stiffness(PAIR, position, STIFFNESS, (damage,))
    compliance += contact_compliance(PAIR, position) - contact_compliance(PAIR, position, (damage,))
    np.testing.assert_allclose(with_loss.stiffness_n_per_m[1], 1.0 / compliance, rtol=1e-12)
    assert (with_loss.stiffness_n_per_m[1] < with_loss.stiffness_n_per_m[0]).any()


def test_the_contact_line_is_on_damage_for_the_share_of_the_pits() -> None:
    # Twice the semi-axis of 5 mm of 20 mm.
    assert slice_on_damage(LANDS, 1, CENTRE) == pytest.approx(0.5, abs=0.01)
    assert slice_contact_length(LANDS, 1, CENTRE) == pytest.approx(0.5 * PAIR.face_width_m, rel=0.02)
    assert slice_on_damage(THROUGH, 1, CENTRE) == 1.0


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"line_load_n_per_m": 0.0}, "line_load_n_per_m"),
        ({"edge_radius_m": -1.0}, "edge_radius_m"),
        ({"slices": 0}, "slices"),
        ({"groups": 0}, "groups"),
    ],
)
def test_impossible_options_are_refused_by_name(change: dict, name: str) -> None:
    with pytest.raises(ValueError, match=name):
        law(**change)
    with pytest.raises(ValueError, match="points"):
        slice_law(PAIR, (), STIFFNESS, SHARP, points=1)


@pytest.mark.parametrize("length", [0.2e-3, 0.3e-3, 0.8e-3])
def test_two_pairs_share_the_load_as_the_gap_of_a_pit_demands(length: float) -> None:
    position, load = 5e-3, 1182.4
    table = law(chord_pit(PAIR, length, position))
    mate = position + PAIR.base_pitch_m
    assert mate < PAIR.contact_end_m
    first, second = (float(pair_stiffness(PAIR, s, STIFFNESS)[0]) for s in (position, mate))
    gap = length**2 / (8.0 * relative_radius(position, PAIR.line_of_action_m))
    low, high = 0.0, 1e-4
    for _ in range(80):
        middle = 0.5 * (low + high)
        carried = slice_pair_force(table, 1, position, middle) + slice_pair_force(table, 0, mate, middle)
        low, high = (middle, high) if carried < load else (low, middle)
    share = slice_pair_force(table, 1, position, high) / load
    expected = first / (first + second) * (1.0 - second * gap / load)
    # The gap has its kink in a cell of 7 µm: 0.05 µm of some 5 µm of deflection.
    assert share == pytest.approx(max(expected, 0.0), abs=0.01)


SLICES = SHARP.slices
TILT = 10e-6 * ((np.arange(SLICES) + 0.5) / SLICES - 0.5)
"""Shafts out of parallel by 10 µm over the face."""


def test_a_lead_of_zeros_is_none_to_the_bit() -> None:
    damage = chord_pit(PAIR, 1.5e-3, CENTRE, semi_face_m=5e-3)
    for got, expected in zip(
        slice_law(PAIR, (damage,), STIFFNESS, SHARP, lead_m=np.zeros(SLICES)), law(damage), strict=True
    ):
        np.testing.assert_array_equal(got, expected)


def test_a_tilted_face_touches_at_its_end_first() -> None:
    tilted = slice_law(PAIR, (), STIFFNESS, SHARP, lead_m=TILT)
    assert tilted.lead_m == TILT.min()
    middle = 2e-6
    contact = 1.0 / contact_compliance(PAIR, CENTRE)[0]
    pair = float(pair_stiffness(PAIR, CENTRE, STIFFNESS)[0])
    compliance = 1.0 / pair - 1.0 / contact
    # Hertz springs k_h/L over the face, in contact down to p = d - C N: N = k_h p²/(2 F_β).
    low, high = 0.0, middle
    for _ in range(100):
        p = 0.5 * (low + high)
        low, high = (p, high) if p + compliance * contact * p**2 / 20e-6 < middle else (low, p)
    # 32 groups, and their last one in part: of a force that grows with the square.
    assert slice_pair_force(tilted, 0, CENTRE, middle) == pytest.approx(contact * p**2 / 20e-6, rel=0.02)
    assert slice_contact_length(tilted, 0, CENTRE) == PAIR.face_width_m
    # Far beyond the tilt the mean plane counts: d from the face's end less half the tilt.
    deep = slice_pair_force(tilted, 0, CENTRE, 200e-6)
    assert deep == pytest.approx(pair * (200e-6 + TILT.min()), rel=1e-6)


def test_a_lead_and_pits_add_up_as_all_slices_do() -> None:
    damage = (chord_pit(PAIR, 1.5e-3, CENTRE, semi_face_m=5e-3),)
    table = slice_law(PAIR, damage, STIFFNESS, SHARP, lead_m=TILT)
    # Depths count from the end that touches first; the groups' coarseness shows at small ones.
    assert slice_law_error(PAIR, damage, STIFFNESS, SHARP, table, np.array([5e-6, 8e-6, 45e-6]), TILT) < 0.01


@pytest.mark.parametrize("wrong", [np.zeros(3), np.full(SLICES, np.nan)])
def test_a_lead_on_other_slices_is_refused(wrong: np.ndarray) -> None:
    with pytest.raises(ValueError, match="lead_m: received shape"):
        slice_law(PAIR, (), STIFFNESS, SHARP, lead_m=wrong)
