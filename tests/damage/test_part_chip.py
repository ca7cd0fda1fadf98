"""A tip that is lost over a part of the face: limits, and forces and moments against a slow sum over slices."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import root

from siggen.arrays import FloatArray
from siggen.damage.chip import PartChip, lost_outline, standing_share
from siggen.damage.part import ToothDamage
from siggen.damage.pits import FlankPit
from siggen.damage.sham import Sham
from siggen.mesh.body_coupling import ring_torsion
from siggen.mesh.contact_table import kind_row, row_faces, table_solver
from siggen.mesh.face_force import FaceForce, face_force, solver_room
from siggen.mesh.face_slices import bending_length_m, contact_kappa, strip_factor
from siggen.mesh.hertz import centre_line_depth
from siggen.mesh.mesh_stiffness import rolls_at
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions, face_slices
from siggen.mesh.tooth_compliance import tooth_compliance
from tests.gears.builders import pair_18_47

PAIR = pair_18_47()
GEAR, WIDTH = PAIR.pinion, PAIR.face_width_m
TOOTH_M = GEAR.tip_radius_m - GEAR.root_radius_m
APART = TableOptions(coupled=False)
POINTS = 65
AT = 50
"""Number of a place of 65 on the path at which the pinion's chips below are far above the line, as contacts go."""


def chip(height_m: float, width_m: float) -> PartChip:
    return PartChip("pinion", 0, height_m, width_m, lost_outline(GEAR, height_m, width_m))


def pressed(approach_m: float, *damage: ToothDamage, at: int = AT, options: TableOptions = APART) -> FaceForce:
    stiffness = StiffnessOptions()
    lead = np.zeros(face_slices(PAIR, options))
    healthy = kind_row(PAIR, stiffness, options, POINTS)
    row = kind_row(PAIR, stiffness, options, POINTS, (damage, ()), healthy)
    (slices,) = row_faces(table_solver(PAIR, stiffness, options, lead), row, np.array([at]))
    return face_force(slices, approach_m, 0.0, np.zeros(lead.size), solver_room(lead.size))


def summed(approach_m: float, standing: FloatArray, softer: float) -> tuple[float, float]:
    """Return force and moment of independent slices of which those `standing` (n,) carry, by a dense solution.

    The tooth is t - l² t'' = C b q in differences; of a slice Hertz's approach under its own load (Weber, Banaschek).
    """
    position = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, POINTS)[AT : AT + 1]
    rolls = dict(zip(("pinion", "gear"), rolls_at(PAIR, position), strict=True))
    depth = float(np.sqrt(np.prod([centre_line_depth(PAIR, which, roll) for which, roll in rolls.items()])))
    twist, bends = 0.0, 0.0
    for which, roll in rolls.items():
        own = ring_torsion(PAIR.member(which), PAIR.poisson_ratio) / (PAIR.youngs_modulus_pa * WIDTH)
        total = float(tooth_compliance(PAIR, which, roll, StiffnessOptions()).total[0])
        twist, bends = twist + own, bends + (softer if which == "pinion" else 1.0) * (total - own)
    n = standing.size
    cell, length = WIDTH / n, bending_length_m(PAIR)
    bending = np.diag(np.full(n, 2.0)) - np.diag(np.ones(n - 1), 1) - np.diag(np.ones(n - 1), -1)
    bending[0, 0] = bending[-1, -1] = 1.0
    tooth = np.linalg.solve(np.eye(n) + (length / cell) ** 2 * bending, bends * WIDTH * np.eye(n))
    radius = float(position[0] * (PAIR.line_of_action_m - position[0]) / PAIR.line_of_action_m)
    kappa, own_tooth = contact_kappa(PAIR), tooth[np.ix_(standing, standing)]

    def rest(logarithm: FloatArray) -> FloatArray:
        load = np.exp(logarithm)
        half = np.sqrt(2.0 * radius * kappa * load)
        contact = kappa * load * (np.log(2.0 * depth / half) - 0.5 * PAIR.poisson_ratio / (1.0 - PAIR.poisson_ratio))
        return np.asarray(1e6 * (twist * cell * load.sum() + own_tooth @ load + contact - approach_m))

    guess = np.full(int(standing.sum()), np.log(approach_m / (2.0 * bends * WIDTH)))
    found = root(rest, guess, tol=1e-10)
    assert found.success
    load, face = np.exp(found.x), (cell * (np.arange(n) + 0.5) - 0.5 * WIDTH)[standing]
    return float(cell * load.sum()), float(cell * (load * face).sum())


