"""Flanks that rattle, against scipy on the exported model: no code is shared, and its steps follow the impacts.

The shaft of the pinion is knocked, so that the teeth fly through the backlash and bounce on both flanks. An impact
makes small differences larger. So motions are compared over 5 ms, and later only what they are on the whole.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from siggen.arrays import FloatArray
from siggen.checks.loading import load_config
from siggen.config import by_reference
from siggen.gearbox.plan import planned_record
from siggen.motion.equations import no_inputs
from siggen.record.motion import specimen_motion
from siggen.record.specimen_state import specimen_state
from siggen.views.exported_model import exported_model
from tests.simulated import drawn_record
from tests.views.test_exported_model import PINION, ROOT, by_scipy, largest

RECORD, SAMPLES = 12, 256  # 5 ms
LONG = 16 * SAMPLES  # 80 ms
TIGHT = 1e-7
"""Tolerance of scipy's steps: with it scipy errs by at most 1.2e-4 of the motion, against 1e-8."""
KNOCKED_S = -0.1225
"""Before the record: a moment from which flanks meet ten times within 5 ms."""
TOUCHES_N = 1.0
KNOCKS = [(0.0, -0.3), (0.0, 0.5), (1.0, -0.3)]
"""Torque [N m], and approach of the flanks [m/s] by the knock: they turn at 2.5 m/s."""
ONE_FAST = [KNOCKS[0], *(pytest.param(*knock, marks=pytest.mark.slow) for knock in KNOCKS[1:])]
WITHIN = 0.02
"""Of shares and rms over 80 ms: one impact of fifty, which motions that have parted may have more or less."""


@cache
def knocked(torque_nm: float, knock_m_s: float, steps: int, samples: int = SAMPLES, reference: bool = False) -> tuple:
    """Return the exported model, and approach and mesh force (samples + 1,) by siggen, from the knock on."""
    torques = [f"operating_points.{k}.torque_nm={torque_nm}" for k in range(3)]
    overrides = ["duration_s=0.01", "dynamics.model=8dof", "housing={}", *PINION, *torques]
    config = load_config(ROOT / "tests/configs/casing.yaml", overrides)
    if reference:
        config = config.with_sections(dynamics=by_reference(config.config.dynamics, steps))
    model = {name: np.asarray(value)[()] for name, value in exported_model(*drawn_record(config, RECORD)).items()}
    model["start_s"] = KNOCKED_S
    model["start_state"] = after(model, knock_m_s)
    planned = planned_record(config, RECORD)
    specimen = config.gearbox(planned.specimen_id)
    mesh = specimen_state(specimen, planned.state_id).mesh
    point = config.drawn_points(planned.specimen_id)[planned.operating_point_id]
    motion = specimen_motion(specimen.law, mesh, point, 1.0 / (config.fs_hz * steps))
    times = model["start_s"] + np.arange(samples * steps + 1) / (config.fs_hz * steps)
    turned = model["start_angle_rad"] + 2.0 * np.pi * point.speed_hz * times
    pitches = turned * model["mesh.0.pitches_per_rad"] + model["mesh.0.begins_pitches"]
    states = np.empty((pitches.size, model["start_state"].size))
    states[0] = model["start_state"]
    motion.advance(pitches, no_inputs(pitches), states)
    inner = motion.internals(states[::steps], pitches[::steps], no_inputs(pitches[::steps]))
    return model, [inner[:, motion.internal_names.index(name)] for name in ("approach_m", "mesh_force_n")]


def after(model: dict, knock_m_s: float) -> FloatArray:
    """Return the start state with motor and pinion turning as one, so that flanks approach at a speed."""
    names = list(model["coordinates"])
    turning = np.isin(names, ["theta_motor", "theta_pinion"]).astype(float)
    return model["start_state"] + np.concatenate(
        [np.zeros(len(names)), knock_m_s / (model["mesh.0.vector"] @ turning) * turning]
    )


def impacts(force_n: FloatArray) -> list[int]:
    """Return the flank of every touch: 1 drive flanks, -1 back flanks."""
    flank = np.where(np.abs(force_n) > TOUCHES_N, np.sign(force_n), 0.0)
    begun = np.flatnonzero(np.diff(flank) != 0.0) + 1
    return [int(flank[k]) for k in begun if flank[k] != 0.0]


@pytest.mark.parametrize(("torque_nm", "knock_m_s"), ONE_FAST)
def test_scipy_gives_the_motion_of_flanks_that_bounce_within_the_backlash(torque_nm: float, knock_m_s: float) -> None:
    # Impacts multiply what steps leave: 16 per sample leave up to 1.9e-3, 32 and 64 up to 3e-4.
    model, own = knocked(torque_nm, knock_m_s, 32)
    met = impacts(own[1])
    assert len(met) >= 10
    assert {1, -1} == set(met)
    other = by_scipy(model, own, TIGHT)
    assert largest(own, other) < 1e-3
    # Two steps per sample, as presets take, err more in the force, whose impacts are four samples long.
    assert largest(knocked(torque_nm, knock_m_s, 2)[1][:1], other[:1]) < 1e-3
    # It would be seen: 2 % less backlash gives another motion.
    closer = model | {"mesh.0.law.backlash_m": 0.98 * model["mesh.0.law.backlash_m"]}
    assert largest(own, by_scipy(closer, own, 1e-5)) > 0.02


@pytest.mark.parametrize(("torque_nm", "knock_m_s"), ONE_FAST[:2])
def test_runge_kutta_bounces_as_scipy_does(torque_nm: float, knock_m_s: float) -> None:
    # First order at impacts, which make it larger: 64 steps per sample leave up to 9e-3.
    model, own = knocked(torque_nm, knock_m_s, 256, reference=True)
    assert largest(own, by_scipy(model, own, TIGHT)) < 1.5e-3


@pytest.mark.parametrize(("torque_nm", "knock_m_s"), ONE_FAST)
def test_later_flanks_are_apart_as_long_and_push_as_hard_as_by_scipy(torque_nm: float, knock_m_s: float) -> None:
    model, own = knocked(torque_nm, knock_m_s, 16, LONG)
    other = by_scipy(model, own, 1e-6)
    apart = [float((np.abs(force) < TOUCHES_N).mean()) for _, force in (own, other)]
    assert apart[0] == pytest.approx(apart[1], abs=WITHIN)
    assert own[1].std() == pytest.approx(other[1].std(), rel=WITHIN)
    assert own[0].std() == pytest.approx(other[0].std(), rel=WITHIN)
    assert 0.3 < apart[0] < 0.8  # it does bounce
