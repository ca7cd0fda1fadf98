from __future__ import annotations

import numpy as np
import pytest

from siggen.mesh.oil import MINERAL_OILS

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


def test_an_impossible_temperature_is_refused() -> None:
    with pytest.raises(ValueError, match="-20 to 150"):
        VG220.viscosity_pa_s(400.0)
