"""Bearings on seats that give way, against plain springs and against a model with the seats as coordinates."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.drivetrain.drivetrain import Body, Drivetrain, Element, Modes, Place, spring
from siggen.drivetrain.structure import Structure, assembled, matrices

SEATS = ("a/vertical", "b/horizontal", "c/axial")
FLEXIBILITY = 1e-9 * np.array([[2.0, 0.7, 0.0], [0.7, 3.0, 0.1], [0.0, 0.1, 5.0]])
MOTOR = Body("m", inertia_kg_m2=1.0, moves=("theta",))
GEAR = Body("1", 2.0, 1e-3, 1e-3, moves=("x", "y", "phi_y"))
STIFFNESS, DAMPING = np.array([1.1e8, 0.7e8, 2.3e8]), np.array([700.0, 400.0, 900.0])
# a shaft that bends has one spring at either end, both on the seat of one place
ROWS = np.array([[0.0, 1.0, 0.04, -0.3], [0.0, 1.0, -0.06, -0.3], [1.0, 0.0, 0.0, -0.8]])


def elements() -> list[Element]:
    places = (("a", "vertical", 0.04), ("a", "vertical", -0.06), ("b", "horizontal", 0.0))
    return [
        spring(name, Place("1", (0.0, 0.0, lever)), Place("c", name), along, float(k), float(c), bearing=True)
        for (name, along, lever), k, c in zip(places, STIFFNESS, DAMPING, strict=True)
    ]


def machine(give: np.ndarray) -> Drivetrain:
    shapes = {"a/vertical": np.array([0.3]), "b/horizontal": np.array([0.8])}
    still = np.array([1e-6])
    housing = Modes("c", still, still, shapes, SEATS, give, np.zeros((1, 3)))
    return Drivetrain((MOTOR, GEAR, housing, Body("base", moves=())), tuple(elements()), driver="m", load="m")


def found(give: np.ndarray = FLEXIBILITY) -> Structure:
    return assembled(machine(give))


def own(matrix: np.ndarray) -> np.ndarray:
    """Return the entries of x, y, the tilt and the mode."""
    return matrix[1:, 1:]


def plain(numbers: np.ndarray) -> np.ndarray:
    return ROWS.T @ np.diag(numbers) @ ROWS


def test_seats_that_do_not_give_way_leave_plain_springs() -> None:
    structure = found(np.zeros((3, 3)))
    for matrix, numbers in ((structure.stiffness, STIFFNESS), (structure.damping, DAMPING)):
        expected = plain(numbers)
        np.testing.assert_allclose(own(matrix), expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max())
    for name, rows in (("a/vertical", [0, 1]), ("b/horizontal", [2])):
        for force, numbers in zip(structure.bearing_forces[name], (STIFFNESS, DAMPING), strict=True):
            np.testing.assert_allclose(force[1:], numbers[rows] @ ROWS[rows], rtol=1e-12)


def whole_model() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return stiffness and damping of the model with three more coordinates, the yielding of the seats, and rows."""
    # a spring is stretched by its row less what its seat gives way
    on_seat = np.array([[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    rows = np.hstack([ROWS, -on_seat])
    stiffness, damping = (rows.T @ np.diag(numbers) @ rows for numbers in (STIFFNESS, DAMPING))
    stiffness[4:, 4:] += np.linalg.inv(FLEXIBILITY)
    return stiffness, damping, rows


def condensed(dynamic: np.ndarray) -> np.ndarray:
    """Return what is left for the coordinates when the seats follow."""
    return dynamic[:4, :4] - dynamic[:4, 4:] @ np.linalg.solve(dynamic[4:, 4:], dynamic[4:, :4])


def test_springs_on_seats_that_give_way_are_those_of_a_model_with_the_seats() -> None:
    stiffness, damping, _ = whole_model()
    _, damped, stiff = matrices(machine(FLEXIBILITY))
    np.testing.assert_allclose(own(stiff), condensed(stiffness), rtol=1e-10, atol=1e-3)
    # what the dampers do, exact for slow motion: the part of the dynamic stiffness that grows with frequency
    slow = 1e-3
    expected = condensed(stiffness + 1j * slow * damping).imag / slow
    np.testing.assert_allclose(own(damped), expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())


def test_forces_between_shaft_and_seat_are_those_of_the_model_with_the_seats() -> None:
    stiffness, _, rows = whole_model()
    moved = np.array([1e-6, -2e-6, 3e-5, 0.5e-6])
    yielding = -np.linalg.solve(stiffness[4:, 4:], stiffness[4:, :4] @ moved)
    forces = STIFFNESS * (rows @ np.concatenate([moved, yielding]))
    springs = found().bearing_forces
    assert springs["a/vertical"][0][1:] @ moved == pytest.approx(forces[0] + forces[1], rel=1e-9)
    assert springs["b/horizontal"][0][1:] @ moved == pytest.approx(forces[2], rel=1e-9)
