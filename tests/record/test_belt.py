"""A belt on a shaft: its orders and force, what of it arrives, and a machine without one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import Record
from siggen.config import Config
from siggen.dynamics.structure.load_lock import locked_load
from siggen.errors import ConfigError
from siggen.planning.plan import planned_record
from siggen.planning.specimen import draw_specimen
from siggen.record.background_course import course_at
from siggen.record.belt import belt_force
from siggen.record.simulation import simulate
from siggen.seeding import Stage, named_uniforms
from siggen.sensing.inputs import MOTION, Input
from siggen.specimen.background import ChannelWay, drawn_background, mean_mesh, specimen_background
from siggen.specimen.background_numbers import BaseNumbers, BeltNumbers
from siggen.specimen.gears import gear_pair
from siggen.specimen.structure import specimen_body, structure
from tests.config.minimal import minimal
from tests.record.test_background import LID, RIGID, added
from tests.specimen.fixed_numbers import fix

SPEED_HZ = 30.0


def belted(belt: dict[str, Any] | None, **changes: Any) -> Config:
    changes = {"dynamics__model": "casing", "housing": RIGID, "duration_s": 0.1, "specimens": 3, **changes}
    background = {"belt": belt, **changes.pop("beside", {})}
    return load_config(minimal(sensors=[{**LID, "position_mm": [60.0, 50.0]}], background=background, **changes))


def drawn(config: Config, specimen_id: int = 0) -> BeltNumbers:
    section = drawn_background(config, specimen_id)
    assert section is not None
    assert section.belt is not None
    return section.belt


def force(config: Config, record_id: int = 0) -> tuple[np.ndarray, dict[str, object]]:
    planned = planned_record(config, record_id)
    specimen = draw_specimen(config, planned.specimen_id)
    course = course_at(config, specimen, planned, 0, config.samples)
    return belt_force(drawn(config, planned.specimen_id), course)


def amplitudes(signal: np.ndarray, frequency_hz: list[float], fs_hz: float) -> np.ndarray:
    """Return the complex amplitudes of lines by least squares."""
    angle = 2.0 * np.pi * np.outer(np.arange(signal.size) / fs_hz, frequency_hz)
    columns = np.concatenate([np.cos(angle), np.sin(angle)], axis=1)
    found, *_ = np.linalg.lstsq(columns, signal, rcond=None)
    # nothing but these lines is there
    assert np.abs(signal - columns @ found).max() < 1e-6 * np.abs(signal).max()
    return np.asarray(found[: len(frequency_hz)] - 1j * found[len(frequency_hz) :])


def bytes_of(config: Config) -> bytes:
    (found,) = simulate(config, [0])
    assert isinstance(found, Record), found
    return found.channels["lid_vertical"].tobytes()


def test_a_belt_that_pulls_at_nothing_leaves_the_bytes_of_a_machine_without_one() -> None:
    beside = {"beside": {"machines": {}, "shafts": {}, "bearings": {}}}
    without = bytes_of(belted(None, **beside))
    assert bytes_of(belted({"pull_n": 0.0}, **beside)) == without
    assert bytes_of(belted({"pull_n": 500.0}, **beside)) != without


@pytest.mark.parametrize("shaft", ["pinion", "gear"])
def test_a_belt_passes_below_the_order_of_its_shaft_and_its_pulley_runs_out_at_it(shaft: str) -> None:
    config = belted({"shaft": shaft, "order": 0.37, "pull_n": 1000.0, "force_share": 0.03}, duration_s=4.0)
    found, labels = force(config)
    turns_hz = SPEED_HZ if shaft == "pinion" else SPEED_HZ * 18 / 47
    numbers = drawn(config)
    lines = [h * 0.37 * turns_hz for h in (1, 2, 3, 4)] + [turns_hz]
    size = np.abs(amplitudes(found, lines, config.fs_hz))
    decibels = np.array([0.0, numbers.second_db, numbers.third_db, numbers.fourth_db])
    np.testing.assert_allclose(size[:4], 30.0 * 10.0 ** (decibels / 20.0), rtol=1e-6)
    assert size[4] == pytest.approx(1000.0 * float(numbers.runout_share), rel=1e-6)
    assert labels["belt_order"] == pytest.approx(0.37 * turns_hz / SPEED_HZ)
    assert (labels["belt_pull_n"], labels["belt_force_n"]) == (1000.0, 30.0)


def test_the_pull_over_what_a_pulley_transmits_spans_what_grooves_grip() -> None:
    """By Euler's law of a belt: both strands together over their difference; two digits are kept."""
    grip = np.exp([0.65 * np.pi, 0.45 * np.radians(120.0)])
    drawn = BeltNumbers().pull_over_effective
    assert [drawn.low, drawn.high] == pytest.approx((grip + 1.0) / (grip - 1.0), abs=0.05)


def test_what_arrives_is_in_proportion_to_the_pull() -> None:
    once, twice = (added(belted({"pull_n": pull}))[0]["lid_vertical"] for pull in (700.0, 1400.0))
    # one multiplication by two apart: exact in floating point up to the filters' float32
    np.testing.assert_allclose(twice, 2.0 * once, rtol=1e-5, atol=1e-6 * np.abs(twice).max())
    assert once.std() > 0.0


