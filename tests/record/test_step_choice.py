"""Steps of a record: the rule follows its own operating point, a stretch refines them, and the error left is told."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, inf
from pathlib import Path

import numpy as np
import pytest

import siggen
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record, record_ids_of
from siggen.motion.motion import DECAY_TIMES, TRANSIENT_CAP_S, forgotten
from siggen.motion.response import SampleGrid, Wanted, response_of
from siggen.record import step_choice
from siggen.record.drive import RecordDrive, record_drive
from siggen.record.motion import specimen_motion
from siggen.record.specimen_state import specimen_state
from siggen.record.step_choice import MARGIN, MOST_STEPS, START_SHARE, Stepped, refined_steps, rule_grid, stepped_motion
from tests.simulated import simulate

QUICKSTART = Path(__file__).parents[2] / "configs" / "quickstart.yaml"
FINE_STEPS, RECORD = 64, 3


def loaded(*overrides: str) -> SetDesign:
    """Return quickstart, short, with some overrides."""
    return siggen.load_config(QUICKSTART, ["duration_s=0.1", "specimens=1", *overrides])


def steps_of(config: SetDesign) -> int:
    """Return the steps of the rule for the first operating point of the first gearbox."""
    specimen = config.gearbox(0)
    mesh = specimen_state(specimen, 0).mesh
    return rule_grid(config.fs_hz, specimen.law, mesh, specimen.points[0]).steps


def chosen_steps(config: SetDesign, number: int = 0) -> tuple[SetDesign, Stepped, RecordDrive]:
    """Return a configuration with how a record of one of its gearboxes is stepped and driven."""
    record = planned_record(config, record_ids_of(config, number)[RECORD])
    specimen = config.gearbox(number)
    mesh = specimen_state(specimen, record.state_id).mesh
    point, driven = specimen.points[record.operating_point_id], record_drive(specimen, mesh.structure, record)
    return config, stepped_motion(specimen.sampling, specimen.law, mesh, point, driven), driven


def largest_error(found: Mapping[str, np.ndarray], wanted: Mapping[str, np.ndarray]) -> float:
    return max(float(np.sqrt(np.mean((found[n] - wanted[n]) ** 2) / np.mean(wanted[n] ** 2))) for n in wanted)


@pytest.mark.parametrize(
    ("error", "expected"),
    [(0.5, (3, 0.5)), (3.0, (6, 0.75)), (30.0, (17, 30.0 * (3 / 17) ** 2)), (0.0, (3, 0.0))],
)
def test_steps_are_refined_by_the_square_of_the_step_until_the_error_is_allowed(error, expected) -> None:
    steps, left = refined_steps(lambda tried: error * (3 / tried) ** 2, 3, 1.0)
    assert (steps, left) == pytest.approx(expected)


def test_a_motion_that_comes_no_nearer_keeps_its_steps_and_tells_its_largest_error() -> None:
    found = {2: 1.3, 4: 1.7, 8: 0.9}
    assert refined_steps(found.__getitem__, 2, 1e-3) == (2, 1.7)
    assert refined_steps(lambda _: inf, 2, 1e-3) == (2, inf)


def test_the_finest_steps_tell_an_error_that_is_still_too_large() -> None:
    steps, error = refined_steps(lambda tried: 1e3 / tried**2, 2, 1e-3)
    assert steps == MOST_STEPS
    assert error == 1e3 / MOST_STEPS**2


def test_another_operating_point_changes_no_steps() -> None:
    point = "{speed_hz: 33, torque_nm: 30}"
    alone = steps_of(loaded(f"operating_points=[{point}]"))
    assert steps_of(loaded(f"operating_points=[{point}, {{speed_hz: 37, torque_nm: 60}}]")) == alone


def test_slow_gears_without_friction_take_steps_of_1_4_rad_of_the_teeth_s_vibration() -> None:
    """A hundredth of the tolerance asks for a tenth of the step. The vibration is found by general eigenvalues.

    Gears that tilt have faster modes, to which the mesh contributes nothing.
    """
    slow = ["operating_points=[{speed_hz: 5, torque_nm: 60}]", "dynamics.friction.model=off", "dynamics.shafts=null"]
    config = loaded(*slow, "dynamics.integration_tolerance=1e-5")
    mesh = specimen_state(config.gearbox(0), 0).mesh
    structure, tables = mesh.structure, mesh.every[0].mesh.tables
    pairs = (tables.end_m - tables.start_m) / tables.base_pitch_m
    teeth = pairs * tables.pair_stiffness_n_per_m.max(axis=0).mean()
    stiffness = structure.stiffness + teeth * np.outer(structure.mesh.vector, structure.mesh.vector)
    fastest = np.sqrt(np.linalg.eigvals(np.linalg.solve(structure.mass, stiffness)).real.max())
    assert steps_of(config) == ceil(10.0 * fastest / 1.4 / config.fs_hz)


def test_friction_that_stops_light_gears_at_once_takes_more_steps() -> None:
    light = ["dynamics.pinion.mass_kg=0.05", "operating_points=[{speed_hz: 5, torque_nm: 60}]"]
    assert steps_of(loaded(*light)) > steps_of(loaded(*light, "dynamics.friction.model=off"))


FAST, SLOW = "operating_points=[{speed_hz: 35, torque_nm: 40}]", "operating_points=[{speed_hz: 3, torque_nm: 1.5}]"
FLANKS = (
    "dynamics.friction.oil_temperature_c=[40, 60]", "dynamics.mesh.tip_relief_pitches=0.25",
    "manufacture.crowning_um=[0, 4]",
)  # fmt: skip
"""Of one narrow family. With all that quickstart draws, the start of one in eight errs by 1.1 times its label."""


def start_error(chosen: Stepped, driven: RecordDrive, config: SetDesign) -> float:
    """Return by how much accelerations change where the record starts nine decay times before it does."""
    motion, grid = chosen.motion, SampleGrid(config.fs_hz, config.samples, chosen.grid.per_sample)
    found, wanted = (
        response_of(
            motion, driven.rotation, grid, wanted=Wanted(bearing_forces=False), excitation=driven.excitation,
            settle_s=motion.transient_s + decays * motion.decay_s,
        ).acceleration_m_s2
        for decays in (0.0, DECAY_TIMES)
    )  # fmt: skip
    return largest_error(found, wanted)


GEARBOXES = 4
"""Single ones stray: under a light torque motions depend on when flanks part, not on the slowest decay alone."""


def test_records_start_as_early_as_their_samples_need() -> None:
    transients, errors = [], []
    for point in (FAST, SLOW):
        config = loaded("duration_s=0.05", f"specimens={GEARBOXES}", point, *FLANKS)
        found = [chosen_steps(config, number) for number in range(GEARBOXES)]
        errors += [start_error(chosen, driven, config) / float(chosen.error or 0.0) for _, chosen, driven in found]
        allowed = START_SHARE * config.config.dynamics.integration_tolerance
        assert np.mean([start_error(chosen, driven, config) for _, chosen, driven in found]) <= 1.5 * allowed
        transients.append(np.mean([chosen.motion.transient_s / chosen.motion.decay_s for _, chosen, _ in found]))
    assert max(errors) < 1.0  # the label, which counts the steps, too
    assert transients[1] > transients[0] + 1.0


def test_the_label_tells_what_is_left_of_a_start(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(step_choice, "START_SHARE", 100.0)
    config, over = loaded("duration_s=0.05", f"specimens={GEARBOXES}", SLOW), []
    for number in range(GEARBOXES):
        _, chosen, driven = chosen_steps(config, number)
        assert chosen.error_of == "samples"
        over.append(start_error(chosen, driven, config) / float(chosen.error or 0.0))
    assert max(over) < 10.0
    assert abs(np.mean(np.log(over))) < np.log(2.0)


def test_where_nothing_decays_all_of_the_start_is_left() -> None:
    assert forgotten(0.2, 0.1, 1e-4, TRANSIENT_CAP_S) == (TRANSIENT_CAP_S, 0.2)
    settled_s, left = forgotten(0.2, 0.1, 1e-4, 0.9)
    assert left <= 1e-4
    assert settled_s == pytest.approx(0.1 + 0.1 * np.log(0.2 / left))


def test_levels_are_compared_where_teeth_part_and_samples_have_nothing_in_common() -> None:
    (rattling,) = simulate(loaded("operating_points=[{speed_hz: 35, torque_nm: 0.3}]", "duration_s=0.5"), [0])
    assert rattling.labels["contact_loss_share"] > 0.0
    assert rattling.labels["integration_error_of"] == "levels"
    assert 0.0 < rattling.labels["integration_error"] < 0.5


@pytest.mark.slow  # presets within their stated error: test_fast_against_reference.py
def test_the_label_of_a_record_is_its_error_within_a_factor_of_two() -> None:
    config, chosen, driven = chosen_steps(loaded())
    specimen = config.gearbox(0)
    record = planned_record(config, RECORD)
    mesh = specimen_state(specimen, record.state_id).mesh
    point = specimen.points[record.operating_point_id]
    law, step_s = specimen.law.by_reference(), 1.0 / (config.fs_hz * FINE_STEPS)
    fine = specimen_motion(law, mesh, point, step_s, driven)
    found, wanted = (
        response_of(
            motion, driven.rotation, SampleGrid(config.fs_hz, config.samples, steps),
            wanted=Wanted(bearing_forces=False), excitation=driven.excitation,
        ).acceleration_m_s2
        for motion, steps in ((chosen.motion, chosen.grid.per_sample), (fine, FINE_STEPS))
    )  # fmt: skip
    error = largest_error(found, wanted)
    assert chosen.error is not None
    assert 0.5 * error <= chosen.error <= 2.0 * error
    assert chosen.error <= MARGIN * config.config.dynamics.integration_tolerance
    (made,) = simulate(config, [RECORD])
    assert made.labels["integration_error"] == chosen.error
