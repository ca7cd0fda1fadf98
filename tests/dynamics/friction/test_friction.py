from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.dynamics.friction.asperity_table import asperity_table
from siggen.dynamics.friction.contact_kinematics import sliding_speed
from siggen.dynamics.friction.friction import (
    composite_friction,
    constant_friction,
    friction_coefficient,
    friction_force,
)
from tests.dynamics.lubricated import FORCE, LINE, PITCH_POINT, RANGE, SPEED_1, SPEED_2, mesh

ROUGHNESS = (0.57e-6, 2.04e-6, 5e-6)
COMPOSITE = composite_friction(asperity_table(mesh(), ROUGHNESS, 0.02, RANGE, 2e4))


@settings(deadline=None)
@given(layer=st.integers(0, 2), position=st.floats(*RANGE), force=st.floats(0.0, 1e5))
def test_the_composite_coefficient_stays_between_fluid_and_boundary(layer: int, position: float, force: float) -> None:
    # Three operations round at 1e-16.
    assert 0.02 - 1e-15 <= friction_coefficient(COMPOSITE, layer, position, force) <= 0.11 + 1e-15


@settings(deadline=None)
@given(position=st.floats(*RANGE), force=st.floats(1.0, 1e4))
def test_a_rougher_flank_rubs_more(position: float, force: float) -> None:
    values = [friction_coefficient(COMPOSITE, layer, position, force) for layer in range(3)]
    assert values == sorted(values)


def test_a_fluid_friction_above_the_boundary_value_is_capped() -> None:
    law = composite_friction(asperity_table(mesh(), [0.57e-6], 5.0, RANGE, 2e4))
    assert friction_coefficient(law, 0, PITCH_POINT, FORCE) == 0.11


@settings(deadline=None)
@given(
    layer=st.integers(0, 2),
    position=st.floats(*RANGE),
    force=st.floats(-1e4, 1e4),
    whirl=st.floats(-5.0, 5.0),
    lateral=st.floats(-0.2, 0.2),
)
def test_friction_never_feeds_power_into_the_gears(
    layer: int, position: float, force: float, whirl: float, lateral: float
) -> None:
    slide = sliding_speed(position, LINE, SPEED_1 + whirl, SPEED_2, lateral)
    value = friction_force(COMPOSITE, layer, position, force, slide)
    assert value * slide >= 0.0
    assert abs(value) <= 0.11 * max(force, 0.0) * (1.0 + 1e-12)
    if force <= 0.0:
        assert value == 0.0


def test_constant_friction_and_friction_off() -> None:
    law = constant_friction(0.05, layers=2)
    assert friction_force(law, 1, PITCH_POINT + 5e-3, FORCE, 1.0) == pytest.approx(0.05 * FORCE, rel=1e-12)
    assert friction_force(law, 0, PITCH_POINT, FORCE, 0.02) == pytest.approx(0.05 * FORCE * np.tanh(1.0), rel=1e-12)
    assert friction_force(constant_friction(0.0), 0, PITCH_POINT, FORCE, 1.0) == 0.0


@pytest.mark.parametrize(("coefficient", "speed"), [(-0.1, 0.02), (1.5, 0.02), (np.nan, 0.02), (0.05, 0.0)])
def test_impossible_laws_are_refused(coefficient: float, speed: float) -> None:
    with pytest.raises(ValueError, match="allowed"):
        constant_friction(coefficient, speed)
