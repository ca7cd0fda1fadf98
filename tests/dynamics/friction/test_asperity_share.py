from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.mesh.asperities import share_at
from siggen.mesh.lubrication import asperity_load_share
from tests.dynamics.lubricated import FORCE, PITCH_POINT, RANGE, mesh


def test_the_share_is_near_that_of_an_independent_law_for_gears() -> None:
    """Doleschel's (1 - λ/2)², λ the film over the mean Ra of Gaussian flanks; two regressions 0.11 apart (measured)."""
    ratio = np.linspace(0.0, 2.0, 201)
    film_over_ra = ratio * np.sqrt(2.0) * np.sqrt(0.5 * np.pi)
    doleschel = np.square(np.maximum(1.0 - 0.5 * film_over_ra, 0.0))
    assert np.abs(asperity_load_share(ratio) - doleschel).max() < 0.13


def test_asperities_carry_all_without_a_film_and_nothing_in_a_full_one() -> None:
    assert asperity_load_share(0.0) == 1.0
    assert (asperity_load_share(np.array([2.0, 5.0, 50.0])) == 0.0).all()
    assert asperity_load_share(np.nextafter(2.0, 0.0)) < 5e-4  # no step where the film is full


@settings(deadline=None)
@given(low=st.floats(1e-6, 1.9), more=st.floats(1.01, 10.0))
def test_the_share_falls_with_the_film_ratio(low: float, more: float) -> None:
    assert 0.0 <= asperity_load_share(low * more) < asperity_load_share(low) < 1.0


@settings(deadline=None)
@given(
    factor=st.floats(1.05, 4.0),
    position=st.floats(*RANGE),
    force=st.floats(1.0, 5000.0),
    sigma=st.floats(0.05e-6, 3e-6),
)
def test_shares_rise_with_roughness_and_fall_with_a_thicker_film(
    factor: float, position: float, force: float, sigma: float
) -> None:
    base = float(share_at(mesh(), sigma, position, force))
    assert float(share_at(mesh(viscosity_pa_s=0.115 * factor), sigma, position, force)) <= base
    assert base <= float(share_at(mesh(), sigma * factor, position, force))


def test_flanks_without_roughness_touch_on_oil_alone() -> None:
    assert float(share_at(mesh(), 0.0, PITCH_POINT, FORCE)) == pytest.approx(0.0, abs=1e-12)
