"""Records in blocks against one convolution over the whole record, and what they do not depend on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.signal import fftconvolve

import siggen.record.simulation as simulation
import siggen.sensing.filters as block_filter
from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.gearbox.background_numbers import BaseNumbers, BurstNumbers
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record
from siggen.record.instrument import specimen_instrument
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from siggen.sensing.filters import AHEAD
from siggen.sensing.inputs import MOTION
from tests.config.minimal import by_name, minimal
from tests.record.fixed_numbers import fix
from tests.simulated import simulate

LID = {"name": "lid", "place": "lid", "bits": None, "range_m_s2": 1e6, "cross_axis": 0.04, "high_pass_hz": 2.0,
       "mounting": {"frequency_hz": 9000.0, "damping_ratio": 0.05}}  # fmt: skip
PLAIN = {"name": "bearing", "bits": None, "range_m_s2": 1e6}
LINES: dict[str, Any] = {"base": {}, "shafts": {}, "second_stage": {"order": 4.13}}
ALL = {**LINES, "rubbing": {"bursts": {}}, "bearings": {}, "machines": {}}
VARYING = {"speed": {"random_rms": 0.005, "ripple_once": 0.001}, "torque": {"random_rms": 0.02}}


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Mounts that ring for a short time, and bursts in every record."""
    fix(monkeypatch, BaseNumbers, horizontal_hz=40.0, vertical_hz=40.0, rocking_hz=40.0)
    fix(monkeypatch, BurstNumbers, rate_hz=20.0)


def loaded(*sensors: dict[str, Any], **changes: Any) -> SetDesign:
    changes = {"dynamics__model": "casing", "duration_s": 0.4, "specimens": 2, "fs_hz": 25600.0, **changes}
    changes = {"variation": VARYING, **changes}
    return load_config(minimal(sensors=by_name(sensors or (LID, PLAIN)), **changes))


def record(config: SetDesign, record_id: int = 0) -> SimulatedRecord:
    result = simulate(config, [record_id])[0]
    assert isinstance(result, SimulatedRecord), result
    return result


def test_blocks_join_without_a_seam_to_one_convolution(monkeypatch: pytest.MonkeyPatch) -> None:
    """Motion and forces of the whole record, convolved with the impulse responses by scipy: no block, no overlap."""
    config = loaded(variation={}, duration_s=0.2)
    specimen, planned = config.gearbox(0), planned_record(config, 0)
    instrument = specimen_instrument(specimen)
    response, _ = record_response(specimen, specimen_state(specimen, 0), planned)
    before, grid = response.before, instrument.blocks.grid
    expected = np.zeros(config.samples)
    for one, spectrum in instrument.blocks.filters["lid_vertical"].items():
        named = "acceleration_m_s2" if one.kind == MOTION else "bearing_force_n"
        parts = [getattr(part, named)[one.name] for part in (response.history, response, response.after)]
        pulse = np.roll(np.fft.irfft(spectrum.astype(complex), grid.length), AHEAD)[: grid.memory]
        passed = fftconvolve(np.concatenate(parts) - parts[0].mean(), pulse)
        expected += passed[AHEAD + before :][: config.samples]
    for block in (block_filter.BLOCK_SAMPLES, 1500):
        monkeypatch.setattr(block_filter, "BLOCK_SAMPLES", block)
        found = record(config).channels["lid_vertical"].astype(float)
        assert np.abs(found - expected).max() < 3e-6 * expected.std()


def test_a_memory_four_times_as_long_changes_little(monkeypatch: pytest.MonkeyPatch) -> None:
    short = record(loaded(background=LINES))
    grid = block_filter.block_grid
    monkeypatch.setattr("siggen.record.instrument.block_grid", lambda history, samples: grid(4 * history, samples))
    long = record(loaded(background=LINES))
    for name, values in long.channels.items():
        error = short.channels[name].astype(float) - values
        # what rings longer than 0.4 s: e^-7 of the base, of the housing's modes
        assert error.std() < 1e-3 * values.astype(float).std()
    paths = [f"path_accelerance_{name}_m_s2_per_n" for name in long.channels]  # means over another grid of frequencies
    for path in paths:
        assert short.labels[path] == pytest.approx(long.labels[path], rel=1e-3)
    assert {**short.labels, **dict.fromkeys(paths)} == {**long.labels, **dict.fromkeys(paths)}


def test_a_motion_that_began_long_before_gives_the_same_record(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tenth of the integration's tolerance: what is left of the start in motion and filters together."""
    short = record(loaded(duration_s=0.1))
    least = simulation.both_settled_s
    monkeypatch.setattr(simulation, "both_settled_s", lambda *times: 0.5 + least(*times))
    long = record(loaded(duration_s=0.1))
    for name, values in long.channels.items():
        error = short.channels[name].astype(float) - values
        assert 0.0 < error.std() < 1e-4 * values.astype(float).std()


def test_a_record_in_blocks_depends_on_itself_alone() -> None:
    config = loaded(background=ALL, duration_s=0.2)
    together = simulate(config, [0, 1])
    with_internals = record(loaded(background=ALL, duration_s=0.2, internals={"quantities": ["all"]}))
    for found in (record(config), with_internals):
        assert isinstance(together[0], SimulatedRecord)
        for name, values in together[0].channels.items():
            assert found.channels[name].tobytes() == values.tobytes()
        assert {n: found.labels[n] for n in together[0].labels} == together[0].labels
