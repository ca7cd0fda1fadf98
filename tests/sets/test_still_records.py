"""The floor of relative errors: gears that stand still have no error, and those that move have the one they had."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.config import parse
from siggen.gearbox.design import SetDesign
from siggen.sensors.quantity import STILL_M_S2
from siggen.sets.drawn import set_columns
from siggen.sets.precision import record_error
from tests.config.minimal import minimal


@pytest.mark.parametrize(("level_m_s2", "expected"), [(0.0, 1e-6), (1e-4, 1e-6), (10.0, 1e-10)])
def test_an_error_of_a_billionth_is_relative_to_the_noise_of_a_sensor_at_least(
    level_m_s2: float, expected: float
) -> None:
    config = parse(minimal()).config
    assert config is not None
    wanted = {channel.column: np.full(64, level_m_s2) for channel in set_columns(SetDesign(config)).channels}
    found = {name: values + 1e-6 * STILL_M_S2 for name, values in wanted.items()}
    assert record_error(set_columns(SetDesign(config)).channels, found, wanted) == pytest.approx(expected, rel=1e-5)
