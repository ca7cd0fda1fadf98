"""Three-dimensional finite elements of a crack in a part of the face, and the slices of the contact beside them."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest

SKIP = "the finite-element check needs the extra 'fem': pip install -e '.[fem]'"
pytest.importorskip("skfem", reason=SKIP)
pytest.importorskip("gmsh", reason=SKIP, exc_type=ImportError)

from tests.reference.finite_elements.face_compliance import face_compliance  # noqa: E402
from tests.reference.finite_elements.part_crack import part_crack  # noqa: E402
from tests.reference.finite_elements.spatial_pair import bench_pair  # noqa: E402

WIDTH, ELEMENT, SIZE = 20 / 3, 0.8, 0.25


@pytest.mark.slow
def test_a_crack_that_is_tied_everywhere_is_a_sound_tooth_and_one_from_an_end_bends_that_end():
    gear, roll = bench_pair().pinion, np.array([np.mean(bench_pair().active_flank[0])])
    sound = face_compliance(gear, roll, WIDTH, SIZE, ELEMENT, 2).modes[0]

    def modes(depth):
        return part_crack(gear, roll, WIDTH, 0.25, radians(45), depth, SIZE, ELEMENT, 2).modes[0]

    # meshes of 0.25 modules differ by 1 %
    assert modes(None) == pytest.approx(sound, rel=0.01, abs=0.01)
    whole, half = modes(lambda y: 0.25 + 0.0 * y), modes(lambda y: 0.25 * np.sqrt(np.maximum(1.0 - y / 0.5, 0.0)))
    assert 0.15 < (half[0, 0] - sound[0, 0]) / (whole[0, 0] - sound[0, 0]) < 0.4
    assert abs(whole[0, 1]) < 1e-6 < 0.1 < half[0, 1]
