"""Bearings on seats that give way, against plain springs and against a model with the seats as coordinates."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.dynamics.structure.casing_structure import SeatedSprings, seated_springs
from siggen.dynamics.structure.structure import Element, assemble, vector

COORDINATES = ("x", "y", "tilt", "body")
SEATS = ("a/vertical", "b/vertical", "c/axial")
HELD = {
    # a shaft that bends has one spring at either end, both on the seat of one place
    "a/vertical": (
        Element({"x": 1.0, "tilt": 0.04, "body": -0.3}, 1.1e8, 700.0),
        Element({"x": 1.0, "tilt": -0.06, "body": -0.3}, 0.7e8, 400.0),
    ),
    "b/vertical": (Element({"y": 1.0, "body": -0.8}, 2.3e8, 900.0),),
}
FLEXIBILITY = 1e-9 * np.array([[2.0, 0.7, 0.0], [0.7, 3.0, 0.1], [0.0, 0.1, 5.0]])
ELEMENTS = [element for of_place in HELD.values() for element in of_place]
ROWS = np.array([vector(COORDINATES, element.direction) for element in ELEMENTS])


def found(flexibility: np.ndarray | None = FLEXIBILITY) -> SeatedSprings:
    return seated_springs(COORDINATES, HELD, SEATS, flexibility)


@pytest.mark.parametrize("flexibility", [None, np.zeros((3, 3))])
def test_seats_that_do_not_give_way_leave_plain_springs(flexibility: np.ndarray | None) -> None:
    springs = found(flexibility)
    for matrix, plain in zip((springs.stiffness, springs.damping), assemble(COORDINATES, ELEMENTS), strict=True):
        np.testing.assert_allclose(matrix, plain, rtol=1e-12, atol=1e-12 * np.abs(plain).max())
    for name, of_place in HELD.items():
        for number, part in enumerate(("stiffness", "damping")):
            row = sum(getattr(e, part) * vector(COORDINATES, e.direction) for e in of_place)
            np.testing.assert_allclose(springs.forces[name][number], row, rtol=1e-12)


def whole_model() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return stiffness and damping of the model with three more coordinates, the yielding of the seats, and rows."""
    # a spring is stretched by its row less what its seat gives way
    on_seat = np.array([[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    rows = np.hstack([ROWS, -on_seat])
    stiffness, damping = (
        rows.T @ np.diag([getattr(e, part) for e in ELEMENTS]) @ rows for part in ("stiffness", "damping")
    )
    stiffness[4:, 4:] += np.linalg.inv(FLEXIBILITY)
    return stiffness, damping, rows


def condensed(dynamic: np.ndarray) -> np.ndarray:
    """Return what is left for the coordinates when the seats follow."""
    return dynamic[:4, :4] - dynamic[:4, 4:] @ np.linalg.solve(dynamic[4:, 4:], dynamic[4:, :4])


def test_springs_on_seats_that_give_way_are_those_of_a_model_with_the_seats() -> None:
    stiffness, damping, _ = whole_model()
    springs = found()
    np.testing.assert_allclose(springs.stiffness, condensed(stiffness), rtol=1e-10, atol=1e-3)
    # what the dampers do, exact for slow motion: the part of the dynamic stiffness that grows with frequency
    slow = 1e-3
    expected = condensed(stiffness + 1j * slow * damping).imag / slow
    np.testing.assert_allclose(springs.damping, expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())


def test_forces_between_shaft_and_seat_are_those_of_the_model_with_the_seats() -> None:
    stiffness, _, rows = whole_model()
    moved = np.array([1e-6, -2e-6, 3e-5, 0.5e-6])
    yielding = -np.linalg.solve(stiffness[4:, 4:], stiffness[4:, :4] @ moved)
    forces = [e.stiffness * row @ np.concatenate([moved, yielding]) for e, row in zip(ELEMENTS, rows, strict=True)]
    springs = found()
    assert springs.forces["a/vertical"][0] @ moved == pytest.approx(forces[0] + forces[1], rel=1e-9)
    assert springs.forces["b/vertical"][0] @ moved == pytest.approx(forces[2], rel=1e-9)
