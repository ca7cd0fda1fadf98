"""Strips of the face: rows that may hide a point are among those of the point's strip."""

from __future__ import annotations

import numpy as np

from siggen.gears.damage.flank_damage import pit_rows
from siggen.gears.damage.visible_points import strictly_inside, strip_at, strips_of
from tests.gears.builders import pit

FACE_MM = 20.0


def test_every_row_that_holds_a_point_is_in_the_strip_of_the_point() -> None:
    rng = np.random.default_rng(5)
    rows = pit_rows(
        [pit(2.5 + rng.random(), FACE_MM * rng.random(), 0.6 * rng.random() + 0.01, 0.3) for _ in range(60)]
    )
    strips, found = strips_of(rows), 0
    for w in np.linspace(-1e-3, 1e-3 * (FACE_MM + 1.0), 400):
        strip = strip_at(strips, w)
        listed = set(strips.rows[strips.first[strip] : strips.first[strip + 1]].tolist())
        for x in (2.3e-3, 2.8e-3, 3.3e-3):
            holding = {k for k in range(len(rows)) if strictly_inside(x, w, rows[k])}
            found += len(holding)
            assert holding <= listed
    assert found > 100  # the points do lie in pits
    assert strips.rows.size < 10 * len(rows)  # and a strip lists few of all rows
