from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from siggen.mesh.lubrication import effective_modulus, entrainment_speed, hertz_pressure, relative_radius, sliding_speed
from tests.dynamics.lubricated import FORCE, LINE, MODULUS, PITCH_POINT, SPEED_1, SPEED_2


def test_the_pitch_point_rolls_without_sliding_at_the_published_speed_and_pressure() -> None:
    radius = relative_radius(PITCH_POINT, LINE)
    load = FORCE / 20e-3
    # Published to three digits.
    assert entrainment_speed(PITCH_POINT, LINE, SPEED_1, SPEED_2) == pytest.approx(1.74, rel=2e-3)
    assert radius == pytest.approx(6.68e-3, rel=1e-3)
    assert hertz_pressure(load, radius, MODULUS) == pytest.approx(0.565e9, rel=2e-3)
    # Two rolling speeds of 1.74 m/s cancel: rounding only.
    assert sliding_speed(PITCH_POINT, LINE, SPEED_1, SPEED_2, 0.0) == pytest.approx(0.0, abs=1e-14)


@settings(deadline=None)
@given(load=st.floats(1e2, 1e7), radius=st.floats(1e-4, 0.1))
def test_the_hertz_pressure_over_the_contact_width_carries_the_load(load: float, radius: float) -> None:
    peak = hertz_pressure(load, radius, MODULUS)
    half = np.sqrt(4.0 * load * radius / (pi * 0.5 * MODULUS))
    assert 0.5 * pi * peak * half == pytest.approx(load, rel=1e-12)
    carried = quad(lambda x: peak * np.sqrt(1.0 - x * x) * half, -1.0, 1.0)[0]
    # quad's own tolerance is 1.5e-8 of the result.
    assert carried == pytest.approx(load, rel=1e-7)


@settings(deadline=None)
@given(share=st.floats(0.01, 0.99))
def test_the_relative_radius_is_that_of_the_two_flanks_in_series(share: float) -> None:
    position = share * LINE
    assert relative_radius(position, LINE) == pytest.approx(1.0 / (1.0 / position + 1.0 / (LINE - position)), rel=1e-12)


def test_the_effective_modulus_of_steel() -> None:
    assert effective_modulus(206e9, 0.3) == pytest.approx(226e9, rel=2e-3)
