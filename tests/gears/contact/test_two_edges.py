"""Sink over a gap with two edges: pressure cells, limits, continuity."""

from __future__ import annotations

from math import pi, sqrt

import pytest

from siggen.mesh.contact_edges import NO_EDGE, edge_terms, gap_sink
from tests.reference.contact import plane_contact

KAPPA = 4.0 * (1.0 - 0.3**2) / (pi * 206e9)
RADIUS = 6.676e-3


@pytest.mark.parametrize("length_mm", [0.3, 0.8, 1.5])
@pytest.mark.parametrize("load_n_per_mm", [30.0, 100.0])
@pytest.mark.parametrize("share", [0.0, 0.02, 0.1, 0.5, 1.1])
def test_the_coupled_law_is_that_of_pressure_cells(length_mm, load_n_per_mm, share):
    length, load = length_mm * 1e-3, load_n_per_mm * 1e3 * KAPPA
    offset = share * 0.5 * length
    sink, left = plane_contact.gap_sink(offset, length, RADIUS, load)
    law = gap_sink(0.5 * length + offset, 0.5 * length - offset, 0.0, 0.0, RADIUS, 0.0, load)
    # measured 5 nm and 6e-3; the target of the model is 20 nm
    assert law.sink_m == pytest.approx(sink, abs=6e-9)
    assert law.left_share == pytest.approx(left, abs=8e-3)


@pytest.mark.parametrize("load_n_per_mm", [20.0, 200.0])
@pytest.mark.parametrize("offset", [0.0, 0.5, 0.8, 1.0])
@pytest.mark.parametrize("length", [0.1, 0.3, 0.7, 1.4])
def test_gaps_narrower_than_the_contact_are_those_of_pressure_cells(length, offset, load_n_per_mm):
    load = load_n_per_mm * 1e3 * KAPPA
    width = sqrt(2.0 * RADIUS * load)
    sink, _ = plane_contact.gap_sink(offset * width, length * width, RADIUS, load)
    law = gap_sink((0.5 * length + offset) * width, (0.5 * length - offset) * width, 0.0, 0.0, RADIUS, 0.0, load)
    assert law.sink_m == pytest.approx(sink, abs=0.025 * load)
    assert law.sink_m < 1.1 * sink + 1e-4 * load


@pytest.mark.parametrize("load_n_per_mm", [5.0, 100.0])
def test_a_gap_in_the_middle_of_its_contact_lets_it_sink_as_a_rigid_body(load_n_per_mm):
    """Closed form: p = |x| sqrt(b² - x²)/sqrt(x² - l²/4)/(π κ R), b² = a² + l²/4, gives l²/8R at every load."""
    load = load_n_per_mm * 1e3 * KAPPA
    for part in (1e-4, 1e-2, 0.2):
        length = part * sqrt(2.0 * RADIUS * load)
        law = gap_sink(0.5 * length, 0.5 * length, 0.0, 0.0, RADIUS, 0.0, load)
        assert law.sink_m == pytest.approx(length**2 / (8.0 * RADIUS), rel=0.02)
    # whichever way the normal lies, a gap that closes sinks no more
    for offset in (0.0, 0.3, 0.9, 0.999):
        place = offset * sqrt(2.0 * RADIUS * load)
        law = gap_sink(place + 1e-9, 1e-9 - place, 0.0, 0.0, RADIUS, 0.0, load)
        assert 0.0 <= law.sink_m < 1e-6 * load


@pytest.mark.slow
def test_a_notched_gap_against_fresh_finite_elements():
    pytest.importorskip("skfem", reason="the notch's check needs the extra 'fem': pip install -e '.[fem]'")
    from tests.reference.contact.notched_half_plane import notched_gap_sink

    length, depth, load = 0.5e-3, 0.2e-3, 60e3 * KAPPA
    narrow, _ = notched_gap_sink(0.0, 0.1e-3, depth, RADIUS, load)
    # measured 1.09; the contact is 0.13 mm wide
    assert gap_sink(0.05e-3, 0.05e-3, depth, 0.0, RADIUS, 0.0, load).sink_m == pytest.approx(narrow, rel=0.12)
    for offset in (0.0, 25e-6, 0.15e-3, 0.25e-3):
        sink, left = notched_gap_sink(offset, length, depth, RADIUS, load)
        plain = gap_sink(0.5 * length + offset, 0.5 * length - offset, 0.0, 0.0, RADIUS, 0.0, load)
        law = gap_sink(0.5 * length + offset, 0.5 * length - offset, depth, 0.0, RADIUS, 0.0, load)
        # measured 4 % of what the notch adds
        assert law.sink_m - plain.sink_m == pytest.approx(sink - plain.sink_m, rel=0.05)
        assert law.left_share == pytest.approx(left, abs=0.01)


# sink [µm] and left share from finite elements: (l [mm], D [mm], 2 s/l) at 60 N/mm
FINITE_ELEMENTS = {
    (0.3, 0.2, 0.0): (2.187, 0.5), (0.3, 0.2, 0.2): (2.139, 0.176), (0.3, 0.2, 1.0): (0.617, 0.0),
    (0.5, 0.05, 0.05): (5.000, 0.282), (0.5, 0.2, 0.1): (5.206, 0.148), (0.8, 0.2, 0.05): (12.576, 0.125),
    (0.8, 0.2, 0.6): (3.449, 0.0), (1.5, 0.2, 0.0): (42.942, 0.5), (1.5, 0.05, 0.8): (2.732, 0.0),
}  # fmt: skip


@pytest.mark.parametrize(("case", "expected"), FINITE_ELEMENTS.items())
def test_the_coupled_law_with_a_notch_against_finite_elements(case, expected):
    length, depth, offset = case[0] * 1e-3, case[1] * 1e-3, 0.5 * case[2] * case[0] * 1e-3
    law = gap_sink(0.5 * length + offset, 0.5 * length - offset, depth, 0.0, RADIUS, 0.0, 60e3 * KAPPA)
    assert 1e6 * law.sink_m == pytest.approx(expected[0], abs=0.04)
    assert law.left_share == pytest.approx(expected[1], abs=0.01)


def test_one_edge_is_the_limit_of_a_far_second_one():
    load = 60e3 * KAPPA
    one = gap_sink(0.3e-3, NO_EDGE, 0.0, 0.0, RADIUS, 0.0, load)
    assert one.sink_m == pytest.approx(load * edge_terms(-0.3e-3, 0.0, RADIUS, 0.0, load).factor, rel=1e-12)
    assert gap_sink(0.3e-3, 5e-3, 0.0, 0.0, RADIUS, 0.0, load) == one
    assert gap_sink(-NO_EDGE, -NO_EDGE, 0.0, 0.0, RADIUS, 0.0, load).sink_m == 0.0


def test_the_slope_is_the_derivative_also_where_two_edges_or_the_floor_carry():
    step = 1e-6
    for left, right, floor in (
        (0.26e-3, 0.24e-3, 0.0),
        (0.04e-3, 0.02e-3, 0.0),
        (0.07e-3, -0.01e-3, 0.0),
        (0.3e-3, 0.7e-3, 0.0),
        (0.5e-3, 0.5e-3, 10e-6),
    ):
        load = 60e3 * KAPPA
        here, low, high = (
            gap_sink(left, right, 0.1e-3, floor, RADIUS, 0.0, load * scale) for scale in (1.0, 1.0 - step, 1.0 + step)
        )
        assert here.slope == pytest.approx((high.sink_m - low.sink_m) / (2.0 * step * load), rel=1e-5)
        assert here.slope > 0.0
