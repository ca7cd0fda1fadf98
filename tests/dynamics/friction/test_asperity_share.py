from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from siggen.dynamics.friction.asperity_share import (
    RATIO_MODELS,
    gaussian_integral,
    simple_share,
)
from tests.dynamics.lubricated import FORCE, PITCH_POINT, RANGE, mesh, mixed_share

ROUGHNESS = np.array([0.2, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0, 5.0]) * 1e-6
MODELS = pytest.mark.parametrize("model", RATIO_MODELS)


def share(model: str, position: float = PITCH_POINT, force: float = FORCE, sigma: float = 0.57e-6, **other: float):
    return mixed_share(mesh(**other).groups(position, force, sigma), model)


def test_shares_of_rough_flanks_at_the_reference_point() -> None:
    values = 100.0 * mixed_share(mesh().groups(PITCH_POINT, FORCE, ROUGHNESS))
    # Published to a tenth of a percent (first two) and to a percent: half a digit either side.
    np.testing.assert_allclose(values[:2], [0.3, 8.9], atol=0.051)
    np.testing.assert_allclose(values[2:], [21, 31, 38, 52, 62, 75, 93], atol=0.51)


@MODELS
@settings(deadline=None)
@given(
    factor=st.floats(1.05, 4.0),
    position=st.floats(*RANGE),
    force=st.floats(1.0, 5000.0),
    sigma=st.floats(0.05e-6, 3e-6),
)
def test_shares_rise_with_roughness_and_fall_with_a_thicker_film(
    model: str, factor: float, position: float, force: float, sigma: float
) -> None:
    base = share(model, position, force, sigma)
    rougher = share(model, position, force, sigma * factor)
    thicker = share(model, position, force, sigma, viscosity_pa_s=0.115 * factor)
    assert 0.0 <= thicker <= base <= rougher <= 1.0
    if 1e-12 < base < 1.0:
        assert rougher > base > thicker


@MODELS
def test_shares_stay_between_nothing_and_all_at_the_limits(model: str) -> None:
    assert share(model, sigma=0.0) == pytest.approx(0.0, abs=1e-12)
    assert 0.0 <= share(model, force=0.0, sigma=5e-6) <= 1.0
    groups = mesh().groups(PITCH_POINT, FORCE, 2e-6)
    standstill = mixed_share(groups._replace(speed=0.0), model)
    assert mixed_share(groups, model) < standstill <= 1.0


def test_greenwood_and_tripp_follow_from_two_spheres_averaged_over_their_offset() -> None:
    # Two spheres of radius β, overlap ω, offset r: force (4/3) E* √(β/2) (ω - r²/(4β))^1.5.
    beta, overlap = 20e-6, 0.5e-6
    reach = np.sqrt(4.0 * beta * overlap)
    mean = quad(
        lambda r: 4.0 / 3.0 * np.sqrt(0.5 * beta) * (overlap - r * r / (4.0 * beta)) ** 1.5 * 2.0 * np.pi * r,
        0.0,
        reach,
    )[0]
    closed = 16.0 * np.sqrt(2.0) * np.pi / 15.0 * beta**1.5 * overlap**2.5
    assert mean == pytest.approx(closed, rel=1e-8)


@pytest.mark.parametrize("order", [0.0, 1.0, 1.5, 2.5])
@pytest.mark.parametrize("separation", [-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 5.0])
def test_gaussian_integrals_against_quadrature(order: float, separation: float) -> None:
    direct = quad(
        lambda x: (x - separation) ** order * np.exp(-0.5 * x * x) / np.sqrt(2.0 * np.pi), separation, separation + 14.0
    )[0]
    # quad's absolute tolerance is 1.5e-8; the values at 5 are about 1e-8.
    assert gaussian_integral(order, separation) == pytest.approx(direct, rel=1e-6, abs=1e-12)


def test_the_usual_fit_against_the_exact_integral() -> None:
    height = np.array([0.0, 1.0, 2.0, 3.0])
    # Published to two or three digits.
    np.testing.assert_allclose(gaussian_integral(2.5, height), [0.617, 0.0806, 5.4e-3, 1.7e-4], rtol=1e-2)
    assert gaussian_integral(2.5, 31.0) == 0.0


def test_the_simple_share_at_three_film_ratios() -> None:
    np.testing.assert_allclose(simple_share(np.array([0.5, 1.0, 2.0])), [0.39, 0.13, 0.009], rtol=0.03)
    assert simple_share(0.0) == 1.0
