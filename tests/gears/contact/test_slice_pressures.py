"""Pressures of a loaded face: Hertz away from damage, the edge law at edges, and loads that add up to the force."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from siggen.mesh.contact_edges import largest_edge_pressure
from siggen.mesh.face_force import loads_under_force, slice_pressures
from tests.gears.contact.faces import KAPPA, RADIUS, WIDTH, face, spall

FORCE = 1200.0


@pytest.mark.parametrize("tilt", [0.0, 3e-5])
def test_loads_add_up_to_the_force_and_a_tilt_moves_them(tilt: float) -> None:
    for slices in (face(), spall(rounding=1e-4), face(lead=4e-6 * np.linspace(-1.0, 1.0, 200) ** 2)):
        found = slice_pressures(slices, loads_under_force(slices, FORCE, tilt))
        force = WIDTH / 200 * found.line_load_n_per_m
        assert force.sum() == pytest.approx(FORCE, rel=2e-6)
        moment = float(force @ slices.face_m)
        assert moment > 0.1 if tilt else moment == pytest.approx(0.0, abs=1e-6)


def test_a_lead_and_the_tilt_that_closes_it_are_no_misalignment() -> None:
    plain = face()
    even = loads_under_force(plain, FORCE)
    # The carrying length L follows from the lead alone, so it is kept.
    askew = face(lead=5e-5 * plain.face_m)._replace(carrying_m=plain.carrying_m)
    closed = loads_under_force(askew, FORCE, 5e-5)
    np.testing.assert_allclose(closed, even, rtol=1e-5)


def test_a_sound_face_has_the_pressure_of_hertz() -> None:
    slices = face(coupled=False)
    found = slice_pressures(slices, loads_under_force(slices, FORCE))
    effective = 2.0 / (pi * KAPPA)
    # Johnson, Contact mechanics, eq. 4.45: p0 = sqrt(P E*/(pi R)).
    expected = sqrt(FORCE / WIDTH * effective / (pi * RADIUS))
    np.testing.assert_allclose(found.pressure_pa, expected, rtol=1e-5)
    assert not found.at_edge.any()


def test_both_edges_of_a_spall_through_the_face_carry_half_and_press_as_the_edge_law_says() -> None:
    slices = spall(half=20e-3, rounding=1e-4, coupled=False)
    found = slice_pressures(slices, loads_under_force(slices, FORCE))
    expected = largest_edge_pressure(-0.6e-3, RADIUS, 1e-4, 0.5 * FORCE / WIDTH, KAPPA)
    np.testing.assert_allclose(found.pressure_pa, expected, rtol=1e-4)
    assert found.at_edge.all()
    # Off the middle the nearer edge takes more and presses harder.
    off = spall(offset=2e-4, half=20e-3, rounding=1e-4, coupled=False)
    assert slice_pressures(off, loads_under_force(off, FORCE)).pressure_pa.max() > expected


def test_a_sharp_edge_has_no_largest_pressure() -> None:
    slices = spall(half=20e-3)
    assert np.isinf(slice_pressures(slices, loads_under_force(slices, FORCE)).pressure_pa).all()
