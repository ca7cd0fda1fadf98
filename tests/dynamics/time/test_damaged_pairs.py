"""Pitted flanks in the pair law: lands, sinks through the face, and what they do to a running gearbox."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.dynamics.drive.drive import Drive
from siggen.dynamics.friction.contact_kinematics import relative_radius
from siggen.dynamics.friction.friction import constant_friction
from siggen.dynamics.mesh.pair_columns import CARRYING, FLANK, NORMAL
from siggen.dynamics.mesh.pair_forces import pair_forces, static_approach_m, static_force
from siggen.dynamics.mesh.pair_law import PairLaw, SqueezeFilm, pair_law
from siggen.dynamics.mesh.pair_places import pair_table
from siggen.dynamics.mesh.slice_law import (
    SliceLaw,
    SliceOptions,
    largest_sink_m,
    slice_law,
    slice_pair_force,
    slice_tables,
)
from siggen.dynamics.time.response import response_of
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.missing_material import missing_material
from siggen.gears.stiffness.mesh_tables import mesh_tables
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from tests.dynamics.casing_stage import make_structure
from tests.dynamics.pair_runs import RELIEF, columns, gear_pair, motion, settled
from tests.gears.builders import pit
from tests.gears.pit_shapes import chord_pit

PAIR = gear_pair()
STIFFNESS = StiffnessOptions("base_circle", "sainsot", "profile")
SHARP = SliceOptions(59e3, edge_radius_m=0.0)
PITCH_POINT = PAIR.pitch_point_m
ARC = PITCH_POINT**2 / (2.0 * PAIR.pinion.base_radius_m)
FORCE = 30.0 / PAIR.pinion.base_radius_m


def slices_of(damage: Damage, **other) -> SliceLaw:
    return slice_law(PAIR, damage, STIFFNESS, SHARP._replace(**other), lead_m=None)


def damaged(*damage, slices: SliceLaw | None = None, **other) -> PairLaw:
    found = slices_of(damage) if slices is None else slices
    numbers = {"damping_ratio": 0.07, "equivalent_mesh_mass_kg": 0.2124, "backlash_m": 80e-6} | other
    return pair_law(
        slice_tables(PAIR, damage, found),
        missing_material(PAIR, RELIEF),
        line_of_action_m=PAIR.line_of_action_m,
        slices=found,
        **numbers,
    )


def healthy(**other) -> PairLaw:
    numbers = {"damping_ratio": 0.07, "equivalent_mesh_mass_kg": 0.2124, "backlash_m": 80e-6} | other
    over = mesh_tables(PAIR, (), STIFFNESS)
    return pair_law(
        over,
        missing_material(PAIR, RELIEF),
        line_of_action_m=PAIR.line_of_action_m,
        **numbers,
    )


def loaded(law: PairLaw, approach: float, pitches: float, rate: float = 0.0) -> np.ndarray:
    pairs = pair_table(law)
    pair_forces(law, approach, rate, pitches, 0.1, -3.0, pairs)
    return pairs


def through_face(length_m: float, centre_m: float = PITCH_POINT):
    return chord_pit(PAIR, length_m, centre_m)


PLAIN = healthy(friction=constant_friction(0.05))
NOTHING = damaged(pit(height_mm=1.6, depth_mm=0.0), pit(height_mm=1.6, a_mm=0.0), friction=constant_friction(0.05))


@settings(deadline=None)
@given(st.floats(-9e-5, 2e-5), st.floats(-0.05, 0.05), st.floats(0.0, 900.0))
def test_damage_without_depth_or_width_is_none_to_the_bit(approach: float, rate: float, pitches: float) -> None:
    np.testing.assert_array_equal(loaded(NOTHING, approach, pitches, rate), loaded(PLAIN, approach, pitches, rate))


WIDE = (through_face(1.5e-3),)
WIDE_SLICES = slices_of(WIDE)
WIDE_LAW = damaged(*WIDE, slices=WIDE_SLICES)


@settings(deadline=None)
@given(st.floats(0.0, 1e-4), st.floats(0.0, 1.7), st.floats(-0.05, 0.05))
def test_every_pair_has_the_force_of_its_slices(approach: float, pitches: float, rate: float) -> None:
    for n, row in enumerate(loaded(WIDE_LAW, approach, pitches)):
        place = (row[5] - PAIR.contact_start_m) / PAIR.base_pitch_m
        if 0.0 < place < PAIR.contact_ratio:
            # Tooth 0 has entered at pitch 0; slots count engagements.
            kind = 1 if round(pitches - place) == 0 else 0
            missing = missing_material(PAIR, RELIEF)
            grid = np.linspace(missing.start_m, missing.end_m, missing.pinion.profile_m.shape[1])
            gap = np.interp(row[5], grid, missing.pinion.profile_m[0] + missing.gear.profile_m[0])
            expected = slice_pair_force(WIDE_SLICES, kind, row[5], approach - gap)
            assert row[NORMAL] == pytest.approx(expected, rel=1e-9, abs=1e-6), n
    assert (loaded(WIDE_LAW, approach, pitches, rate)[:, NORMAL] >= 0.0).all()


def test_away_from_the_damaged_tooth_nothing_changes_to_the_bit() -> None:
    plain = healthy()
    for pitches in np.linspace(3.0, 17.0, 57):
        np.testing.assert_array_equal(
            loaded(WIDE_LAW, 5e-6, pitches)[:, : FLANK + 1], loaded(plain, 5e-6, pitches)[:, : FLANK + 1]
        )


@pytest.mark.parametrize(
    ("length_mm", "sink_um"), [(0.5, 4.7), (0.8, 12.0), (1.0, 18.7), (1.5, 42.0), (2.0, 75.0), (3.0, 168.0)]
)
def test_the_flank_sinks_by_the_sagitta_of_the_pit(length_mm: float, sink_um: float) -> None:
    radius = relative_radius(PITCH_POINT, PAIR.line_of_action_m)
    assert 1e6 * (1e-3 * length_mm) ** 2 / (8.0 * radius) == pytest.approx(sink_um, rel=0.01)
    found = 1e6 * largest_sink_m(slices_of((through_face(1e-3 * length_mm),)))
    # A cell of 7 µm in s is 2.6 µm of arc: of the 250 µm to the edge 1 %, hence 2 % of the least sink.
    assert found == pytest.approx(sink_um, rel=0.02)


def test_lands_leave_no_sink() -> None:
    narrow = slices_of((chord_pit(PAIR, 1.5e-3, PITCH_POINT, semi_face_m=5e-3),))
    assert largest_sink_m(narrow) == 0.0


def test_the_static_mesh_carries_the_load_over_a_sink_with_one_or_two_pairs() -> None:
    for pitches in np.linspace(0.0, 1.8, 91):
        approach = static_approach_m(WIDE_LAW, FORCE, pitches)
        assert static_force(WIDE_LAW, approach, pitches, pair_table(WIDE_LAW)) == pytest.approx(FORCE, rel=1e-9)
    # At the pitch point the damaged pair is alone: the approach grows by the whole sink.
    alone = (PITCH_POINT - PAIR.contact_start_m) / PAIR.base_pitch_m
    deeper = static_approach_m(WIDE_LAW, FORCE, alone) - static_approach_m(healthy(), FORCE, alone)
    # The least sinks of 42 µm; they stand for the kink within a cell, see above.
    assert 1e6 * deeper == pytest.approx(42.0, rel=0.02)


def test_the_back_flank_knows_no_pits() -> None:
    for pitches in np.linspace(0.0, 1.6, 17):
        np.testing.assert_array_equal(
            loaded(WIDE_LAW, -85e-6, pitches)[:, NORMAL], loaded(healthy(), -85e-6, pitches)[:, NORMAL]
        )
        # A floor deeper than the backlash switches on no back flank in normal drive.
        assert (loaded(WIDE_LAW, 5e-6, pitches)[:, FLANK] >= 0.0).all()


def test_what_carries_is_the_land_or_the_edges() -> None:
    half = damaged(chord_pit(PAIR, 1.5e-3, PITCH_POINT, semi_face_m=5e-3))
    alone = (PITCH_POINT - PAIR.contact_start_m) / PAIR.base_pitch_m
    # 200 slices: a pit's end lies within one of them.
    assert loaded(half, 5e-6, alone)[0, CARRYING] == pytest.approx(0.5, abs=0.01)
    assert loaded(healthy(), 5e-6, alone)[0, CARRYING] == 1.0
    assert loaded(WIDE_LAW, 60e-6, alone)[0, CARRYING] == pytest.approx(1.0, abs=0.01)
    assert loaded(WIDE_LAW, 5e-6, alone)[0, CARRYING] == 0.0


def run_of(law: PairLaw, settle_s: float = 0.3) -> dict[str, np.ndarray]:
    step = 1.0 / (51200 * 4)
    run = motion(make_structure(), law, step_s=step)
    pitches, states = settled(run, 30.0, step, 2 * 6827, settle_s)  # two revolutions
    return columns(run, states, pitches)


@pytest.mark.parametrize(("length_mm", "low", "high"), [(0.8, 380.0, 2055.0), (1.5, 0.0, 2860.0)])
def test_the_mesh_force_over_a_spall_through_the_face(length_mm: float, low: float, high: float) -> None:
    force = run_of(damaged(through_face(1e-3 * length_mm)))["mesh_force_n"]
    # Orders of magnitude of an independent computation with a rigid edge at the kink and another root: found are 370 to
    # 2088 N and 0 to 2893 N.
    assert force.min() == pytest.approx(low, abs=0.05 * FORCE)
    assert force.max() == pytest.approx(high, rel=0.05)
    # Periodic after two revolutions but for the slow torsional mode, whose mean force is the torque's.
    assert force.mean() == pytest.approx(FORCE, rel=0.02)


def test_the_casing_over_a_spall_through_the_face_shakes_as_computed_independently() -> None:
    runs = []
    for steps in (2, 4):
        law = damaged(through_face(1.5e-3))
        run = motion(make_structure(), law, step_s=1.0 / (51200 * steps))
        response = response_of(run, Drive(30.0, 0.3), fs_hz=51200.0, samples=20480, steps_per_sample=steps)
        runs.append(response.acceleration_m_s2["casing_lid/vertical"].std())
    # 11.1 m/s² of a prototype whose layout and sensor were not recorded in full; found are 10.3.
    assert runs[1] == pytest.approx(11.1, rel=0.15)
    assert runs[0] == pytest.approx(runs[1], rel=1e-3)


def test_a_film_between_a_sunk_flank_and_its_edges_is_as_thick_as_their_distance() -> None:
    film = SqueezeFilm(0.112, 0.02, 0.8e-6)
    wet = damaged(*WIDE, slices=WIDE_SLICES, film=film)
    alone = (PITCH_POINT - PAIR.contact_start_m) / PAIR.base_pitch_m
    radius = relative_radius(PITCH_POINT, PAIR.line_of_action_m)
    force = loaded(wet, 5e-6, alone, 1e-3)[0, NORMAL]
    gap = float(WIDE_SLICES.sink_m[1, :, 0].max()) - 5e-6
    # The position lies within a cell of the deepest one: 1 % of the sink, 1.5 % of the force.
    assert force == pytest.approx(12.0 * np.pi * 0.112 * 0.02 * (0.5 * radius / gap) ** 1.5 * 1e-3, rel=0.03)
