"""The exponential integrator against fine Runge-Kutta, on gearboxes and damages drawn from every preset."""

from __future__ import annotations

from pathlib import Path
from random import Random

import numpy as np
import pytest
from hypothesis import Phase, event, given, settings
from hypothesis import strategies as st

import siggen
from siggen.columns.record import SimulatedRecord
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record
from siggen.record.drive import record_drive
from siggen.record.motion import specimen_motion
from siggen.record.specimen_state import SpecimenState, specimen_state
from siggen.record.step_choice import stepped_motion
from siggen.sets.drawn import set_columns
from siggen.sets.precision import record_error
from tests.simulated import simulate

CONFIGS = Path(__file__).parents[2] / "configs"
PRESETS = ("bench", "confusers", "families", "paper_b", "quickstart", "two_stage")
"""Those with the law pairs; `industrial` is `bench` with longer records."""
REFERENCE_STEPS = 64
WINDOW_S, STARTING_S = 0.04, 0.01
CHANNEL_S, CHANNEL_STEPS = 0.15, 32


def drawn_record(preset: str, number: int, duration_s: float = WINDOW_S) -> tuple[SetDesign, int]:
    """Return a preset and the id of one of its records, drawn by name and number."""
    config = siggen.load_config(CONFIGS / f"{preset}.yaml", [f"duration_s={duration_s}"])
    return config, Random(f"{preset} {number}").randrange(config.specimens * config.records_per_specimen)


def accelerations(
    config: SetDesign, record_id: int, state: SpecimenState, integrator: str, steps: int, stride: int = 1
) -> np.ndarray:
    """Return the accelerations (samples, motions) of a record from the static start, means over two samples."""
    record = planned_record(config, record_id)
    specimen = config.gearbox(record.specimen_id)
    point, driven = specimen.points[record.operating_point_id], record_drive(specimen, state.mesh.structure, record)
    rate_hz = config.fs_hz * steps
    law = specimen.law.by_reference() if integrator == "runge_kutta" else specimen.law
    motion = specimen_motion(law, state.mesh, point, 1.0 / rate_hz, driven, stride=stride)
    times = np.arange(round(WINDOW_S * rate_hz) + 1) / rate_hz
    pitches = driven.rotation.angle_rad(times) * motion.teeth / (2.0 * np.pi)
    inputs = np.zeros((times.size, motion.equations.external_input.shape[0]))
    if driven.excitation is not None:
        inputs = driven.excitation.inputs(times, driven.rotation)
    path = np.empty((times.size, 2 * len(motion.structure.coordinates)))
    path[0] = motion.start(pitches[0])
    motion.advance(pitches, inputs, path)
    motions = np.array(list(motion.structure.motions.values()))
    moved = path[::steps, : motions.shape[1]] @ motions.T
    return np.asarray(np.diff(moved, n=2, axis=0)[round(STARTING_S * config.fs_hz) :] * config.fs_hz**2)


def errors(preset: str, number: int) -> np.ndarray:
    """Return the relative rms error of every motion with the steps that the record takes."""
    config, record_id = drawn_record(preset, number)
    record = planned_record(config, record_id)
    specimen = config.gearbox(record.specimen_id)
    assert specimen.law.method == "exponential"
    state = specimen_state(specimen, record.state_id)
    point, driven = specimen.points[record.operating_point_id], record_drive(specimen, state.mesh.structure, record)
    steps, stride = stepped_motion(specimen.sampling, specimen.law, state.mesh, point, driven).grid
    fine = accelerations(config, record_id, state, "runge_kutta", REFERENCE_STEPS)
    fast = accelerations(config, record_id, state, "exponential", steps, stride)
    return np.asarray(np.sqrt(np.mean((fast - fine) ** 2, axis=0) / np.mean(fine**2, axis=0)))


@pytest.mark.parametrize("preset", PRESETS)
def test_a_random_record_of_every_preset_meets_the_stated_error(preset: str) -> None:
    assert np.median(errors(preset, 0)) <= 1e-3


def test_every_preset_that_takes_the_exponential_integrator_is_drawn_from() -> None:
    methods = {path.stem: siggen.load_config(path).config.dynamics.method for path in CONFIGS.glob("*.yaml")}
    # industrial is bench, fleet quickstart; helical and planetary have references of their own
    others = {"industrial", "fleet", "helical", "planetary"}
    assert {name for name, method in methods.items() if method == "exponential"} == {*PRESETS, *others}


@pytest.mark.slow
@pytest.mark.parametrize("preset", PRESETS)
@given(number=st.integers(0, 10**6))
@settings(max_examples=6, deadline=None, derandomize=False, database=None, phases=[Phase.generate])
def test_the_worst_delivered_channel_of_random_records_meets_the_tolerance(preset: str, number: int) -> None:
    config, record_id = drawn_record(preset, number, CHANNEL_S)
    error = channel_error(config, record_id)
    event(f"record {record_id}: {error:.1e}")
    assert 0.0 < error <= config.config.dynamics.integration_tolerance


@pytest.mark.slow
def test_the_worst_delivered_channel_of_the_hardest_record_of_quickstart_meets_its_tolerance() -> None:
    """Record 56 was the worst of 24 with one step per sample, 1.15e-3; what is promised is the worst channel."""
    config = siggen.load_config(CONFIGS / "quickstart.yaml", ["duration_s=0.5"])
    assert 0.0 < channel_error(config, 56) <= config.config.dynamics.integration_tolerance


def test_a_turn_of_sliding_that_vibration_moves_from_the_pitch_point_is_met_in_short_steps() -> None:
    """The spalled pair of record 106 turns behind the place of short steps; with whole ones the casing rings: 1.35e-3.

    Half of the tolerance: short steps leave a fifth of that.
    """
    config = siggen.load_config(CONFIGS / "paper_b.yaml", [f"duration_s={CHANNEL_S}"])
    assert 0.0 < channel_error(config, 106) <= 0.5 * config.config.dynamics.integration_tolerance


def channel_error(config: SetDesign, record_id: int) -> float:
    """Return the relative rms error of the worst channel as it reaches its converter."""
    unrounding = config.unrounded()
    delivered = delivered_channels(unrounding, record_id)
    fine = delivered_channels(unrounding.by_reference(CHANNEL_STEPS), record_id)
    return record_error(set_columns(config).channels, delivered, fine)


def delivered_channels(config: SetDesign, record_id: int) -> dict[str, np.ndarray]:
    """Return what reaches the converters in a record, by column."""
    (record,) = simulate(config, [record_id])
    assert isinstance(record, SimulatedRecord)
    return {f"accel_{name}_m_s2": samples for name, samples in record.channels.items()}
