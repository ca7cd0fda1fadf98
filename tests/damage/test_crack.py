"""A crack in the root: what it adds to the tooth, by scale, depth, place and face, and where it acts."""

from __future__ import annotations

from dataclasses import replace
from math import inf, radians

import numpy as np
import pytest

from siggen.damage import crack_law
from siggen.damage.crack import RootCrack
from siggen.damage.crack_law import unit_compliance
from siggen.damage.flank_damage import damage_problems
from siggen.gears.spur_gear import TANGENT_RAD, root_chord
from siggen.mesh.contact_table import FORCE, contact_table
from siggen.mesh.mesh_tables import mesh_tables
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions
from siggen.mesh.tooth_compliance import tooth_compliance
from tests.gears.builders import pair_18_47, spur_gear

PAIR, OPTIONS = pair_18_47(), StiffnessOptions()
ROLL = np.linspace(PAIR.pinion.involute_start_roll_rad, PAIR.pinion.tip_roll_rad, 9)
SOUND = tooth_compliance(PAIR, "pinion", ROLL, OPTIONS).total


def crack(share=0.25, angle_deg=45.0, gear="pinion", tooth=0, run_m=inf, pair=PAIR):
    return RootCrack(gear, tooth, share * root_chord(pair.member(gear)).length_m, radians(angle_deg), run_m)


def added(one, pair=PAIR, sound=SOUND):
    return one.tooth_compliance_m_per_n(pair, ROLL, sound)


@pytest.mark.parametrize("teeth", [17, 18, 47, 120])
def test_the_chord_ends_where_the_fillet_s_tangent_makes_30_degrees(teeth):
    gear = spur_gear(teeth, 1e-3)
    gamma = np.linspace(gear.involute_start_gamma_rad, np.pi / 2, 4001)
    height, half = np.array([gear.trochoid_point_m(one) for one in gamma]).T
    tangent = np.arctan(np.gradient(half) / -np.gradient(height))
    index = np.argmin(np.abs(tangent - TANGENT_RAD))
    # A step of the grid along the fillet is 1e-4 modules.
    assert root_chord(gear).height_m == pytest.approx(height[index], abs=1e-3 * gear.module_m)
    assert root_chord(gear).length_m == pytest.approx(2.0 * half[index], abs=1e-3 * gear.module_m)


STEEP = replace(spur_gear(200), pressure_angle_rad=radians(28.0), clearance_coefficient=0.2)
"""Its lowest loads pass the chord so close that the opening changes its sign with the depth."""


@pytest.mark.parametrize("gear", [spur_gear(17, profile_shift=0.5), spur_gear(18), spur_gear(80), STEEP])
@pytest.mark.parametrize("angle_deg", [35.0, 50.0, 60.0, 70.0])
def test_a_deeper_one_adds_more_wherever_the_load_is(gear, angle_deg):
    roll = np.linspace(gear.involute_start_roll_rad, gear.tip_roll_rad, 33)
    # Beyond the deepest that is allowed, 0.45, too.
    shares = np.linspace(0.005, 0.6, 120)
    found = np.array([unit_compliance(gear, roll, share, radians(angle_deg)) for share in shares])
    assert np.all(np.diff(found, axis=0) > 0.0)
    assert np.all(found[0] > 0.0)
    assert np.all(np.isfinite(found))


@pytest.mark.parametrize("gear", [spur_gear(18), spur_gear(80), STEEP])
def test_six_depths_are_enough_for_what_growing_releases(gear, monkeypatch):
    roll = np.linspace(gear.involute_start_roll_rad, gear.tip_roll_rad, 9)
    own = [unit_compliance(gear, roll, share, 1.0) for share in (0.1, 0.45)]
    monkeypatch.setattr(crack_law, "RULE", np.polynomial.legendre.leggauss(40))
    fine = [unit_compliance(gear, roll, share, 1.0) for share in (0.1, 0.45)]
    # A hundredth of what the mesh of the fit errs by.
    assert np.array(own) == pytest.approx(np.array(fine), rel=1e-4)


def test_a_short_one_adds_in_proportion_to_its_square_and_none_of_it_nothing():
    short, shorter = added(crack(2e-6)), added(crack(1e-6))
    assert short == pytest.approx(4.0 * shorter, rel=1e-4)
    assert np.max(short / SOUND) < 1e-9


