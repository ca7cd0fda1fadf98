from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.dynamics.friction.oil import MINERAL_OILS

VG220 = MINERAL_OILS["ISO VG 220"]


def test_vg_220_has_its_published_viscosities() -> None:
    values = [VG220.kinematic_viscosity_m2_s(t) * 1e6 for t in (40.0, 50.0, 60.0, 80.0)]
    # Published as whole numbers.
    np.testing.assert_allclose(values, [218, 126, 78, 35], atol=0.5)
    assert VG220.viscosity_pa_s(50.0) == pytest.approx(0.112, abs=5e-4)
    assert MINERAL_OILS["ISO VG 68"].kinematic_viscosity_m2_s(50.0) == pytest.approx(42e-6, abs=5e-7)


@pytest.mark.parametrize("name", MINERAL_OILS)
def test_every_grade_is_within_the_ten_percent_of_its_definition(name: str) -> None:
    grade = float(name.removeprefix("ISO VG "))
    assert MINERAL_OILS[name].kinematic_viscosity_m2_s(40.0) * 1e6 == pytest.approx(grade, rel=0.1)


@given(low=st.floats(-20.0, 149.0), step=st.floats(0.1, 1.0))
def test_oil_gets_thinner_and_lighter_with_temperature(low: float, step: float) -> None:
    assert VG220.viscosity_pa_s(low + step) < VG220.viscosity_pa_s(low)
    assert VG220.density_kg_per_m3(low + step) < VG220.density_kg_per_m3(low)


def test_the_pressure_viscosity_coefficient_is_that_of_mineral_oils() -> None:
    # Measured mineral gear oils lie between 1.5e-8 and 2.5e-8 1/Pa at 40 to 60 °C.
    assert 1.5e-8 < VG220.pressure_viscosity_per_pa(50.0) < 2.5e-8


@given(temperature_c=st.floats(-15.0, 145.0))
def test_the_slope_of_the_viscosity_is_that_of_its_law(temperature_c: float) -> None:
    above, below = (VG220.viscosity_pa_s(temperature_c + step) for step in (0.01, -0.01))
    # Central difference over 0.02 K: an error of 1e-8 of the slope, and rounding.
    assert VG220.viscosity_fall_per_k(temperature_c) == pytest.approx(np.log(below / above) / 0.02, rel=1e-6)


def test_an_impossible_temperature_is_refused() -> None:
    with pytest.raises(ValueError, match="-20 to 150"):
        VG220.viscosity_pa_s(400.0)
