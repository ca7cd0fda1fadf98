"""Records whose speed and torque vary: labels, tacho, what is shared between states, what is drawn per record."""

from __future__ import annotations

import math

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.drivetrain.drive import Drive
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record
from siggen.record.drive import RecordDrive, record_drive
from siggen.record.structure import structure
from siggen.sets.drawn import simulated
from tests.simulated import simulate

SMALL = ["specimens=2", "duration_s=0.2", "dynamics.input_coupling.damping_nm_s_per_rad=2.0", "mesh_harmonics=3"]
VARYING = [
    "variation.speed.start_ratio=0.6", "variation.speed.end_ratio=1.4", "variation.speed.random_rms=0.003",
    "variation.speed.ripple_once=0.0005", "variation.speed.slip=0.03", "variation.torque.random_rms=0.03",
    "variation.torque.load_once=0.05", "variation.torque.line_ripple=0.01",
]  # fmt: skip
FORCES = ["dynamics.unbalance.grade_mm_s=6.3"]


def load(*overrides: str) -> SetDesign:
    return load_config("tests/configs/linear_pits.yaml", [*SMALL, *overrides])


def drive_of(config: SetDesign, record_id: int) -> RecordDrive:
    record = planned_record(config, record_id)
    specimen = config.gearbox(record.specimen_id)
    return record_drive(specimen, structure(specimen), record)


@pytest.fixture(scope="module")
def varying() -> SetDesign:
    return load(*VARYING, *FORCES)


@pytest.fixture(scope="module")
def record(varying: SetDesign) -> SimulatedRecord:
    (found,) = simulate(varying, [2])
    assert isinstance(found, SimulatedRecord)
    return found


def test_a_varying_record_is_a_function_of_configuration_and_index_alone(
    varying: SetDesign, record: SimulatedRecord
) -> None:
    again = list(simulated(varying, [0, 2]))[1]
    assert isinstance(again, SimulatedRecord)
    assert again.labels == record.labels
    assert all(np.array_equal(again.channels[name], record.channels[name]) for name in record.channels)


def test_labels_say_what_speed_and_torque_did(varying: SetDesign, record: SimulatedRecord) -> None:
    labels = record.labels
    slipping = 1.0 - 0.03 * labels["torque_nm"] / 60.0
    # The slow part of 0.3 % and the ripple move the mean of 0.2 s.
    assert labels["pinion_shaft_hz"] == pytest.approx(labels["speed_hz"] * slipping, rel=0.01)
    # A linear course from 0.6 to 1.4 has the standard deviation 0.8/√12.
    assert labels["speed_std_hz"] == pytest.approx(labels["speed_hz"] * slipping * 0.8 / math.sqrt(12.0), rel=0.02)
    drive = drive_of(varying, 2)
    assert drive.torque is not None
    acceleration = 2.0 * math.pi * 0.8 * labels["speed_hz"] * slipping / 0.2
    expected = labels["torque_nm"] + drive.torque.reduced_inertia_kg_m2 * acceleration
    assert labels["mean_torque_nm"] == pytest.approx(expected, rel=0.1)  # ± 3 % of slow torque, twice over
    assert 0.0 < labels["torque_std_nm"] < 0.2 * expected


def test_tacho_times_are_whole_turns_of_the_varying_angle(varying: SetDesign, record: SimulatedRecord) -> None:
    rotation = drive_of(varying, 2).rotation
    turns = rotation.angle_rad(record.tacho_s) / (2.0 * math.pi)
    assert np.abs(turns - np.round(turns)).max() < 1e-9
    assert len(record.tacho_s) >= 5
    assert np.diff(record.tacho_s, 2).max() < 0.0  # faster and faster


def test_states_share_the_numbers_but_not_the_course() -> None:
    config = load("variation.speed.random_rms=[0.001, 0.005]")
    points = len(config.config.operating_points) * config.repeats
    first, second = planned_record(config, 0), planned_record(config, points)
    assert (first.state_id, second.state_id) == (0, 1)
    point, again, of_another = (config.drawn_points(specimen)[0].variation for specimen in (0, 0, 1))
    assert point is not None
    assert point == again != of_another
    time = np.linspace(0.0, 0.2, 50)
    speeds = [drive_of(config, r.record_id).rotation.speed_rad_s(time) for r in (first, second)]
    assert np.abs(speeds[0] - speeds[1]).max() > 1e-4 * speeds[0].mean()


def test_unbalance_belongs_to_the_specimen() -> None:
    config = load(*FORCES)
    time = np.linspace(0.0, 0.1, 200)

    def inputs(record_id: int) -> np.ndarray:
        drive = drive_of(config, record_id)
        assert drive.excitation is not None
        return drive.excitation.inputs(time, Drive(point.speed_hz, 0.5))

    point = config.drawn_points(0)[0]
    first, second = inputs(0), inputs(config.repeats * len(config.config.operating_points))
    np.testing.assert_array_equal(first, second)
    mass = structure(config.gearbox(0)).mass[1, 1]
    expected = mass * 6.3e-3 * (2.0 * math.pi * point.speed_hz) ** 2 / (2.0 * math.pi * 50.0)
    assert np.hypot(first[:, 0], first[:, 1]) == pytest.approx(expected, rel=1e-9)
