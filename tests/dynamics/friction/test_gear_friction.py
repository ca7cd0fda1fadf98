"""The mean friction of a mesh is that of measured gears, and so is its course over speed and load."""

from __future__ import annotations

import numpy as np
import pytest

from tests.reference.gear_friction import RUNNING, Running, name


def exponent(x: list[float], y: list[float]) -> float:
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


@pytest.mark.parametrize("running", RUNNING, ids=name)
def test_a_mesh_rubs_as_measured_gears_do(running: Running) -> None:
    """The two formulas are up to 1.4 apart from each other and scatter about their own tests by a quarter."""
    assert 0.65 <= running.mean / running.schlenk <= 1.4
    assert 0.65 <= running.mean / running.fernandes <= 1.4


def test_friction_falls_with_speed_and_rises_with_load_as_that_of_gears() -> None:
    """Schlenk's exponents are -0.2 and 0.2, Fernandes's -0.25 and 0.13."""
    speeds, torques = [5.0, 10.0, 20.0, 40.0], [6.0, 15.0, 30.0, 54.0]
    assert -0.3 <= exponent(speeds, [Running(speed, 40.0).mean for speed in speeds]) <= -0.15
    assert 0.05 <= exponent(torques, [Running(30.0, torque).mean for torque in torques]) <= 0.35
