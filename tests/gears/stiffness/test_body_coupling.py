"""Coupling of neighbouring teeth: the bodies' deflection, the coupled mesh stiffness and its split into rows."""

from __future__ import annotations

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.gears.gear_pair import GearPair, SpurGear
from siggen.mesh.body_coupling import (
    body_coupling,
    coupled_contributions,
    neighbour_compliance,
    neighbour_runs,
    ring_torsion,
)
from siggen.mesh.mesh_stiffness import mesh_stiffness, pair_stiffness, pairs_in_contact
from siggen.mesh.mesh_tables import kind_stiffness, largest_stiffness_loss, mesh_tables, pair_kinds
from siggen.mesh.stiffness_notes import stiffness_notes
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_compliance import tooth_compliance
from tests.gears.builders import bare, layers, pair_18_47, pit

PAIR = pair_18_47()
PLAIN = StiffnessOptions()
BODY = StiffnessOptions(coupling="body")
DAMAGE = (*(replace(p, tooth=t) for t in (3, 4) for p in layers(1, 6)), pit(5.0, 10.0, 2.0, gear="gear", tooth=5))


def tall_pair():
    """Teeth of 1.35 modules addendum: two or three pairs in contact."""
    tall = [SpurGear(z, 3e-3, radians(20.0), 0.0, 1.35, 0.2, b) for z, b in ((50, 25e-3), (80, 30e-3))]
    return GearPair(tall[0], tall[1], 20e-3, 206e9, 0.3)


def gears(teeth, ratio):
    root = 0.5 * teeth - 1.25
    return SpurGear(teeth, 1.0, radians(20.0), 0.0, 1.0, 0.25, root / ratio, body_ratio=1.0)


def test_ring_torsion_is_the_integrated_shear_of_a_ring():
    gear = PAIR.pinion
    r = np.linspace(gear.held_radius_m, gear.root_radius_m, 200_001)
    # Moment R_b on a unit width: stress R_b/(2 pi r^2), strain 2 (1 + nu) of it for E = 1, rotation strain/r, way R_b.
    rate = gear.base_radius_m**2 * 2.6 / (2 * pi * r**3)
    slow = np.sum(0.5 * (rate[1:] + rate[:-1]) * np.diff(r))
    assert ring_torsion(gear, 0.3) == pytest.approx(slow, rel=1e-8)


@settings(max_examples=60, deadline=None)
@given(teeth=st.integers(17, 100), ratio=st.floats(1.4, 7.0))
def test_a_neighbour_deflects_a_tooth_more_the_nearer_it_is_and_less_than_its_own_load(teeth, ratio):
    gear = gears(teeth, ratio)
    pair = GearPair(gear, gear, 1.0, 1.0, 0.3)
    first, last = pair.active_flank[0]
    lower = first + np.linspace(0.0, 1.0, 9) * (last - 2 * pi / teeth - first)
    near = neighbour_compliance(gear, lower, 1, 0.3)
    own = tooth_compliance(pair, "pinion", lower, PLAIN).total
    mate = tooth_compliance(pair, "pinion", np.minimum(lower + 2 * pi / teeth, gear.tip_roll_rad), PLAIN).total
    assert np.all(near > ring_torsion(gear, 0.3))
    assert np.all(near > neighbour_compliance(gear, lower, 2, 0.3))
    # Both forces stay positive at equal approach.
    assert np.all(near < np.minimum(own, mate))


def dense_stiffness(pair, angle, damage):
    """1' C^-1 1 built pair by pair and solved densely: independent of the vectorised sum."""
    out = []
    for theta in angle:
        _, count, position = pairs_in_contact(pair, np.array([theta]))
        order = np.argsort(position)
        matrix = np.zeros((order.size, order.size))
        for i, n in enumerate(order):
            on = tuple(p for p in damage if p.gear == "pinion" and p.tooth == count[n] % pair.pinion.teeth)
            mate = tuple(p for p in damage if p.gear == "gear" and p.tooth == count[n] % pair.gear.teeth)
            matrix[i, i] = 1 / pair_stiffness(pair, position[[n]], BODY, on, mate)[0]
            for j in range(i):
                c = body_coupling(pair, BODY, position[order[[j]]])[i - j - 1, 0]
                matrix[i, j] = matrix[j, i] = c
        out.append(np.ones(order.size) @ np.linalg.inv(matrix) @ np.ones(order.size))
    return np.array(out)


