from __future__ import annotations

from dataclasses import replace

import pytest

from tests.dynamics.friction.mesh_loss import loss_factor, mesh_power_loss
from tests.dynamics.lubricated import PAIR, SPEED_1
from tests.gears.builders import pair_18_47


def test_the_loss_at_a_friction_coefficient_of_five_percent() -> None:
    assert loss_factor(PAIR) == pytest.approx(0.171, abs=5e-4)
    # Published 48.4 W of 5.7 kW.
    assert mesh_power_loss(PAIR, 0.05, 30.0, SPEED_1) == pytest.approx(48.4, abs=0.06)


@pytest.mark.parametrize("shifts", [(0.0, 0.0), (0.3, -0.3), (0.2, 0.1)])
def test_quadrature_and_closed_form_agree(shifts: tuple[float, float]) -> None:
    pair = pair_18_47(module_m=3e-3, shifts=shifts)
    direct = mesh_power_loss(pair, 0.05, 30.0, SPEED_1)
    # One cell of 20001 may count the wrong number of pairs: 5e-5.
    assert direct == pytest.approx(0.05 * loss_factor(pair) * 30.0 * SPEED_1, rel=1e-4)


def test_the_closed_form_is_refused_outside_its_contact_ratios() -> None:
    usual = pair_18_47(module_m=3e-3)
    pinion, gear = (replace(member, addendum_coefficient=1.45) for member in (usual.pinion, usual.gear))
    long = replace(usual, pinion=pinion, gear=gear)
    assert long.contact_ratio > 2.0
    with pytest.raises(ValueError, match="1 to 2"):
        loss_factor(long)
