from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.mesh.lubrication import LOAD_FLOOR, central_film_m, film_ratio
from tests.dynamics.lubricated import FORCE, PITCH_POINT, RANGE, mesh


def film(position: float = PITCH_POINT, force: float = FORCE, **other: float) -> float:
    return float(central_film_m(mesh(**other).groups(position, force)))


def test_the_groups_and_the_film_of_the_reference_point() -> None:
    groups = mesh().groups(PITCH_POINT, FORCE)
    # Published to two and three digits.
    assert groups.speed == pytest.approx(1.3e-10, rel=0.03)
    assert groups.material == pytest.approx(4980, rel=1e-3)
    assert groups.load == pytest.approx(3.9e-5, rel=5e-3)
    assert film() == pytest.approx(1.01e-6, abs=5e-9)


def test_the_film_is_central_since_it_is_a_quarter_thicker_than_the_least_of_dowson_and_higginson() -> None:
    groups = mesh().groups(PITCH_POINT, FORCE)
    least = 2.65 * groups.speed**0.70 * groups.material**0.54 * groups.load**-0.13 * groups.radius_m
    assert least == pytest.approx(0.80e-6, abs=5e-9)  # an independent regression of the same problem
    assert 1.1 < film() / least < 1.4


@settings(deadline=None)
@given(factor=st.floats(1.01, 5.0), position=st.floats(*RANGE), force=st.floats(100.0, 5000.0))
def test_films_grow_with_speed_and_viscosity_and_fall_weakly_with_load(
    factor: float, position: float, force: float
) -> None:
    base = film(position, force)
    assert film(position, force, viscosity_pa_s=0.115 * factor) > base
    faster, slower = ({"speed_1_rad_s": 188.5 * f, "speed_2_rad_s": 72.2 * f} for f in (factor, 1.0))
    assert film(position, force, **faster) > film(position, force, **slower)
    assert base * factor**-0.11 < film(position, force * factor) < base


@settings(deadline=None)
@given(factor=st.floats(1.01, 3.0))
def test_films_grow_with_the_relative_radius_at_the_same_speed(factor: float) -> None:
    groups = mesh().groups(PITCH_POINT, FORCE)
    wider = groups._replace(load=groups.load / factor, speed=groups.speed / factor, radius_m=groups.radius_m * factor)
    assert central_film_m(wider) > central_film_m(groups)


def test_films_stay_finite_without_load_and_vanish_at_standstill() -> None:
    assert np.isfinite(film(force=0.0))
    assert film(force=0.0) == film(force=0.5 * LOAD_FLOOR / 3.9e-5 * FORCE)
    assert 0.0 < central_film_m(mesh().groups(PITCH_POINT, FORCE)._replace(speed=0.0)) < 1e-9


def test_film_ratio_of_two_flanks() -> None:
    assert film_ratio(1.2e-6, np.hypot(0.3e-6, 0.4e-6)) == pytest.approx(2.4, rel=1e-12)
