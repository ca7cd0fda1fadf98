"""Records of helical teeth: what force washers and accelerometers see along the shafts."""

from __future__ import annotations

from math import cos, radians, tan
from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from tests.config.minimal import by_name, minimal
from tests.simulated import simulate

AXIAL = [
    {"name": "accel", "place": "gear_bearing", "axes": ["axial"], "bits": None},
    {"kind": "bearing_force", "name": "thrust", "axes": ["axial", "vertical"], "range_n": 1e5, "bits": None},
]
HELIX_DEG = 15.0


def helical(helix_deg: float = HELIX_DEG, **changes: Any) -> SetDesign:
    dynamics = {"model": "8dof", "mesh": {"law": "linear"}}
    own = minimal(
        states={"healthy": {}},
        sensors=by_name(AXIAL),
        dynamics=dynamics,
        duration_s=0.2,
        gears__helix_deg=helix_deg,
    )
    return load_config(own | changes)


def test_the_thrust_is_that_of_the_torque_and_swings_with_the_mesh() -> None:
    """By hand: torque over pitch radius times tan β."""
    (found,) = simulate(helical(), [0])
    assert isinstance(found, SimulatedRecord)
    channels = {name: np.asarray(values, dtype=np.float64) for name, values in found.channels.items()}
    radius_m = 0.5 * 18 * 3e-3 / cos(radians(HELIX_DEG))
    expected_n = 60.0 / radius_m * tan(radians(HELIX_DEG))
    assert channels["thrust_axial"].mean() == pytest.approx(expected_n, rel=1e-6)  # mesh lines are whole turns in 0.2 s
    assert channels["accel_axial"].std() > 0.1


def test_what_is_along_the_shafts_is_refused_where_nothing_pushes_or_moves_there() -> None:
    with pytest.raises(ConfigError) as refused:
        helical(0.0)
    assert "sensors.accel.axes" in str(refused.value)
    assert "sensors.thrust.axes" in str(refused.value)
    rigid = {"kind": "rigid", "mass_kg": 20.0, "inertia_kg_m2": 0.25, "bolts": {"positions_mm": [[90, 0], [-90, 0]]}}
    with pytest.raises(ConfigError) as refused:  # a rigid casing does not move along the shafts, but bears the force
        helical(dynamics={"model": "casing"}, housing=rigid)
    assert "sensors.accel.axes" in str(refused.value)
    assert "sensors.thrust" not in str(refused.value)
