"""Records of several meshes begin settled: a motion that starts earlier gives the same signals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.gearbox.design import SetDesign
from siggen.record import simulation
from tests.config.planets import planets
from tests.record.test_two_stages import WITHOUT_FRICTION, two_stages
from tests.simulated import simulate

EARLIER_S = 0.3
SHORT = "duration_s=0.1"
FINER = (*WITHOUT_FRICTION, "dynamics.integration_tolerance=1e-4")


def planetary() -> dict[str, Any]:
    """Return a set whose couplings ring for long, with friction and pins out of place."""
    dynamics = {**planets()["dynamics"], "friction": {"model": "mixed_ehl"}}
    soft = {"stiffness_nm_per_rad": 6300.0, "damping_nm_s_per_rad": 0.1}
    return planets(
        dynamics={**dynamics, "input_coupling": soft},
        planetary={"ring_teeth": 77, "pin_error_um": 15.0},
        states={"healthy": {}},
    )


def signals(config: SetDesign) -> dict[str, Any]:
    (record,) = simulate(config, [0])
    assert isinstance(record, SimulatedRecord)
    return dict(record.channels)


# A tenth of what steps may err by.
@pytest.mark.parametrize(("raw", "more", "bound"), [(planetary, (), 1e-4), (two_stages, FINER, 1e-5)])
def test_a_motion_that_starts_earlier_gives_the_same_record(
    raw: Callable[[], dict[str, Any]], more: Sequence[str], bound: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    quiet = [f"sensors.{name}.{key}=null" for name in raw()["sensors"] for key in ("bits", "noise")]
    config = load_config(raw(), [SHORT, *quiet, *more])
    found, settle_s = signals(config), simulation._settle_s
    monkeypatch.setattr(simulation, "_settle_s", lambda *given: settle_s(*given) + EARLIER_S)
    for name, expected in signals(config).items():
        apart = found[name].astype(float) - expected
        assert np.sqrt((apart**2).mean()) < bound * expected.astype(float).std(), name
