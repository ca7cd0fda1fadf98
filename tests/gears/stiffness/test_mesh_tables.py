"""Tables of pair stiffness: rows, indices, interpolation error, largest loss of mesh stiffness."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from siggen.mesh.mesh_stiffness import mesh_stiffness, pair_stiffness
from siggen.mesh.mesh_tables import largest_stiffness_loss, mesh_tables
from siggen.mesh.stiffness_options import StiffnessOptions
from tests.gears.builders import layers, pair_18_47, pit

PAIR = pair_18_47()
TROCHOID = StiffnessOptions()


def test_a_healthy_mesh_has_one_row_on_a_uniform_grid_from_entry_to_exit():
    tables = mesh_tables(PAIR, (), TROCHOID, points=501)
    assert tables.pair_stiffness_n_per_m.shape == (1, 501)
    assert not tables.table_of_pair.any()
    assert tables.table_of_pair.shape == (18, 47)
    assert tables.table_of_pair.dtype == np.int32
    assert tables.start_m + 500 * tables.step_m == pytest.approx(tables.end_m, rel=1e-15)
    grid = np.linspace(tables.start_m, tables.end_m, 501)
    assert np.array_equal(tables.pair_stiffness_n_per_m[0], pair_stiffness(PAIR, grid, TROCHOID))


def test_damaged_teeth_of_both_gears_get_their_rows_and_share_the_healthy_one():
    on_pinion = tuple(replace(p, tooth=3) for p in layers(1, 10))
    on_gear = (pit(5.0, 10.0, 2.0, gear="gear", tooth=11),)
    tables = mesh_tables(PAIR, on_pinion + on_gear, TROCHOID, points=201)
    index = tables.table_of_pair
    assert tables.pair_stiffness_n_per_m.shape == (4, 201)
    assert index[0, 0] == 0
    assert len({index[0, 0], index[3, 0], index[0, 11], index[3, 11]}) == 4
    assert np.all(np.delete(index[3], 11) == index[3, 0])
    assert np.all(np.delete(index[:, 11], 3) == index[0, 11])
    assert np.count_nonzero(index) == 47 + 18 - 1
    grid = np.linspace(tables.start_m, tables.end_m, 201)
    for i, j, first, second in ((3, 0, on_pinion, ()), (0, 11, (), on_gear), (3, 11, on_pinion, on_gear)):
        direct = pair_stiffness(PAIR, grid, TROCHOID, first, second)
        assert np.array_equal(tables.pair_stiffness_n_per_m[index[i, j]], direct)


def test_interpolation_error_falls_with_the_square_of_the_step_when_healthy():
    errors = []
    for points in (129, 257):
        tables = mesh_tables(PAIR, (), TROCHOID, points)
        (row,), middle = tables.pair_stiffness_n_per_m, tables.start_m + tables.step_m * (np.arange(points - 1) + 0.5)
        errors.append(np.abs(0.5 * (row[1:] + row[:-1]) / pair_stiffness(PAIR, middle, TROCHOID) - 1.0).max())
    coarse, fine = errors
    assert coarse / fine == pytest.approx(4.0, rel=0.1)
    assert fine < 1e-5


def test_tables_reproduce_the_mesh_stiffness_of_every_pair_in_turn():
    on_pinion = tuple(replace(p, tooth=t) for t in (0, 7) for p in layers(1, 6))
    damage = (*on_pinion, pit(5.0, 10.0, 2.0, gear="gear", tooth=2))
    tables = mesh_tables(PAIR, damage, TROCHOID, points=8193)
    angle = np.linspace(0.3, 60.0, 4001)
    direct = mesh_stiffness(PAIR, angle, TROCHOID, damage)
    travel = angle * PAIR.pinion.base_radius_m
    total = np.zeros(angle.size)
    grid = np.linspace(tables.start_m, tables.end_m, 8193)
    newest = np.floor(travel / tables.base_pitch_m).astype(int)
    for back in range(2):
        n = newest - back
        s = tables.start_m + travel - n * tables.base_pitch_m
        rows = tables.table_of_pair[n % 18, n % 47]
        for row in np.unique(rows):
            chosen = (rows == row) & (s <= tables.end_m)
            total[chosen] += np.interp(s[chosen], grid, tables.pair_stiffness_n_per_m[row])
    # Interpolation across pits' ends: quarter of the step of the default table.
    assert total == pytest.approx(direct, rel=1e-3)
    assert np.median(np.abs(total / direct - 1)) < 1e-7


def test_largest_loss_is_the_maximum_over_the_whole_hunting_period():
    damage = (
        *(replace(p, tooth=0) for p in layers(1, 6)),
        *(replace(p, tooth=1) for p in layers(1, 8, height_mm=4.4)),
        pit(5.0, 10.0, 3.0, gear="gear", tooth=2),
        pit(4.0, 4.0, 2.0, gear="gear", tooth=3),
    )
    angle = np.linspace(0.0, 47 * 2 * pi, 400001)
    healthy = mesh_stiffness(PAIR, angle, TROCHOID)
    sampled = np.max(1 - mesh_stiffness(PAIR, angle, TROCHOID, damage) / healthy)
    largest = largest_stiffness_loss(PAIR, damage, TROCHOID)
    # The hunting period is sampled every 0.0007 rad, 25 um on a pit of 400 um: within (25/2/200)^2/2 of the peak.
    assert sampled <= largest * (1 + 1e-9)
    assert sampled == pytest.approx(largest, rel=4e-3)
