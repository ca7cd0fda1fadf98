"""A cracked tooth in the mesh that is simulated: a pulse of the static transmission error at every engagement."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from siggen.mesh.node_forces import static_approach_m
from siggen.mesh.static_mesh import secant_stiffness_n_per_m
from siggen.record.specimen_state import SpecimenState, specimen_state
from tests.damage.test_damage import config_with

TOOTH, FORCE_N = 3, 2400.0


@cache
def cracked(gear: str = "pinion", damage: str = "all") -> SpecimenState:
    crack = {"kind": "crack", "depth_share": 0.4, "gear": gear, "teeth": [TOOTH]}
    config = config_with(crack)
    specimen = config.gearbox(0)
    law = replace(specimen.law, section_loss=damage == "all")
    return specimen_state(replace(specimen, law=law), 1)


def approaches_m(state: SpecimenState, pitches: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the static transmission error (k,) with the crack and without [m]."""
    laws = state.static.law, state.static.healthy
    with_crack, without = (FORCE_N / secant_stiffness_n_per_m(law, FORCE_N, pitches) for law in laws)
    return with_crack, without


@pytest.mark.parametrize("damage", ["all", "geometry"])
def test_where_the_cracked_tooth_carries_alone_the_teeth_approach_by_the_force_times_its_compliance(damage):
    state = cracked(damage=damage)
    pair, (one,) = state.pair, state.damage
    ratio = pair.contact_ratio
    pitches = TOOTH + np.linspace(ratio - 1.0, 1.0, 9)[1:-1]
    with_crack, without = approaches_m(state, pitches)
    position = pair.contact_start_m + (pitches - TOOTH) * pair.base_pitch_m
    added = one.tooth_compliance_m_per_n(pair, position / pair.pinion.base_radius_m, np.ones(position.size))
    # The table of the contact interpolates its forces within 0.1 %, and half of the approach is not the crack's.
    assert with_crack - without == pytest.approx(FORCE_N * added, rel=5e-3)


@pytest.mark.parametrize(("gear", "teeth"), [("pinion", 18), ("gear", 47)])
def test_it_is_a_pulse_as_long_as_the_path_of_contact_once_per_turn_of_its_gear(gear, teeth):
    state = cracked(gear)
    pitches = np.linspace(0.0, 2 * teeth, 2 * teeth * 32, endpoint=False)
    with_crack, without = approaches_m(state, pitches)
    softer = with_crack - without > 1e-4 * without
    since = np.mod(pitches - TOOTH, teeth)
    inside = since < state.pair.contact_ratio
    assert not np.any(softer[~inside])
    # A pair that has just come carries next to nothing behind the relief of the tips.
    assert np.all(softer[(since > 0.15) & (since < state.pair.contact_ratio - 0.15)])
    # The search for an approach starts from the one before and ends within 1e-12 of the force.
    assert with_crack[~inside] == pytest.approx(without[~inside], rel=1e-11)


def test_the_back_flank_closes_the_crack():
    state = cracked()
    for pitches in TOOTH + np.array([0.1, 0.8, 1.4]):
        drive, back = (
            [static_approach_m(law, sign * FORCE_N, pitches) for law in (state.static.law, state.static.healthy)]
            for sign in (1.0, -1.0)
        )
        assert drive[0] > drive[1]
        assert back[0] == back[1]