@pytest.mark.parametrize(("pair", "damage"), [(PAIR, DAMAGE), (tall_pair(), ())], ids=["18/47 damaged", "tall"])
def test_coupled_stiffness_is_that_of_a_dense_solve(pair, damage):
    angle = np.linspace(0.9, 2.6, 57)
    # Inverting a well-conditioned 2 x 2 or 3 x 3 matrix: rounding only.
    np.testing.assert_allclose(
        mesh_stiffness(pair, angle, BODY, damage), dense_stiffness(pair, angle, damage), rtol=1e-12
    )


def test_coupling_softens_where_pairs_share_the_load_and_nowhere_else():
    angle = np.linspace(0.0, 2 * pi, 3001)
    plain, coupled = (mesh_stiffness(PAIR, angle, o, DAMAGE) for o in (PLAIN, BODY))
    alone = np.bincount(pairs_in_contact(PAIR, angle)[0]) == 1
    assert np.array_equal(plain[alone], coupled[alone])
    assert np.all(coupled[~alone] < 0.8 * plain[~alone])
    assert np.all(mesh_stiffness(PAIR, angle, BODY, DAMAGE) <= mesh_stiffness(PAIR, angle, BODY) * (1 + 1e-14))


def test_the_loss_of_damage_through_the_face_is_known_with_coupling_where_two_pairs_share_the_load():
    # An ellipse far wider than the face, 2 mm high about the pitch point: it reaches into the zone of two pairs, where
    # the damaged pair is open beside another one.
    through = pit(1.9, 10.0, 500.0, 1.0, 0.1)
    assert largest_stiffness_loss(PAIR, (through,), BODY) == 1.0


@pytest.mark.parametrize(("pair", "damage"), [(PAIR, DAMAGE), (tall_pair(), ())], ids=["18/47 damaged", "tall"])
def test_contributions_add_up_to_the_mesh_stiffness_and_never_jump(pair, damage):
    tables = mesh_tables(pair, damage, BODY, points=65)
    kinds = pair_kinds(damage)
    runs, row_of_pair = neighbour_runs(pair, tables.table_of_pair)
    assert not runs[0].any()
    angle = np.linspace(0.0, 2.5, 301)
    index, count, position = pairs_in_contact(pair, angle)

    def alone(s):
        return kind_stiffness(pair, damage, BODY, kinds, s)

    rows = coupled_contributions(pair, BODY, runs, alone, position)
    row = row_of_pair[count % pair.pinion.teeth, count % pair.gear.teeth]
    total = np.bincount(index, rows[row, np.arange(row.size)])
    np.testing.assert_allclose(total, mesh_stiffness(pair, angle, BODY, damage), rtol=1e-12)
    assert rows.min() > 0.0
    # Over 1e-7 of the path a healthy contribution moves by some 1e-7 of itself; a jump would be 10 %.
    fine = np.linspace(pair.contact_start_m, pair.contact_end_m, 4001)
    step = 1e-7 * pair.base_pitch_m
    near = [coupled_contributions(pair, BODY, runs[:1], alone, s)[0] for s in (fine[:-1], fine[:-1] + step)]
    np.testing.assert_allclose(near[1], near[0], rtol=1e-5)


def test_largest_loss_is_that_of_the_coupled_curve():
    angle = np.linspace(0.0, 2 * pi * 47, 120_001)
    loss = 1 - mesh_stiffness(PAIR, angle, BODY, DAMAGE) / mesh_stiffness(PAIR, angle, BODY)
    found = largest_stiffness_loss(PAIR, DAMAGE, BODY)
    # The curve's grid of 2.5e-3 rad may miss the peak by a little, never exceed it.
    assert loss.max() <= found * (1 + 1e-9)
    assert loss.max() > 0.98 * found


def test_gears_outside_the_fit_are_named():
    thin = bare(pair_18_47(bores_m=(25.0e-3, 20e-3)))
    options = StiffnessOptions("rack_trochoid", coupling="body")
    notes = stiffness_notes(thin, options)
    assert any("coupling: h_f = root radius / held radius is 1.085; fitted range 1.4 to 7" in note for note in notes)
    assert not any("coupling" in note for note in stiffness_notes(PAIR, options))
