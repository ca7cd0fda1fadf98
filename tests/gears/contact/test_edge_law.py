"""Sink at one edge: limits, derivatives, pressure cells, and the notch against plane finite elements."""

from __future__ import annotations

from math import log, pi, sqrt

import numpy as np
import pytest

from siggen.mesh.contact_edges import QUARTER_PLANE, edge_terms, largest_edge_pressure
from tests.reference.contact.plane_contact import edge_sink, land_cells, solve_cells

KAPPA = 4.0 * (1.0 - 0.3**2) / (pi * 206e9)
RADIUS = 6.676e-3
LOAD = 60e3 * KAPPA
WIDTH = sqrt(2.0 * RADIUS * LOAD)


def sink_factor(ahead: float, depth: float = 0.0) -> float:
    """Sink over κF at a sharp edge, at d and behind it a notch of the depth D, both over a."""
    return edge_terms(ahead * WIDTH, depth * WIDTH, RADIUS, 0.0, LOAD).factor


def notch_factor(ahead: float, depth: float) -> float:
    return sink_factor(ahead, depth) - sink_factor(ahead)


@pytest.mark.parametrize("ahead", [0.7, 0.0, -1.0, -3.7, -11.0])
def test_the_half_plane_law_is_that_of_pressure_cells(ahead):
    sink = edge_sink(ahead * WIDTH, RADIUS, LOAD) / LOAD
    # the cells themselves are good to 1e-4 of the load and 1e-5 of the sink
    assert sink_factor(ahead) == pytest.approx(sink, rel=2e-5, abs=1e-4)


@pytest.mark.parametrize("ahead_m", [-0.8e-3, -0.1e-3, 0.02e-3, 0.1e-3, 0.15e-3])
@pytest.mark.parametrize("depth_m", [0.0, 0.05e-3, 0.2e-3])
@pytest.mark.parametrize("rounding_m", [0.0, 0.1e-3])
def test_slopes_are_derivatives(ahead_m, depth_m, rounding_m):
    step = 1e-6
    here, low, high = (
        edge_terms(ahead_m, depth_m, RADIUS, rounding_m, LOAD * scale) for scale in (1.0, 1.0 - step, 1.0 + step)
    )
    assert here.factor_slope == pytest.approx((high.factor - low.factor) / (2.0 * step), rel=1e-6, abs=1e-7)
    expected = (high.centroid_m - low.centroid_m) / (2.0 * step)
    assert here.centroid_slope_m == pytest.approx(expected, rel=1e-6, abs=1e-12)


def test_a_narrow_contact_at_a_notch_softens_like_a_quarter_plane():
    # derived from Flamant's and the wedge's point loads; see the module
    wedge = 0.5 * pi * (1.0 / (0.5 * pi + 1.0) + 1.0 / (0.5 * pi - 1.0))
    assert pytest.approx(0.5 * (wedge - 1.0), abs=1e-4) == QUARTER_PLANE
    deep = [notch_factor(-50.0, depth) for depth in (10.0, 20.0)]
    assert (deep[1] - deep[0]) / log(2.0) == pytest.approx(QUARTER_PLANE, rel=2e-3)


# N from notched half planes of finite elements: (D [mm], d/a) at 60 N/mm, a = 67.1 µm
FINITE_ELEMENTS = {
    (0.05, -6.0): 1.8311, (0.05, -1.0): 0.6748, (0.05, 0.0): 0.3666, (0.05, 0.5): 0.2261,
    (0.2, -11.0): 4.0072, (0.2, -3.7): 2.8264, (0.2, -1.0): 1.8304, (0.2, 0.0): 1.2809, (0.2, 0.5): 0.9805,
    (0.2, 1.0): 0.6674, (0.2, 1.5): 0.4062, (0.2, 2.0): 0.2509,
}  # fmt: skip


@pytest.mark.parametrize(("case", "expected"), FINITE_ELEMENTS.items())
def test_the_notch_term_against_finite_elements(case, expected):
    depth, ahead = case
    found = notch_factor(ahead, depth * 1e-3 / WIDTH)
    # what the fit leaves; on land it errs absolutely: 0.04 κF are 13 nm here
    assert found == pytest.approx(expected, rel=0.04, abs=0.04 if ahead > 1.0 else 0.0)


def rounded(ahead: float, rounding: float):
    """Pressure cells on a land with a rounded edge: sink and largest pressure times κ."""
    land = land_cells(0.0, -(1.4 + max(ahead, 0.0)) * WIDTH, 1e-4 * WIDTH, WIDTH / 60.0)
    reach = 4.0 * rounding * max(-ahead, 0.0) * WIDTH / (RADIUS + rounding) + 4.8 * WIDTH * sqrt(rounding / RADIUS)
    pit = land_cells(0.0, reach, 1e-4 * WIDTH, reach / 80.0)
    ends = np.vstack([land, pit])
    low, high = ends.T
    falling = np.where(low >= 0.0, (low * low + low * high + high * high) / (6.0 * rounding), 0.0)
    contact = solve_cells(ends, -ahead * WIDTH, RADIUS, LOAD, rounding=falling)
    return contact.approach, float((contact.load / (high - low)).max())


@pytest.mark.parametrize("rounding_mm", [0.02, 0.2])
@pytest.mark.parametrize("ahead", [0.5, -0.5, -3.7, -11.0])
def test_a_rounded_edge_against_pressure_cells(ahead, rounding_mm):
    approach, pressure = rounded(ahead, rounding_mm * 1e-3)
    land = land_cells(0.0, -(1.4 + max(ahead, 0.0)) * WIDTH, 1e-4 * WIDTH, WIDTH / 60.0)
    sharp = solve_cells(land, -ahead * WIDTH, RADIUS, LOAD).approach
    law, plain = (
        edge_terms(ahead * WIDTH, 0.0, RADIUS, radius, LOAD).factor * LOAD for radius in (rounding_mm * 1e-3, 0.0)
    )
    rigid = min(ahead, 0.0) ** 2 * WIDTH**2 / (2.0 * (RADIUS + rounding_mm * 1e-3))
    # the law's own statement: 7 % of the elastic part
    assert law - plain == pytest.approx(approach - sharp, abs=0.07 * (law - rigid))
    found = largest_edge_pressure(ahead * WIDTH, RADIUS, rounding_mm * 1e-3, 60e3, KAPPA)
    assert found == pytest.approx(pressure / KAPPA, rel=0.045)
