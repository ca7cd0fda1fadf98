"""Pitted flanks in the pair law: lands, sinks through the face, and what they do to a running gearbox."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.drivetrain.drive import Drive
from siggen.mesh.lubrication import relative_radius
from siggen.mesh.node_forces import pair_forces, static_approach_m, static_force
from siggen.mesh.pair_columns import CARRYING, NORMAL
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.pair_springs import pair_table
from siggen.motion.response import SampleGrid, response_of
from tests.dynamics.casing_stage import make_structure
from tests.dynamics.pair_runs import columns, contact_law, contact_of, gear_pair, motion, settled
from tests.gears.pit_shapes import chord_pit

PAIR = gear_pair()
PITCH_POINT = PAIR.pitch_point_m
ALONE = (PITCH_POINT - PAIR.contact_start_m) / PAIR.base_pitch_m
FORCE = 30.0 / PAIR.pinion.base_radius_m


def loaded(law: PairLaw, approach: float, pitches: float, rate: float = 0.0) -> np.ndarray:
    pairs = pair_table(law)
    pair_forces(law, approach, rate, pitches, 0.1, -3.0, pairs)
    return pairs


def through_face(length_m: float, centre_m: float = PITCH_POINT):
    return chord_pit(PAIR, length_m, centre_m)


HEALTHY = contact_law()


WIDE = (through_face(1.5e-3),)
WIDE_LAW = contact_law(WIDE)


@pytest.mark.parametrize(
    ("length_mm", "sink_um"), [(0.5, 4.68), (0.8, 12.0), (1.0, 18.7), (1.5, 42.0), (2.0, 75.0), (3.0, 168.0)]
)
def test_the_flank_sinks_by_the_sagitta_of_the_pit(length_mm: float, sink_um: float) -> None:
    radius = relative_radius(PITCH_POINT, PAIR.line_of_action_m)
    assert 1e6 * (1e-3 * length_mm) ** 2 / (8.0 * radius) == pytest.approx(sink_um, rel=0.01)
    found = 1e6 * float(contact_of((through_face(1e-3 * length_mm),)).touch_m.max())
    # A point of the table is up to 7 µm in s from the middle, 2.6 µm of arc: of the 250 µm to the edge 1 %.
    assert found == pytest.approx(sink_um, rel=0.02)


def test_the_static_mesh_carries_the_load_over_a_sink_with_one_or_two_pairs() -> None:
    for pitches in np.linspace(0.0, 1.8, 91):
        approach = static_approach_m(WIDE_LAW, FORCE, pitches)
        assert static_force(WIDE_LAW, approach, pitches, pair_table(WIDE_LAW)) == pytest.approx(FORCE, rel=1e-9)
    # At the pitch point the damaged pair is alone: without load the approach grows by the whole sink of 42 µm,
    # under load by little more, since edges give way.
    for share, deeper_um in ((1e-3, 42.0), (1.0, 43.4)):
        deeper = static_approach_m(WIDE_LAW, share * FORCE, ALONE) - static_approach_m(HEALTHY, share * FORCE, ALONE)
        assert 1e6 * deeper == pytest.approx(deeper_um, rel=0.01)


def test_what_carries_is_the_land_or_the_edges() -> None:
    half = contact_law((chord_pit(PAIR, 1.5e-3, PITCH_POINT, semi_face_m=5e-3),))
    # A pit's end lies within one of 65 slices.
    assert loaded(half, 5e-6, ALONE)[0, CARRYING] == pytest.approx(0.5, abs=0.016)
    # The whole face; its ends bear more, so that loads of slices differ by 6 % rms: 1/(1 + 0.06²).
    assert loaded(HEALTHY, 5e-6, ALONE)[0, CARRYING] == pytest.approx(1.0, abs=0.005)
    assert loaded(WIDE_LAW, 60e-6, ALONE)[0, CARRYING] == pytest.approx(1.0, abs=0.003)
    assert loaded(WIDE_LAW, 5e-6, ALONE)[0, NORMAL] == 0.0


def run_of(law: PairLaw, settle_s: float = 0.3) -> dict[str, np.ndarray]:
    step = 1.0 / (51200 * 4)
    run = motion(make_structure(), law, step_s=step)
    pitches, states = settled(run, 30.0, step, 2 * 6827, settle_s)  # two revolutions
    return columns(run, states, pitches)


@pytest.mark.parametrize(("length_mm", "low", "high"), [(0.8, 380.0, 2055.0), (1.5, 0.0, 2860.0)])
def test_the_mesh_force_over_a_spall_through_the_face(length_mm: float, low: float, high: float) -> None:
    force = run_of(contact_law((through_face(1e-3 * length_mm),)))["mesh_force_n"]
    # Ends of an independent computation with rigid edges; those that give way swing less, found are 620 to 1767 N and
    # 58 to 2376 N.
    assert low < force.min()
    assert force.max() < high
    assert np.ptp(force) == pytest.approx(0.75 * (high - low), rel=0.1)
    # Periodic after two revolutions but for the slow torsional mode, whose mean force is the torque's.
    assert force.mean() == pytest.approx(FORCE, rel=1e-3)


def test_the_casing_over_a_spall_through_the_face_shakes_as_computed_independently() -> None:
    runs = []
    for steps in (2, 4):
        run = motion(make_structure(), WIDE_LAW, step_s=1.0 / (51200 * steps))
        response = response_of(run, Drive(30.0, 0.3), SampleGrid(51200.0, 20480, steps))
        runs.append(response.acceleration_m_s2["casing_lid/vertical"].std())
    # 11.1 m/s² of a prototype whose layout and sensor were not recorded in full; found are 10.7.
    assert runs[1] == pytest.approx(11.1, rel=0.05)
    assert runs[0] == pytest.approx(runs[1], rel=1e-3)
