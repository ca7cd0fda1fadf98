"""Shafts that bend: the closed form against a beam of finite elements, and the limits of stiff and symmetric shafts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.drivetrain.drivetrain import Element
from siggen.drivetrain.gear_stage import Bearing, Shaft, cantilever_compliance_m_per_n
from siggen.drivetrain.structure import Structure
from tests.dynamics.casing_stage import MEAN_STIFFNESS, PRESSURE_ANGLE, make_casing, make_stage, make_structure
from tests.dynamics.natural_frequencies import natural_frequencies_hz
from tests.dynamics.trains import casing_structure

SHAFT = Shaft(0.12, 0.35, 0.025, 206e9, 0.3, 1e-4)
STIFF = Shaft(0.12, 0.5, 10.0, 206e9, 0.3, 1e-4)


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
    structure = casing_structure(make_stage(), make_casing(), (shaft, shaft))
    rows = [structure.coordinates.index(name) for name in ("y_pinion", "phi_y_pinion")]
    found = structure.stiffness[np.ix_(rows, rows)]
    # Timoshenko elements are exact at their nodes, so that one and four per side differ by rounding only.
    for elements in (1, 4):
        np.testing.assert_allclose(found, beam_stiffness(shaft, 2e8, elements), rtol=1e-8, atol=1e-7 * found.max())


def ends(shaft: Shaft, bearing: Bearing) -> list[Element]:
    """Return what holds the pinion at both ends of its shaft."""
    stage = make_stage()
    stage = replace(stage, pinion=replace(stage.pinion, bearing=bearing))
    machine = casing_structure(stage, make_casing(), (shaft, shaft)).drivetrain
    return [element for element in machine.elements if element.name == "pinion_bearing"]


def test_a_stiff_shaft_with_its_gear_in_the_middle_leaves_the_bearings_as_they_were() -> None:
    stiff = replace(STIFF, diameter_m=1e3)
    found = ends(stiff, Bearing(2e8, 1e8, 1000.0, 700.0))
    assert sum(e.stiffness for e in found) == pytest.approx(np.diag([2e8, 1e8]), rel=1e-9)
    assert sum(e.damping for e in found) == pytest.approx(np.diag([1000.0, 700.0]), rel=1e-9)
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
    bearing, slow_rad_s = Bearing(1e8, 2e8, 0.0, 1000.0), 10.0
    for element, lever in zip(ends(SHAFT, bearing), SHAFT.levers_m.values(), strict=True):
        gives_way = 1.0 / beam_stiffness_of_end(abs(lever))
        half = 0.5 * (2e8 + 1j * slow_rad_s * 1000.0)
        series = 1.0 / (1.0 / half + gives_way)
        assert element.stiffness[1, 1] == pytest.approx(series.real, rel=1e-6)
        assert element.damping[1, 1] == pytest.approx(series.imag / slow_rad_s, rel=1e-6)


def beam_stiffness_of_end(length: float) -> float:
    """Stiffness at the free end of a clamped beam, from one element."""
    free = timoshenko_element(length, SHAFT.diameter_m)[2:, 2:]
    return float(1.0 / np.linalg.inv(free)[0, 0])


def test_the_tilt_vector_takes_the_pinion_against_the_gear_in_the_plane_of_action() -> None:
    structure = tilting_structure()
    assert structure.mesh.tilt is not None
    tilts = dict(zip(structure.coordinates, structure.mesh.tilt, strict=True))
    sine, cosine = np.sin(PRESSURE_ANGLE), np.cos(PRESSURE_ANGLE)
    push = {"phi_x_pinion": -sine, "phi_y_pinion": cosine, "phi_x_gear": sine, "phi_y_gear": -cosine}
    assert {name: value for name, value in tilts.items() if value} == pytest.approx(push)
    assert make_structure().mesh.tilt is None


def test_a_bearing_that_pushes_across_is_one_without_seen_from_turned_axes() -> None:
    """Along the axes of the ellipse of its stiffness each spring is in series with the cantilever, as one alone is."""
    turn, along, damping = 0.4, np.array([3e8, 1e8]), 900.0
    axes = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    whole = axes @ np.diag(along) @ axes.T
    bearing = Bearing(whole[0, 0], whole[1, 1], damping, damping, whole[0, 1])
    for end, lever_m in zip(ends(SHAFT, bearing), SHAFT.levers_m.values(), strict=True):
        series = 1.0 / (2.0 / along + cantilever_compliance_m_per_n(SHAFT, abs(lever_m)))
        stiffness = axes @ np.diag(series) @ axes.T
        damped = axes @ np.diag(0.5 * damping * (2.0 * series / along) ** 2) @ axes.T
        assert end.stiffness == pytest.approx(stiffness, rel=1e-9)
        assert end.damping == pytest.approx(damped, rel=1e-9)
