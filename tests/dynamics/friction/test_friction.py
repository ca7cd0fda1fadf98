from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.mesh.asperities import asperity_table, mixed_contact
from siggen.mesh.friction import composite_friction, constant_friction, friction_coefficient
from tests.dynamics.lubricated import FORCE, PITCH_POINT, RANGE, mesh

ROUGHNESS = (0.57e-6, 2.04e-6, 5e-6)
COMPOSITE = composite_friction(asperity_table(mesh(), ROUGHNESS, RANGE, 2e4), 0.11)


@settings(deadline=None)
@given(layer=st.integers(0, 2), position=st.floats(*RANGE), force=st.floats(0.0, 1e5))
def test_the_composite_coefficient_stays_between_fluid_and_boundary(layer: int, position: float, force: float) -> None:
    fluid = mixed_contact(COMPOSITE.table, layer, position, force)[1]
    # Three operations round at 1e-16.
    assert fluid - 1e-15 <= friction_coefficient(COMPOSITE, layer, position, force) <= 0.11 + 1e-15


@settings(deadline=None)
@given(position=st.floats(*RANGE), force=st.floats(1.0, 1e4))
def test_a_rougher_flank_rubs_more(position: float, force: float) -> None:
    values = [friction_coefficient(COMPOSITE, layer, position, force) for layer in range(3)]
    assert values == sorted(values)


def test_a_fluid_friction_above_the_boundary_value_is_capped() -> None:
    table = COMPOSITE.table._replace(fluid=np.full_like(COMPOSITE.table.fluid, 5.0))
    assert friction_coefficient(composite_friction(table, 0.11), 0, PITCH_POINT, FORCE) == 0.11


def test_constant_friction_and_friction_off() -> None:
    law = constant_friction(0.05, layers=2)
    assert friction_coefficient(law, 1, PITCH_POINT + 5e-3, FORCE) == pytest.approx(0.05, rel=1e-12)
    assert friction_coefficient(constant_friction(0.0), 0, PITCH_POINT, FORCE) == 0.0
