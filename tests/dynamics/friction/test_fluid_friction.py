from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.dynamics.friction.asperity_table import asperity_table, mixed_contact
from siggen.dynamics.friction.fluid_friction import FLUID_FRICTION_MODELS, fluid_friction
from siggen.dynamics.friction.friction import composite_friction, constant_friction, friction_coefficient
from tests.dynamics.friction.mesh_loss import mesh_mean_friction, schlenk_mean_friction
from tests.dynamics.lubricated import FORCE, PAIR, PITCH_POINT, RANGE, SPEED_1, mesh

ROUGHNESS = (0.57e-6, 5e-6)
MODELS = pytest.mark.parametrize("name", FLUID_FRICTION_MODELS)
LAWS = {
    name: composite_friction(asperity_table(mesh(), ROUGHNESS, fluid_friction(name, mesh(), ROUGHNESS[0]), RANGE, 2e4))
    for name in FLUID_FRICTION_MODELS
}
SCHLENK = schlenk_mean_friction(
    FORCE / 20e-3, SPEED_1 * PAIR.pinion.pitch_radius_m, PAIR.working_pressure_angle_rad, 6.68e-3, 0.115, 0.57e-6
)


@MODELS
@settings(deadline=None)
@given(layer=st.integers(0, 1), position=st.floats(*RANGE), force=st.floats(0.0, 1e5))
def test_no_model_explodes_in_a_pit(name: str, layer: int, position: float, force: float) -> None:
    # Rounding only; on the healthy flank and on one of 5 µm.
    assert 0.0 <= friction_coefficient(LAWS[name], layer, position, force) <= 0.11 + 1e-15


@pytest.mark.parametrize("name", ["eyring", "xu_kahraman"])
def test_fluid_friction_is_least_at_the_pitch_point_where_nothing_slides(name: str) -> None:
    position = np.linspace(*RANGE, 301)
    values = np.array([mixed_contact(LAWS[name].table, 0, s, FORCE)[1] for s in position])
    # One cell of the table, 0.24 mm, around the pitch point.
    assert position[values.argmin()] == pytest.approx(PITCH_POINT, abs=0.24e-3)
    assert values.min() < 0.3 * values.max()


def test_the_default_mean_over_the_mesh_lies_near_the_formula_for_it() -> None:
    mean = mesh_mean_friction(PAIR, LAWS["constant"], 30.0)
    # Schlenk's 0.034 against a prototype's 0.043; here 0.041.
    assert mean == pytest.approx(0.041, abs=0.002)
    assert pytest.approx(0.034, abs=0.001) == SCHLENK


def test_the_mean_of_one_coefficient_is_that_coefficient() -> None:
    assert mesh_mean_friction(PAIR, constant_friction(0.05), 30.0) == pytest.approx(0.05, rel=1e-12)


def test_rough_flanks_and_unknown_models_are_refused_before_any_table() -> None:
    with pytest.raises(ValueError, match="Xu-Kahraman"):
        fluid_friction("xu_kahraman", mesh(), 2e-6)
    with pytest.raises(ValueError, match="Benedict-Kelley"):
        fluid_friction("benedict_kelley", mesh(), 2e-6)
    with pytest.raises(ValueError, match="eyring"):
        fluid_friction("buckingham", mesh(), 0.5e-6)