def test_depth_that_falls_across_the_face_adds_what_fine_slices_in_parallel_add():
    b = PAIR.face_width_m
    for run in (0.6 * b, b, 1.7 * b):
        # Slices of equal steps of depth, so narrow ones where it falls steeply to 0; sound face behind it.
        first = np.sqrt(max(1.0 - b / run, 0.0))
        edges = np.linspace(first, 1.0, 2001)
        stiffness = (1.0 - min(run / b, 1.0)) / SOUND
        for share, width in zip(0.5 * (edges[1:] + edges[:-1]), np.diff(edges**2) * run / b, strict=True):
            more = unit_compliance(PAIR.pinion, ROLL, 0.3 * share, radians(45.0)) / (PAIR.youngs_modulus_pa * b)
            stiffness += width / (SOUND + more)
        # Two thousand middles leave 1e-7.
        assert added(crack(0.3, run_m=run)) == pytest.approx(1.0 / stiffness - SOUND, rel=1e-6)


def test_a_crack_in_the_gear_acts_at_every_turn_of_the_gear_and_nowhere_else():
    tables = mesh_tables(PAIR, (crack(gear="gear", tooth=5),), OPTIONS, points=33)
    assert np.all(tables.table_of_pair[:, 5] == 1)
    assert not np.any(np.delete(tables.table_of_pair, 5, axis=1))
    healthy, cracked = tables.pair_stiffness_n_per_m
    assert np.all(cracked < healthy)


@pytest.mark.parametrize("section_loss", [False, True])
def test_solved_across_the_face_it_enters_once_whatever_damage_does_to_sections(section_loss):
    """At equal approach less what the crack gives way by, the forces are equal: F(x) = F_healthy(x - F Δc)."""
    table = contact_table(PAIR, (crack(),), OPTIONS, TableOptions(section_loss=section_loss), 65)
    position = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 65)
    node = table.unit_m * np.arange(table.upright.shape[1]) ** 2
    for point in (8, 32, 56):
        healthy, cracked = (table.upright[int(table.column[row, point])][:, FORCE] for row in (0, 1))
        roll = np.array([position[point] / PAIR.pinion.base_radius_m])
        given = cracked * crack().tooth_compliance_m_per_n(PAIR, roll, SOUND[:1])
        assert np.interp(node[5:] - given[5:], node, healthy) == pytest.approx(cracked[5:], rel=1e-2)


@pytest.mark.parametrize(
    ("one", "blamed"),
    [
        (crack(0.46), "depth_m"), (crack(-0.1), "depth_m"), (crack(angle_deg=30.0), "angle_rad"),
        (crack(run_m=0.0), "run_m"), (crack(tooth=18), "tooth"), (crack(float("nan")), "depth_m"),
    ],
)  # fmt: skip
def test_one_that_cannot_be_is_refused_by_what_is_wrong(one, blamed):
    assert [problem.name for problem in damage_problems(PAIR, (one,))] == [blamed]


def test_the_deepest_one_is_possible_and_hides_the_milder_ones_of_its_tooth():
    assert not damage_problems(PAIR, (crack(0.45),))
    assert crack(0.3).hides(crack(0.2))
    assert not crack(0.3, run_m=0.01).hides(crack(0.2))
    assert not crack(0.3).hides(crack(0.2, tooth=1))


PLACES = np.array([0.045, 0.26, 0.998])


@pytest.mark.parametrize(
    ("teeth", "pressure_deg", "share", "angle_deg", "elements"),
    [
        (21, 14.5, 0.13, 52, (0.8896, 0.8823, 2.1359)), (60, 14.5, 0.4, 65, (1.5797, 2.2688, 13.232)),
        (33, 17.5, 0.25, 40, (1.0019, 1.1204, 3.9759)), (33, 22.5, 0.25, 52, (0.4321, 0.6516, 3.6083)),
        (21, 25.0, 0.4, 65, (1.2231, 1.4934, 8.0003)), (60, 25.0, 0.13, 52, (0.0401, 0.1194, 1.1656)),
        (60, 25.0, 0.4, 40, (0.4526, 0.774, 4.8978)),
    ],
)  # fmt: skip
def test_it_is_within_10_percent_of_finite_elements_at_any_pressure_angle(
    teeth, pressure_deg, share, angle_deg, elements
):
    """No gear of the fit. Elements: `cracked_tooth.crack_compliance`, edges of 0.08, from 25 degrees on of 0.12."""
    gear = spur_gear(teeth)
    gear = replace(gear, pressure_angle_rad=radians(pressure_deg), bore_radius_m=gear.root_radius_m / 2.5)
    roll = gear.involute_start_roll_rad + PLACES * (gear.tip_roll_rad - gear.involute_start_roll_rad)
    assert unit_compliance(gear, roll, share, radians(angle_deg)) == pytest.approx(elements, rel=0.1)
