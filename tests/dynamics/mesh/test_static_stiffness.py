"""Force over approach at rest: its limits, and the time loop that comes to rest at a held angle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.mesh.lubrication import relative_radius
from siggen.mesh.mesh_stiffness import mesh_stiffness
from siggen.mesh.mesh_tables import mesh_tables
from siggen.mesh.static_mesh import (
    largest_secant_loss,
    pairs_before_damage,
    secant_stiffness_n_per_m,
    static_approaches_m,
)
from siggen.motion.equations import no_inputs
from tests.dynamics.casing_stage import make_structure
from tests.dynamics.pair_runs import TEETH, columns, contact_law, exact_involutes, gear_pair, law, motion, tables
from tests.gears.pit_shapes import chord_pit

PAIR = gear_pair()
PITCH_POINT = PAIR.pitch_point_m
ALONE = (PITCH_POINT - PAIR.contact_start_m) / PAIR.base_pitch_m
"""Angle at which the damaged tooth is alone in contact, at the pitch point."""
TORQUE = 30.0
FORCE = TORQUE / PAIR.pinion.base_radius_m
SPALL_M = 0.8e-3


SPALL = (chord_pit(PAIR, SPALL_M, PITCH_POINT),)
THROUGH, HEALTHY = contact_law(SPALL), contact_law()


def test_healthy_teeth_without_relief_have_the_mesh_stiffness_of_the_tables() -> None:
    chosen = law(exact_involutes(tables()))
    pitches = np.linspace(3.01, 4.99, 199)
    found = secant_stiffness_n_per_m(chosen, FORCE, pitches)
    direct = mesh_stiffness(PAIR, 2.0 * np.pi * pitches / PAIR.pinion.teeth, TEETH)
    # Linear interpolation between 2049 points.
    np.testing.assert_allclose(found, direct, rtol=1e-5)


def test_lands_beside_a_spall_lose_what_the_contact_softens() -> None:
    half = contact_law((chord_pit(PAIR, SPALL_M, PITCH_POINT, semi_face_m=5e-3),))
    # The contact is about a fifth of the compliance; half its length doubles that, and the tooth gives way unevenly:
    # far from the 1 of a lost contact.
    assert 0.15 < largest_secant_loss(half, HEALTHY, FORCE) < 0.25


@pytest.mark.parametrize("share", [1e-4, 1e-3])
def test_without_load_the_approach_is_the_sink(share: float) -> None:
    radius = relative_radius(PITCH_POINT, PAIR.line_of_action_m)
    approach = static_approaches_m(THROUGH, share * FORCE, np.array([ALONE]))[0]
    assert approach == pytest.approx(SPALL_M**2 / (8.0 * radius), rel=0.02)


def test_the_loss_falls_with_the_load_since_the_sink_stays() -> None:
    losses = [largest_secant_loss(THROUGH, HEALTHY, share * FORCE) for share in (0.01, 0.1, 1.0, 10.0)]
    assert np.all(np.diff(losses) < 0.0)
    assert losses[0] > 0.99
    whole = static_approaches_m(HEALTHY, FORCE, np.array([ALONE]))[0]
    sink = SPALL_M**2 / (8.0 * relative_radius(PITCH_POINT, PAIR.line_of_action_m))
    # Alone in contact the approach grows by the sink and by little more: edges carry and give way.
    assert 0.0 < losses[2] - sink / (whole + sink) < 0.025


def test_the_largest_loss_is_that_of_a_fine_scan_over_the_damaged_tooth() -> None:
    pitches = np.linspace(-1.0, 3.0, 40_001)
    loss = 1.0 - static_approaches_m(HEALTHY, FORCE, pitches) / static_approaches_m(THROUGH, FORCE, pitches)
    found = largest_secant_loss(THROUGH, HEALTHY, FORCE)
    # A step of the scan is 0.9 µm of the path, over which the sink of 12 µm changes by 0.036 µm: 3e-3.
    assert float(loss.max()) - 1e-9 <= found < float(loss.max()) + 1e-3


def test_damage_on_both_gears_is_scanned_where_the_damaged_teeth_meet() -> None:
    both = (*SPALL, replace(chord_pit(PAIR, SPALL_M, PITCH_POINT, which="gear"), tooth=1))
    over = mesh_tables(PAIR, (), TEETH)
    rows = np.zeros((18, 47), dtype=np.int32)
    rows[0], rows[:, 1], rows[0, 1] = 1, 2, 3
    chosen = law(
        over=replace(over, pair_stiffness_n_per_m=np.repeat(over.pair_stiffness_n_per_m, 4, 0), table_of_pair=rows)
    )
    newest = pairs_before_damage(chosen)
    met = {int(rows[n % 18, n % 47]) for first in newest for n in range(first - chosen.slots, first + 2)}
    assert met == {0, 1, 2, 3}
    assert largest_secant_loss(contact_law(both), HEALTHY, FORCE) >= largest_secant_loss(THROUGH, HEALTHY, FORCE) - 1e-9


@pytest.mark.parametrize("pitches", [ALONE, ALONE + 0.06, 0.2, 7.0 + ALONE])
def test_the_time_loop_comes_to_rest_at_the_same_approach(pitches: float) -> None:
    """An independent way: the whole gearbox is let go 20 µm away and swings until its dampers have stopped it."""
    run = motion(make_structure(), contact_law(SPALL, damping_ratio=0.2), torque_nm=TORQUE)
    still = np.full(40_001, pitches)
    states = np.zeros((still.size, 2 * len(run.structure.coordinates)))
    states[0, 0] = 20e-6 / PAIR.pinion.base_radius_m
    for _ in range(6):
        run.advance(still, no_inputs(still), states)
        states[0] = states[-1]
    found = columns(run, states[-2:], still[-2:])
    expected = static_approaches_m(run.law, FORCE, np.array([pitches]))[0]
    # After 1.2 s a swing has decayed to less than 1e-11 of the approach.
    assert found["approach_m"][-1] == pytest.approx(expected, rel=1e-9)
    assert found["mesh_force_n"][-1] == pytest.approx(FORCE, rel=1e-9)


@pytest.mark.parametrize("force", [0.0, -1.0, np.nan, 1e9])
def test_forces_that_no_drive_flank_carries_are_refused(force: float) -> None:
    with pytest.raises(ValueError, match=r"force_n: received .* allowed are"):
        secant_stiffness_n_per_m(THROUGH, force, np.array([0.5]))