def test_a_belt_is_tensioned_for_the_torque_of_its_own_record_and_shaft() -> None:
    """F_1 + F_2 = (r + 1)/(r - 1) 2 T/d; the gear's shaft has 47/18 of the torque."""
    pulls = {}
    for shaft in ("pinion", "gear"):
        for torque in (20.0, 40.0):
            config = belted({"shaft": shaft}, operating_points__0__torque_nm=torque)
            pulls[shaft, torque] = force(config)[1]["belt_pull_n"]
    numbers = drawn(config)
    diameter_m = float(numbers.pulley_over_centres) * 0.5e-3 * 3.0 * (18 + 47)
    assert pulls["pinion", 40.0] == pytest.approx(float(numbers.pull_over_effective) * 80.0 / diameter_m)
    assert pulls["pinion", 20.0] == pytest.approx(0.5 * pulls["pinion", 40.0])
    assert pulls["gear", 40.0] == pytest.approx(47 / 18 * pulls["pinion", 40.0])


def response(config: Config, frequency_hz: np.ndarray) -> np.ndarray:
    """Return acceleration of the lid over the belt's force (k,) before the sensor, not cut off anywhere."""
    specimen, section = draw_specimen(config, 0), drawn_background(config, 0)
    assert section is not None
    ways = {"lid_vertical": ChannelWay({Input(MOTION, "casing_lid/vertical"): 1.0}, None, None)}
    found = specimen_background(config, specimen, section, ways, frequency_hz)
    return np.asarray(found.responses["lid_vertical"][found.inputs.index("belt")])


def test_the_force_of_a_belt_shakes_the_housing_as_the_matrices_of_the_gearbox_say() -> None:
    """a = -w² r (K + iwC - w² M)^-1 d F, solved here by a library's elimination with an own direction."""
    config = belted({"shaft": "gear", "pull_n": 1000.0})
    specimen, frequency = draw_specimen(config, 0), np.geomspace(5.0, 20_000.0, 40)
    model, pair = locked_load(structure(config, specimen)), gear_pair(specimen.gears)
    mesh = mean_mesh(specimen.dynamics, pair, model.mesh.mass_kg)
    p, angle = model.mesh.vector, pair.working_pressure_angle_rad
    stiffness = model.stiffness + mesh.stiffness_n_per_m * np.outer(p, p)
    damping = model.damping + mesh.damping_n_s_per_m * np.outer(p, p)
    # horizontal is x cos - y sin of the pressure angle, vertical x sin + y cos
    turn = 2.0 * np.pi * named_uniforms(config.seed, Stage.BACKGROUND, 0)("background.belt.angle")
    along = np.zeros(len(model.coordinates))
    along[model.coordinates.index("x_2")] = np.cos(turn) * np.cos(angle) + np.sin(turn) * np.sin(angle)
    along[model.coordinates.index("y_2")] = -np.cos(turn) * np.sin(angle) + np.sin(turn) * np.cos(angle)
    row = specimen_body(config, specimen).motions["casing_lid/vertical"]
    seen = np.array([row.get(name, 0.0) for name in model.coordinates])
    expected = [
        -w * w * (seen @ np.linalg.solve(stiffness + 1j * w * damping - w * w * model.mass, along))
        for w in 2.0 * np.pi * frequency
    ]
    # ten digits: stiffnesses of 1e9 and inertias of 1e-4 stand in one matrix
    np.testing.assert_allclose(response(config, frequency), expected, rtol=1e-6)


def test_a_channel_holds_the_lines_of_the_belt_behind_the_response_of_the_gearbox(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    base = {"mass_kg": 200.0}
    fix(monkeypatch, BaseNumbers, horizontal_hz=40.0, vertical_hz=40.0, rocking_hz=40.0)
    config = belted({"order": 0.37, "pull_n": 1000.0}, duration_s=4.0, beside={"base": base})
    lines = [h * 0.37 * SPEED_HZ for h in (1, 2, 3, 4)] + [SPEED_HZ]
    expected = amplitudes(force(config)[0], lines, config.fs_hz) * response(config, np.array(lines))
    signal = added(config)[0]["lid_vertical"]
    angles = 2.0 * np.pi * np.outer(np.arange(signal.size) / config.fs_hz, lines)
    found, *_ = np.linalg.lstsq(np.concatenate([np.cos(angles), np.sin(angles)], axis=1), signal, rcond=None)
    # filters end where 1e-3 of what they remember is left
    np.testing.assert_allclose(found[:5] - 1j * found[5:], expected, atol=5e-3 * np.abs(expected).max())


def test_belts_differ_between_gearboxes_and_not_between_states() -> None:
    config = belted({})
    states = len(config.states)
    first, again, other = (force(config, i)[1] for i in (0, 1, states))
    assert first == again
    assert all(first[name] != other[name] for name in first)


def test_a_worn_belt_is_a_state_of_its_own() -> None:
    changes = {"background.belt.force_share": {"times": 4.0}}
    worn = {"name": "worn", "fault": "belt", "severity": "slight", "changes": changes}
    found = simulate(belted({}, states=[{"name": "healthy"}, worn]), [0, 1])
    healthy, worn_belt = (one.labels for one in found if isinstance(one, Record))
    assert worn_belt["belt_force_n"] == pytest.approx(4.0 * healthy["belt_force_n"])  # type: ignore[operator]
    assert worn_belt["belt_runout_force_n"] == healthy["belt_runout_force_n"]


def test_a_belt_needs_a_shaft_that_can_be_pulled_and_is_longer_than_round_its_pulley() -> None:
    for changes, path in (
        ({"belt": {"order": 1.2}}, "background.belt.order"),
        ({"belt": {"shaft": "motor"}}, "background.belt.shaft"),
    ):
        with pytest.raises(ConfigError) as refused:
            belted(changes.pop("belt"), **changes)
        assert path in {problem.path for problem in refused.value.problems}
