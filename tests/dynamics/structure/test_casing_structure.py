from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.drivetrain.structure import static_solution, vector
from tests.dynamics.casing_stage import (
    BASE_RADIUS_1,
    MEAN_STIFFNESS,
    PRESSURE_ANGLE,
    grounded_structure,
    make_casing,
    make_stage,
    make_structure,
)
from tests.dynamics.natural_frequencies import natural_frequencies_hz
from tests.dynamics.trains import eight_dof


def static(torque_nm: float = 30.0) -> np.ndarray:
    """Return the displacement under a torque at the mean mesh stiffness."""
    structure = make_structure()
    loaded = structure.stiffness + MEAN_STIFFNESS * np.outer(structure.mesh.vector, structure.mesh.vector)
    return static_solution(structure, loaded, torque_nm * structure.torque_vector)


def test_natural_frequencies_of_the_standard_gearbox() -> None:
    # Computed independently with a prototype of the same model, to the digits given.
    expected = [0.0, 81.3, 413.0, 572.0, 688.0, 775.0, 1397.0, 1428.0, 2175.0, 2318.0, 7051.0]
    found = natural_frequencies_hz(make_structure(), MEAN_STIFFNESS)
    assert found[0] == 0.0
    np.testing.assert_allclose(found, expected, atol=0.55)
    mesh_mode = [natural_frequencies_hz(make_structure(), k)[-1] for k in (2.05e8, 3.78e8)]
    np.testing.assert_allclose(mesh_mode, [5750.0, 7714.0], atol=0.55)


def test_an_immovable_casing_leaves_the_eight_degrees_of_freedom() -> None:
    grounded = natural_frequencies_hz(grounded_structure(), MEAN_STIFFNESS)
    eight = natural_frequencies_hz(eight_dof(make_stage()), MEAN_STIFFNESS)
    for frequency in eight[1:]:
        assert np.abs(grounded / frequency - 1.0).min() < 1e-6


def test_bolts_carry_the_torques_of_motor_and_load() -> None:
    structure, q = make_structure(), static()
    machine, moment, forces = structure.drivetrain, 0.0, np.zeros(2)
    for bolt in (element for element in machine.elements if element.name == "bolt"):
        across, up = bolt.stiffness @ machine.stretch(bolt) @ q
        h, v, _ = bolt.ends[0][1].at
        moment += h * up - v * across
        forces += across, up
    # T_m + T_L = 30 (1 + 47/18); the mesh force is internal, so no net force is left.
    assert abs(moment) == pytest.approx(30.0 * (1.0 + 47.0 / 18.0), rel=1e-9)
    assert abs(moment) == pytest.approx(108.33, abs=0.005)
    assert np.abs(forces).max() < 1e-9 * 1182.4


def test_bearings_carry_the_mesh_force() -> None:
    structure, q = make_structure(), static()
    force = 30.0 / BASE_RADIUS_1
    sine, cosine = np.sin(PRESSURE_ANGLE), np.cos(PRESSURE_ANGLE)
    # The mesh pushes the pinion against the line of action, which points down and towards the pinion's side.
    expected = {
        "pinion_bearing/vertical": -force * cosine,
        "pinion_bearing/horizontal": force * sine,
        "gear_bearing/vertical": force * cosine,
        "gear_bearing/horizontal": -force * sine,
    }
    for place, value in expected.items():
        assert structure.bearing_forces[place][0] @ q == pytest.approx(value, rel=1e-9), place


def test_a_sensor_sees_translation_and_rocking_of_its_place() -> None:
    structure = make_structure()
    q = vector(structure.coordinates, {"phi_casing": 1e-3})
    assert structure.motions["casing_lid/vertical"] @ q == pytest.approx(0.06e-3)
    assert structure.motions["casing_lid/horizontal"] @ q == pytest.approx(-0.05e-3)
    moved = vector(structure.coordinates, {"x_casing": 1.0})
    assert structure.motions["casing_lid/horizontal"] @ moved == pytest.approx(1.0)
    assert structure.motions["casing_lid/vertical"] @ moved == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("places", [(), ((0.09, 0.0),), ((0.09, 0.0), (0.09, 0.0))])
def test_a_casing_that_could_turn_freely_is_refused(places: tuple) -> None:
    bolts = replace(make_casing().bolts, places_m=places)
    with pytest.raises(ValueError, match="turn freely"):
        make_structure(bolts=bolts)
