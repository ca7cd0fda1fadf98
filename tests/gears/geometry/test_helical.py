"""Helical teeth: sections, overlap and contact lines against closed forms."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np
import pytest

from siggen.gears.gear_pair import GearPair
from siggen.gears.helical import normal_gear
from siggen.gears.spur_gear import transverse_gear
from siggen.mesh.mesh_stiffness import mesh_stiffness, pair_stiffness
from siggen.mesh.mesh_tables import mesh_tables
from siggen.mesh.stiffness_options import StiffnessOptions
from tests.gears.builders import spur_gear


def helical_pair(helix_deg, face_width_m=20e-3):
    helix = radians(helix_deg)
    gears = [transverse_gear(spur_gear(z, 3e-3, bore), helix) for z, bore in ((18, 10e-3), (47, 15e-3))]
    return GearPair(*gears, face_width_m, 206e9, 0.3, helix_rad=helix)


def test_the_sections_obey_the_identities_of_helical_gearing():
    pair, helix = helical_pair(-25.0), radians(25.0)
    assert pair.overlap_ratio == pytest.approx(20e-3 * sin(helix) / (pi * 3e-3), rel=1e-12)
    assert sin(-pair.base_helix_rad) == pytest.approx(sin(helix) * cos(radians(20.0)), rel=1e-12)
    assert pair.pinion.pitch_radius_m == pytest.approx(18 * 3e-3 / (2.0 * cos(helix)), rel=1e-12)
    section = normal_gear(pair, "pinion")
    heights = [gear.tip_radius_m - gear.root_radius_m for gear in (section, pair.pinion, spur_gear(18, 3e-3))]
    assert heights[0] == pytest.approx(heights[2], rel=1e-12)
    assert heights[1] == pytest.approx(heights[2], rel=1e-12)
    assert section.teeth == pytest.approx(18 / (cos(pair.base_helix_rad) ** 2 * cos(helix)), rel=1e-12)


def test_tables_over_the_face_add_up_to_the_mesh_stiffness():
    pair, options = helical_pair(15.0), StiffnessOptions(coupling="body")
    tables = mesh_tables(pair, (), options)
    angle = np.linspace(0.0, 2.0 * pi / 18, 40, endpoint=False)
    slow = mesh_stiffness(pair, angle, options)
    found = np.zeros(angle.size)
    grid = np.linspace(tables.start_m, tables.end_m, tables.contributions_n_per_m.shape[1])
    for n in range(4):
        place = pair.engagement_start_m + pair.pinion.base_radius_m * angle + n * pair.base_pitch_m
        found += np.interp(place, grid, tables.contributions_n_per_m[0], left=0.0, right=0.0)
    # Lines between the points of a table; coupled contributions have kinks where a pair enters or leaves.
    assert found == pytest.approx(slow, rel=2e-4)


def test_a_pair_is_the_mean_of_its_slices():
    pair, options = helical_pair(25.0), StiffnessOptions()
    tables = mesh_tables(pair, (), options, points=101)
    across = pair.face_width_m * ((np.arange(20_000) + 0.5) / 20_000 - 0.5)
    slow = np.zeros(21)
    for i, position in enumerate(np.linspace(tables.start_m, tables.end_m, 21)):
        place = position + across * np.tan(pair.base_helix_rad)
        on_path = place[(place >= pair.contact_start_m) & (place <= pair.contact_end_m)]
        slow[i] = pair_stiffness(pair, on_path, options).sum() / across.size if on_path.size else 0.0
    # Of 20,000 places one may count too much at either end of the path.
    assert tables.pair_stiffness_n_per_m[0, ::5] == pytest.approx(slow, abs=1e-4 * slow.max())
