from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.dynamics.friction.contact_kinematics import relative_radius
from siggen.dynamics.friction.friction_coefficient import (
    benedict_kelley_friction,
    eyring_friction,
    xu_kahraman_friction,
)
from tests.dynamics.friction.mesh_loss import schlenk_mean_friction
from tests.dynamics.lubricated import FORCE, LINE, PAIR, PITCH_POINT, SPEED_1

RADIUS = relative_radius(PITCH_POINT, LINE)


def test_xu_and_kahraman_at_three_roughness_values() -> None:
    values = [xu_kahraman_friction(0.17, 0.565e9, 1.74, 0.115, RADIUS, s * 1e-6) for s in (0.1, 0.3, 0.6)]
    # Published to three decimals; 0.0526 was printed as 0.052.
    np.testing.assert_allclose(values, [0.052, 0.061, 0.081], atol=1.1e-3)


@pytest.mark.parametrize("roughness", [0.61e-6, 2e-6, -1e-7, float("nan")])
def test_xu_and_kahraman_are_refused_on_pitted_flanks(roughness: float) -> None:
    with pytest.raises(ValueError, match="composite friction law"):
        xu_kahraman_friction(0.17, 0.565e9, 1.74, 0.115, RADIUS, roughness)


def test_xu_and_kahraman_vanish_at_the_pitch_point() -> None:
    assert 0.0 < xu_kahraman_friction(0.0, 0.565e9, 1.74, 0.115, RADIUS, 0.3e-6) < 1e-10


def test_benedict_and_kelley_at_three_roughness_values() -> None:
    values = [benedict_kelley_friction(FORCE / 20e-3, 0.3, 3.48, 0.115, s * 1e-6, largest=1.0) for s in (0.2, 0.4, 0.6)]
    np.testing.assert_allclose(values, [0.056, 0.071, 0.098], atol=5.1e-4)


def test_the_metric_constant_of_benedict_and_kelley_follows_from_the_imperial_one() -> None:
    # μ0 V_s V_T²/w in cP, in/s, lbf/in; 1 m/s = 39.37 in/s, 1 N/mm = 5.7101 lbf/in.
    metric = 3.17e8 * 5.7101 / 39.3701**3
    assert metric == pytest.approx(29660, rel=1e-3)


@settings(deadline=None)
@given(slide=st.floats(0.0, 50.0), load=st.floats(1.0, 1e7), roughness=st.floats(0.0, 0.8e-6))
def test_benedict_and_kelley_stay_capped(slide: float, load: float, roughness: float) -> None:
    assert 0.0 <= benedict_kelley_friction(load, slide, 3.5, 0.115, roughness) <= 0.11


def test_benedict_and_kelley_are_refused_near_their_singularity() -> None:
    with pytest.raises(ValueError, match="composite friction law"):
        benedict_kelley_friction(5e4, 0.3, 3.48, 0.115, 1.1e-6)


@settings(deadline=None)
@given(slide=st.floats(-20.0, 20.0), film=st.floats(1e-8, 1e-5), pressure=st.floats(1e8, 2e9))
def test_eyring_friction_is_bounded_and_even_in_the_sliding_speed(slide: float, film: float, pressure: float) -> None:
    value = eyring_friction(slide, film, pressure, 0.112, 2.2e-8)
    assert 0.0 <= value <= 0.07
    assert value == eyring_friction(-slide, film, pressure, 0.112, 2.2e-8)
    assert eyring_friction(slide, 2.0 * film, pressure, 0.112, 2.2e-8) <= value


def test_eyring_friction_is_newtonian_at_small_speeds() -> None:
    slow = eyring_friction(1e-6, 1e-6, 0.5e9, 0.112, 2.2e-8)
    # asinh(x) = x - x³/6 with x = 3e-5 and less: linear to rounding.
    assert eyring_friction(2e-6, 1e-6, 0.5e9, 0.112, 2.2e-8) == pytest.approx(2.0 * slow, rel=1e-6)


def test_the_mean_friction_by_schlenk() -> None:
    speed = SPEED_1 * PAIR.pinion.pitch_radius_m
    angle = PAIR.working_pressure_angle_rad
    values = [schlenk_mean_friction(FORCE / 20e-3, speed, angle, RADIUS, 0.115, r * 1e-6) for r in (0.4, 0.57)]
    np.testing.assert_allclose(values, [0.031, 0.034], atol=5.1e-4)
