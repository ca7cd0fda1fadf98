from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.mesh.asperities import AsperityTable, asperity_table, mixed_contact, share_at
from siggen.mesh.lubrication import LubricatedMesh, film_traction, relative_radius
from tests.dynamics.lubricated import FORCE, PITCH_POINT, RANGE, mesh

ROUGHNESS = (0.1e-6, 0.57e-6, 2.04e-6, 5e-6)
TABLE = asperity_table(mesh(), ROUGHNESS, RANGE, 2e4)


def asperity_table_error(table: AsperityTable, mesh: LubricatedMesh, roughness_m: tuple[float, ...]) -> float:
    """Return the largest absolute error of the interpolated share at the middle of all cells."""
    positions, loads = table.fluid.shape
    position = (table.start_m + (np.arange(positions - 1) + 0.5) / table.per_m)[:, None]
    floor = table.floor_n_per_m * relative_radius(position, table.line_m)
    force = floor * np.exp((np.arange(loads - 1) + 0.5) / table.per_log)
    worst = 0.0
    for layer, sigma in zip(table.share, roughness_m, strict=True):
        mean = 0.25 * (layer[1:, 1:] + layer[1:, :-1] + layer[:-1, 1:] + layer[:-1, :-1])
        worst = max(worst, float(np.abs(mean - share_at(mesh, sigma, position, force)).max()))
    return worst


def test_the_table_is_as_accurate_as_it_says_and_of_second_order() -> None:
    assert asperity_table_error(TABLE, mesh(), ROUGHNESS) < 1.2e-3  # the stated bound
    # Half the step: a quarter of the error, less where the mid point misses the worst place. Not of smooth flanks:
    # where their film becomes full the share has a corner.
    rough = ROUGHNESS[2:]
    fine, coarse = (asperity_table(mesh(), rough, RANGE, 2e4, points) for points in ((257, 25), (129, 13)))
    assert asperity_table_error(fine, mesh(), rough) < 0.4 * asperity_table_error(coarse, mesh(), rough)


@settings(deadline=None)
@given(layer=st.integers(0, 3), position=st.floats(*RANGE), force=st.floats(0.0, 2e4))
def test_interpolation_between_all_grid_points_keeps_the_stated_error(
    layer: int, position: float, force: float
) -> None:
    direct = share_at(mesh(), ROUGHNESS[layer], position, force)
    table = mixed_contact(TABLE, layer, position, force)[0]
    assert 0.0 <= table <= 1.0
    assert table == pytest.approx(float(direct), abs=1.2e-3)


def test_grid_points_are_exact_and_the_ends_hold() -> None:
    direct = share_at(mesh(), 0.57e-6, TABLE.start_m, FORCE)
    held = mixed_contact(TABLE, 1, TABLE.start_m - 1e-3, FORCE)[0]
    assert held == mixed_contact(TABLE, 1, TABLE.start_m, FORCE)[0]
    assert held == pytest.approx(float(direct), abs=1.2e-3)
    assert mixed_contact(TABLE, 2, PITCH_POINT, 0.0)[0] == mixed_contact(TABLE, 2, PITCH_POINT, 1.0)[0]
    assert mixed_contact(TABLE, 1, PITCH_POINT, 1e9)[0] == mixed_contact(TABLE, 1, PITCH_POINT, 1e8)[0]


def test_the_grid_reaches_over_the_range_with_a_line_at_the_pitch_point() -> None:
    last = TABLE.start_m + 256 / TABLE.per_m
    assert TABLE.start_m <= RANGE[0] < RANGE[1] <= last
    assert last - TABLE.start_m < (RANGE[1] - RANGE[0]) * 257 / 255
    line = (PITCH_POINT - TABLE.start_m) * TABLE.per_m
    assert line == pytest.approx(round(line), abs=1e-9)


def test_fluid_friction_is_that_of_the_film_and_may_depend_on_place_and_load() -> None:
    share = np.zeros((1, 257, 25))
    position = TABLE.start_m + np.arange(257) / TABLE.per_m
    lowest = TABLE.floor_n_per_m * relative_radius(position, TABLE.line_m)
    force = lowest[:, None] * np.exp(np.arange(25) / TABLE.per_log)
    table = TABLE._replace(share=share, fluid=position[:, None] + 0.01 * np.log(force))
    expected = PITCH_POINT + 0.01 * np.log(FORCE)
    # Linear in the position; in the load axis only up to the curvature of ln R_e along a cell, 1e-3 of 0.01.
    assert mixed_contact(table, 0, PITCH_POINT, FORCE)[1] == pytest.approx(expected, abs=2e-5)
    assert mixed_contact(TABLE, 0, PITCH_POINT, FORCE)[1] == pytest.approx(0.0, abs=1e-12)
    for place in (PITCH_POINT - 4e-3, PITCH_POINT + 3e-3):
        direct = film_traction(mesh(), place, FORCE, share_at(mesh(), ROUGHNESS[0], place, FORCE))
        assert mixed_contact(TABLE, 0, place, FORCE)[1] == pytest.approx(float(direct), abs=1e-4)


def test_beside_the_pitch_point_the_film_is_tabled_as_well_as_it_says() -> None:
    for cells, bound in ((0.5, 1.2e-3), (1.5, 3e-4)):
        place = PITCH_POINT + cells / TABLE.per_m
        table = asperity_table(mesh(), ROUGHNESS[1:2], RANGE, 2e4)
        direct = film_traction(mesh(), place, FORCE, share_at(mesh(), ROUGHNESS[1], place, FORCE))
        assert mixed_contact(table, 0, place, FORCE)[1] == pytest.approx(float(direct), abs=bound)
