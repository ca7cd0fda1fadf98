"""A row hides another only where its floor is nowhere above the other's: dishes between trapezoids, point by point."""

from __future__ import annotations

import numpy as np

from siggen.gears.damage.covering import hides
from siggen.gears.damage.row_columns import (
    COLUMNS,
    DEPTH,
    DISH,
    FACE,
    HEIGHT,
    HIGHEST,
    LEFT_HIGH,
    LEFT_LOW,
    LOWEST,
    RIGHT_HIGH,
    RIGHT_LOW,
    SEMI_FACE,
    SEMI_HEIGHT,
    TRAPEZOID,
)


def dish(height_m: float, semi_m: float, depth_m: float, ends_m: tuple[float, float] | None = None) -> np.ndarray:
    """Return a band across 10 mm of the face with a dished floor, or the part of it between two heights."""
    row = np.zeros(COLUMNS)
    row[[HEIGHT, SEMI_HEIGHT, DEPTH]] = height_m, semi_m, depth_m
    row[[FACE, SEMI_FACE, DISH, TRAPEZOID]] = 5e-3, 5e-3, 1.0, 1.0
    row[[LOWEST, HIGHEST]] = ends_m or (height_m - semi_m, height_m + semi_m)
    row[[LEFT_LOW, LEFT_HIGH, RIGHT_LOW, RIGHT_HIGH]] = 0.0, 0.0, 10e-3, 10e-3
    return row


def floor_m(row: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.asarray(row[DEPTH] * np.sqrt(np.maximum(1.0 - ((x - row[HEIGHT]) / row[SEMI_HEIGHT]) ** 2, 0.0)))


def test_a_dish_hides_another_exactly_where_its_floor_is_nowhere_above() -> None:
    rng = np.random.default_rng(3)
    wide, said, exposed_inside = dish(0.0, 10e-3, 1e-3), [], 0
    for _ in range(2000):
        semi = 1e-3 * rng.uniform(0.5, 6.0)
        other = dish(rng.uniform(-1.0, 1.0) * (10e-3 - semi), semi, 1e-3 * rng.uniform(0.3, 1.0))
        if rng.random() < 0.5:  # a part of a polygon, cut at two heights
            ends = np.sort(rng.uniform(other[LOWEST], other[HIGHEST], 2))
            other = dish(other[HEIGHT], semi, other[DEPTH], (float(ends[0]), float(ends[1])))
        x = np.linspace(other[LOWEST], other[HIGHEST], 2001)
        above = floor_m(other, x) - floor_m(wide, x)
        if abs(above.max()) > 1e-9:  # nearer than the 2,001 heights tell
            said.append(hides(wide, other))
            assert said[-1] == (above.max() <= 0.0)
            exposed_inside += bool(above[[0, -1]].max() < 0.0 < above.max())
    assert 200 < sum(said) < len(said) - 200
    assert exposed_inside > 50  # both ends covered, the middle not: the vertex decides


def test_a_flat_ellipse_hides_rectangles_whose_corners_lie_in_it_and_no_others() -> None:
    ellipse, rng, said = np.zeros(COLUMNS), np.random.default_rng(4), []
    ellipse[[HEIGHT, FACE, SEMI_HEIGHT, SEMI_FACE, DEPTH]] = 3e-3, 5e-3, 1e-3, 2e-3, 0.4e-3
    ellipse[[LOWEST, HIGHEST]] = 2e-3, 4e-3
    for _ in range(500):
        low, high = np.sort(rng.uniform(2e-3, 4e-3, 2))
        left, right = np.sort(rng.uniform(3e-3, 7e-3, 2))
        box = dish(3e-3, 1e-3, 0.2e-3, (float(low), float(high)))
        box[[LEFT_LOW, LEFT_HIGH, RIGHT_LOW, RIGHT_HIGH, DISH]] = left, left, right, right, 0.0
        corners = [((x - 3e-3) / 1e-3) ** 2 + ((w - 5e-3) / 2e-3) ** 2 for x in (low, high) for w in (left, right)]
        said.append(hides(ellipse, box))
        assert said[-1] == (max(corners) <= 1.0)
    assert 50 < sum(said) < 450
