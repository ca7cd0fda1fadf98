"""Outlines of damage are to scale: extent, area, place."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.damage.outlines import rectangle
from siggen.views.flank import outline_mm
from tests.gears.builders import pit


def polygon_area(corners):
    x, y = corners.T
    return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


@given(st.floats(0.5, 5.0), st.floats(0.0, 20.0), st.floats(0.05, 3.0), st.floats(0.05, 1.0))
def test_an_ellipse_has_its_place_extent_and_area(height, face, a, b):
    corners = outline_mm(pit(height, face, a_mm=a, b_mm=b).outline)
    assert corners.shape[1] == 2
    # A polygon of 181 corners on the ellipse: its extent falls short by up to 4e-5, its area by 2e-4.
    assert np.ptp(corners, axis=0) == pytest.approx([2 * a, 2 * b], rel=2e-4)
    assert corners.mean(axis=0) == pytest.approx([face, height], abs=1e-9)
    assert polygon_area(corners) == pytest.approx(np.pi * a * b, rel=3e-4)


def test_a_rectangular_spall_is_drawn_by_its_corners() -> None:
    box = rectangle((1e-3, 3e-3), (4e-3, 9e-3))
    assert sorted(map(tuple, outline_mm(box).round(9))) == [(4.0, 1.0), (4.0, 3.0), (9.0, 1.0), (9.0, 3.0)]
