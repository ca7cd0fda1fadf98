"""A converter as fine as the noise asks for: how little it adds, and that its step tells nothing about a record."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord, record_schema
from siggen.gearbox.configured import state_config
from siggen.gearbox.design import SetDesign
from siggen.sensing.measurement import Recorder
from siggen.sensors.converter import MOST_BITS, bits_of_noise
from siggen.sets.drawn import set_columns
from tests.config.minimal import by_name, minimal
from tests.simulated import simulate

FLOOR = {"log": [0.003, 0.01]}
STEP = 2.0**-11
"""The largest power of two within a fifth of 0.003."""


def config(**sensor: Any) -> SetDesign:
    bearing = {"name": "bearing", "bits": "noise", "noise": {"floor_m_s2": FLOOR}, **sensor}
    dynamics = {"model": "8dof", "mesh": {"law": "linear"}, "friction": {"model": "off"}}
    states = [
        {"name": "healthy"},
        {"name": "loud", "fault": "sensor", "severity": "slight", "changes": {"sensors.bearing.noise.floor_m_s2": 2.0}},
    ]
    short = {"specimens": 2, "duration_s": 0.05, "fs_hz": 20480.0, "mesh_harmonics": 3}
    return load_config(minimal(dynamics=dynamics, states=by_name(states), sensors=by_name([bearing]), **short))


def step_of(signal: np.ndarray) -> float:
    """Return the largest step of which all samples are whole multiples, in units that any step of a test divides."""
    unit = 2.0**-20
    codes = signal.astype(np.float64) / unit
    assert np.array_equal(codes, np.round(codes))
    return float(unit * np.gcd.reduce(codes.astype(np.int64)))


@given(limit=st.floats(1.0, 1e4), floor=st.floats(1e-6, 1e3))
def test_the_bits_are_the_fewest_whose_step_is_a_fifth_of_the_noise(limit: float, floor: float) -> None:
    bits = bits_of_noise(limit, floor)
    assert 4 <= bits <= MOST_BITS
    steps = 5.0 * 2.0 ** np.ceil(np.log2(2.0 * limit / 2.0 ** np.array([bits - 1, bits])))
    assert steps[1] <= floor or bits == MOST_BITS
    assert steps[0] > floor or bits == 4


def test_its_step_adds_a_300th_of_the_noise_power() -> None:
    floor, samples = 0.003, 200_000
    signal = np.random.default_rng(3).uniform(-20.0, 20.0, samples).astype(np.float32)
    recorder = Recorder(samples, 1.0)
    recorder.take(signal.astype(np.float64))
    bits = bits_of_noise(500.0, floor)
    recorder.begin_conversion(limit=500.0, bits=bits, rng=np.random.default_rng(4), noise_floor=floor)
    recorder.convert(samples, None)
    noisy = signal.astype(np.float64) + floor * np.random.default_rng(4).standard_normal(samples)
    error = recorder.measurement().values - noisy
    # a variance of 200,000 uniform errors has a standard error of 0.2 %
    assert abs(error.var() / (STEP**2 / 12.0) - 1.0) < 0.01
    assert error.var() < floor**2 / 300.0
    assert abs(np.corrcoef(error, noisy)[0, 1]) < 0.01


def test_every_record_of_a_set_has_one_step_whatever_its_state_does_to_the_noise() -> None:
    own = config(gain=[0.5, 2.0])
    records = simulate(own, range(4))
    assert {step_of(one.channels["bearing_vertical"]) for one in records if isinstance(one, SimulatedRecord)} == {STEP}
    assert (
        len({one.labels["noise_floor_bearing_vertical_m_s2"] for one in records if isinstance(one, SimulatedRecord)})
        == 3
    )
    assert {state_config(own.config, 1, state).sensors[0].converter_step for state in (0, 1)} == {STEP}
    assert (
        float(record_schema(set_columns(own)).field("accel_bearing_vertical_m_s2").metadata[b"converter_step"]) == STEP
    )


def test_the_step_is_part_of_the_identity() -> None:
    assert len({config(**own).identity for own in ({}, {"bits": 21}, {"noise": {"floor_m_s2": 0.02}})}) == 3
    signals = [simulate(config(**own), [0])[0] for own in ({}, {"bits": 21})]
    first, second = (one.channels["bearing_vertical"].tobytes() for one in signals if isinstance(one, SimulatedRecord))
    assert first == second