@pytest.mark.parametrize("height", [0.4, 1.0])
def test_force_and_moment_of_a_tooth_with_less_tip_are_those_of_the_slices_that_stand(height: float) -> None:
    """Parts end between slices: 0.3 %."""
    n = face_slices(PAIR, APART)
    width_m = round(0.5 * n) / n * WIDTH
    lost = chip(height * TOOTH_M, width_m)
    standing = (np.arange(n) + 0.5) / n * WIDTH > width_m
    softer = strip_factor(PAIR, 1.0 - width_m / WIDTH) if height == 1.0 else 1.0
    found, expected = pressed(15e-6, lost), summed(15e-6, standing, softer)
    assert found.force_n == pytest.approx(expected[0], rel=3e-3)
    assert found.moment_n_m == pytest.approx(expected[1], rel=3e-3)
    assert found.force_n < 0.95 * pressed(15e-6).force_n


def test_the_sum_knows_a_sound_tooth() -> None:
    expected = summed(15e-6, np.ones(face_slices(PAIR, APART), dtype=bool), 1.0)[0]
    assert pressed(15e-6).force_n == pytest.approx(expected, rel=1e-3)


def test_what_takes_nothing_of_the_face_is_a_sham() -> None:
    """A thousandth of a slice is felt by as much of the force; one below 1e-6 is no slice's."""
    lost = chip(0.5 * TOOTH_M, 1e-9 * WIDTH)
    assert pressed(15e-6, lost) == pressed(15e-6, Sham(lost))
    assert pressed(15e-6, Sham(lost)).force_n == pytest.approx(pressed(15e-6).force_n, rel=1e-9)


def test_the_more_of_the_face_is_lost_the_less_carries_and_below_the_line_all_of_it_does() -> None:
    forces = [pressed(15e-6, chip(0.4 * TOOTH_M, share * WIDTH)).force_n for share in (0.1, 0.3, 0.6, 0.9, 1.0)]
    assert np.all(np.diff([pressed(15e-6).force_n, *forces]) < 0.0)
    assert forces[-1] == 0.0
    below = pressed(15e-6, chip(0.2 * TOOTH_M, 0.6 * WIDTH), at=8)
    assert below.force_n == pytest.approx(pressed(15e-6, at=8).force_n, rel=1e-9)


def test_a_strip_is_a_tooth_of_its_width() -> None:
    """What stands of a broken tooth, against t - l² t'' = C b q on the strip and on the whole face in differences."""
    for share in (0.2, 0.5, 0.9):
        n = 2000
        cell, length = WIDTH / n, bending_length_m(PAIR)
        bending = np.diag(np.full(n, 2.0)) - np.diag(np.ones(n - 1), 1) - np.diag(np.ones(n - 1), -1)
        bending[0, 0] = bending[-1, -1] = 1.0
        loaded = np.arange(n) >= round((1.0 - share) * n)
        sunk = np.linalg.solve(np.eye(n) + (length / cell) ** 2 * bending, loaded / share)
        assert strip_factor(PAIR, share) * sunk[loaded].mean() == pytest.approx(1.0 / share, rel=1e-3)
    assert strip_factor(PAIR, 1.0 - 1e-9) == pytest.approx(1.0)


def test_what_lies_on_lost_metal_is_hidden_and_nothing_else() -> None:
    lost = chip(0.5 * TOOTH_M, 0.5 * WIDTH)
    tip = float(GEAR.height_m(GEAR.tip_roll_rad))
    pit = FlankPit("pinion", 0, tip - 0.5e-3, 0.2 * WIDTH, 0.3e-3, 0.2e-3, 0.4e-3, "flat")
    assert lost.hides(pit)
    assert not lost.hides(replace(pit, face_m=0.8 * WIDTH))
    assert not lost.hides(replace(pit, height_m=0.2 * tip))
    assert pressed(15e-6, lost, pit) == pressed(15e-6, lost)
    assert standing_share(PAIR, "pinion", (lost, pit)) == 1.0
    assert standing_share(PAIR, "pinion", (chip(TOOTH_M, 0.3 * WIDTH),)) == pytest.approx(0.7)


def test_what_cannot_be_is_told() -> None:
    assert [one.name for one in replace(chip(1e-3, 1e-3), width_m=0.0).own_problems()] == ["width_m"]
    assert [one.name for one in chip(1.1 * TOOTH_M, 1.1 * WIDTH).place_problems(PAIR)] == ["height_m", "width_m"]
