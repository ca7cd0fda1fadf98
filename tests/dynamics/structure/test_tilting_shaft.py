"""Shafts that bend: the closed form against a beam of finite elements, and the limits of stiff and symmetric shafts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.dynamics.structure.casing_structure import casing_structure
from siggen.dynamics.structure.structure import Element, Structure, assemble
from siggen.dynamics.structure.tilting_shaft import Shaft, cantilever_compliance_m_per_n, crossed_ends, tilting_ends
from tests.dynamics.casing_stage import MEAN_STIFFNESS, make_casing, make_stage, make_structure
from tests.dynamics.natural_frequencies import natural_frequencies_hz

SHAFT = Shaft(0.12, 0.35, 0.025, 206e9, 0.3, 1e-4)
STIFF = Shaft(0.12, 0.5, 10.0, 206e9, 0.3, 1e-4)
BEARING = Element({"x_1": 0.6, "y_1": 0.8}, 2e8, 1000.0)


def tilting_structure(shaft: Shaft = SHAFT, **changes) -> Structure:
    return casing_structure(make_stage(), make_casing(**changes), (shaft, shaft))


def timoshenko_element(length: float, diameter: float) -> np.ndarray:
    """Stiffness (4, 4) of a beam element for [w, w', w, w'] at its ends; standard literature."""
    modulus, poisson = 206e9, 0.3
    area, inertia = np.pi * diameter**2 / 4.0, np.pi * diameter**4 / 64.0
    kappa = 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson)
    phi = 12.0 * modulus * inertia / (kappa * modulus / (2.0 * (1.0 + poisson)) * area * length**2)
    bend = np.array(
        [
            [12.0, 6.0 * length, -12.0, 6.0 * length],
            [6.0 * length, (4.0 + phi) * length**2, -6.0 * length, (2.0 - phi) * length**2],
            [-12.0, -6.0 * length, 12.0, -6.0 * length],
            [6.0 * length, (2.0 - phi) * length**2, -6.0 * length, (4.0 + phi) * length**2],
        ]
    )
    return modulus * inertia / (length**3 * (1.0 + phi)) * bend


def beam_stiffness(shaft: Shaft, bearing: float, elements: int) -> np.ndarray:
    """Stiffness (2, 2) for displacement and tilt at the gear, from a chain of elements on two bearings."""
    a, b = shaft.gear_share * shaft.span_m, (1.0 - shaft.gear_share) * shaft.span_m
    nodes = np.concatenate([np.linspace(0.0, a, elements + 1), a + np.linspace(0.0, b, elements + 1)[1:]])
    whole = np.zeros((2 * nodes.size, 2 * nodes.size))
    for i in range(nodes.size - 1):
        place = slice(2 * i, 2 * i + 4)
        whole[place, place] += timoshenko_element(nodes[i + 1] - nodes[i], shaft.diameter_m)
    for end in (0, 2 * nodes.size - 2):
        whole[end, end] += 0.5 * bearing
    return np.linalg.inv(np.linalg.inv(whole)[2 * elements : 2 * elements + 2, 2 * elements : 2 * elements + 2])


@pytest.mark.parametrize("share", [0.2, 0.35, 0.5, 0.8])
def test_the_closed_form_is_a_timoshenko_beam_of_finite_elements(share: float) -> None:
    shaft = replace(SHAFT, gear_share=share)
    upright = Element({"x_1": 0.0, "y_1": 1.0}, 2e8, 0.0)
    found, _ = assemble(["y_1", "phi_y_1"], [without(e, {"x_1", "phi_x_1"}) for e in ends(shaft, upright)])
    # Timoshenko elements are exact at their nodes, so that one and four per side differ by rounding only.
    for elements in (1, 4):
        np.testing.assert_allclose(found, beam_stiffness(shaft, 2e8, elements), rtol=1e-8, atol=1e-7 * found.max())


def ends(shaft: Shaft, bearing: Element) -> list[Element]:
    return list(tilting_ends(bearing, shaft, "1").values())


def without(element: Element, names: set[str]) -> Element:
    kept = {name: value for name, value in element.direction.items() if name not in names}
    return Element(kept, element.stiffness, element.damping)


def test_a_stiff_shaft_with_its_gear_in_the_middle_leaves_the_bearings_as_they_were() -> None:
    stiff = replace(STIFF, diameter_m=1e3)
    found = ends(stiff, BEARING)
    assert sum(e.stiffness for e in found) == pytest.approx(BEARING.stiffness, rel=1e-9)
    assert sum(e.damping for e in found) == pytest.approx(BEARING.damping, rel=1e-9)
    bare = natural_frequencies_hz(make_structure(), MEAN_STIFFNESS)
    tilting = natural_frequencies_hz(tilting_structure(stiff), MEAN_STIFFNESS)
    # Tilts stand apart: what is left after the eleven modes of the parallel gears are the four of the tilts, which
    # share the stiffness k (L/2)².
    tilts = np.sqrt(2e8 * 0.06**2 / 1e-4) / (2.0 * np.pi)
    left = [f for f in tilting if abs(f / tilts - 1.0) > 1e-6]
    np.testing.assert_allclose(left, bare, rtol=1e-9, atol=1e-3)
    assert tilting.size == 15


def test_a_bending_shaft_takes_motion_from_the_bearings_damper() -> None:
    """The damper against the complex stiffness of bearing and cantilever in series, at a slow frequency.

    At 10 rad/s the damper's force is 1e-4 of the spring's, so terms of second order are 1e-8.
    """
    bearing, slow_rad_s = Element({"x_1": 0.0, "y_1": 1.0}, 2e8, 1000.0), 10.0
    for element, lever in zip(ends(SHAFT, bearing), SHAFT.levers_m.values(), strict=True):
        gives_way = 1.0 / beam_stiffness_of_end(abs(lever))
        half = 0.5 * (bearing.stiffness + 1j * slow_rad_s * bearing.damping)
        series = 1.0 / (1.0 / half + gives_way)
        assert element.stiffness == pytest.approx(series.real, rel=1e-6)
        assert element.damping == pytest.approx(series.imag / slow_rad_s, rel=1e-6)


def beam_stiffness_of_end(length: float) -> float:
    """Stiffness at the free end of a clamped beam, from one element."""
    free = timoshenko_element(length, SHAFT.diameter_m)[2:, 2:]
    return float(1.0 / np.linalg.inv(free)[0, 0])


def test_the_tilt_vector_takes_the_pinion_against_the_gear_in_the_plane_of_action() -> None:
    structure = tilting_structure()
    assert structure.mesh.tilt is not None
    tilts = dict(zip(structure.coordinates, structure.mesh.tilt, strict=True))
    assert {name: value for name, value in tilts.items() if value} == {"phi_y_1": 1.0, "phi_y_2": -1.0}
    assert make_structure().mesh.tilt is None


def test_a_bearing_that_pushes_across_is_one_without_seen_from_turned_axes() -> None:
    """Along the axes of the ellipse of its stiffness each spring is in series with the cantilever, as one alone is."""
    turn, along, damping = 0.4, np.array([3e8, 1e8]), 900.0
    axes = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    whole = axes @ np.diag(along) @ axes.T
    ways = ({"x_1": 1.0, "y_1": 0.0}, {"x_1": 0.0, "y_1": 1.0})
    bearings = [Element(way, float(whole[i, i]), damping) for i, way in enumerate(ways)]
    ends = crossed_ends((bearings[0], bearings[1]), float(whole[0, 1]), SHAFT, "1")
    for end, lever_m in zip(ends, SHAFT.levers_m.values(), strict=True):
        series = 1.0 / (2.0 / along + cantilever_compliance_m_per_n(SHAFT, abs(lever_m)))
        stiffness = axes @ np.diag(series) @ axes.T
        damped = axes @ np.diag(0.5 * damping * (2.0 * series / along) ** 2) @ axes.T
        assert (end.stiffness, end.damping) == pytest.approx((stiffness[0, 1], damped[0, 1]), rel=1e-9)
        for i, one in enumerate(end.elements):
            assert (one.stiffness, one.damping) == pytest.approx((stiffness[i, i], damped[i, i]), rel=1e-9)
