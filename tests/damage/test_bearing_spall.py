"""A spalled bearing as a user meets it: its signature in records, its limits, its rows and labels, its messages."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.signal import hilbert

import siggen.damage.bearing_spall as bearing_spall
from siggen.checks.physical_problems import physical_problems
from siggen.config import parse
from siggen.damage.bearing_spall import RollingSpall
from siggen.drivetrain.drive import Drive
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record
from siggen.gearbox.possible import PossibleGearbox
from siggen.record.bearing_spalls import mean_force_n, spall_sources
from siggen.record.drive import record_rotation
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from siggen.record.structure import structure
from siggen.views.exported_model import exported_model
from tests.config.minimal import by_name, config, minimal
from tests.simulated import damage_rows, drawn_record, simulate

SPEED_HZ, BALLS = 30.0, 9
CAGE = 0.5 * (1.0 - 7.94 / 39.04)
SPIN = 0.5 * 39.04 / 7.94 * (1.0 - (7.94 / 39.04) ** 2)
SLIP = 0.01, 0.02
SPALL: dict[str, Any] = {"kind": "bearing_spall", "element": "outer", "length_mm": 2.0}


def with_states(*damage: dict[str, Any] | None, **changes: Any) -> SetDesign:
    """Return the smallest configuration with a state for each damage behind the healthy one; None for none."""
    states = [{"name": "first"}]
    for number, one in enumerate(damage):
        severity = {} if one is None else {"severity": "moderate"}
        own = {} if one is None else {"damage": {k: v for k, v in one.items() if k != "grows"}}
        grown = {"grows": f"state-{number - 1}"} if one is not None and one.get("grows") else {}
        states.append({"name": f"state-{number}", **severity, **grown, **own})
    return SetDesign(
        config(states=by_name(states), **{"dynamics__model": "8dof", "fs_hz": 25600.0, "duration_s": 1.0, **changes})
    )


@cache
def signal(element: str | None, **more: Any) -> np.ndarray:
    """Return the channel of state 1 of the first gearbox."""
    spall = None if element is None else {**SPALL, "element": element, **more}
    (record,) = simulate(with_states(spall, sensors={"bearing": {"range_m_s2": 1e5}}), [1])
    return record.channels["bearing_vertical"].astype(float)


@pytest.mark.parametrize("element", ["outer", "inner", "ball"])
def test_lines_of_the_envelope_stand_at_the_orders_of_the_element_within_the_slip(element: str) -> None:
    pushed = signal(element) - signal(None)  # the same mesh, phase for phase
    assert np.std(pushed) > 0.05 * np.std(signal(None))
    envelope = np.abs(hilbert(pushed))
    lines = np.abs(np.fft.rfft((envelope - envelope.mean()) * np.hanning(envelope.size)))
    order = np.arange(lines.size) / SPEED_HZ
    slow = [CAGE * (1.0 - slip) for slip in SLIP]
    carrier = {
        "outer": [BALLS * one for one in slow],
        "inner": [BALLS * (1.0 - one) for one in slow],
        "ball": [2.0 * SPIN * (1.0 - slip) for slip in SLIP],
    }[element]
    beside = {"outer": None, "inner": [1.0, 1.0], "ball": slow}[element]
    low, high = min(carrier), max(carrier)
    near = (order > 0.8 * low) & (order < 1.2 * high)
    found = order[near][np.argmax(lines[near])]
    steps = [0.0] if beside is None else [0.0, -beside[0], beside[0]]
    width = 2.0 / SPEED_HZ  # two lines of the spectrum; sidebands come as near as the slip lets them
    assert min(abs(found - np.clip(found, low + step, high + step)) for step in steps) < width + 0.02 * abs(steps[-1])
    assert lines[near].max() > 10.0 * np.median(lines[(order > 1.5) & (order < 30.0)])


def test_the_slip_of_a_record_is_its_own() -> None:
    made = with_states(SPALL, repeats=4)
    orders = {source.cage.order for n in range(4, 8) for source in sources_of(made, n)}
    assert len(orders) == 4
    assert all(1.0 - SLIP[1] <= order / CAGE <= 1.0 - SLIP[0] for order in orders)


@pytest.mark.parametrize("model", ["8dof", "casing"])
def test_a_spall_of_the_outer_race_outside_of_the_zone_of_load_leaves_the_bytes_of_healthy(
    model: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bearing_spall, "LOADED_DEG", 180.0)
    made = [with_states(one, dynamics__model=model, duration_s=0.1) for one in (SPALL, None)]
    (away,), (healthy,) = (simulate(one, [1]) for one in made)
    assert away.labels["fault"] == "bearing"
    assert away.channels["bearing_vertical"].tobytes() == healthy.channels["bearing_vertical"].tobytes()
    assert away.labels["start_angle_rad"] == healthy.labels["start_angle_rad"]
    monkeypatch.setattr(bearing_spall, "LOADED_DEG", 45.0)
    (inside,) = simulate(with_states(SPALL, dynamics__model=model, duration_s=0.1), [1])
    assert inside.channels["bearing_vertical"].tobytes() != healthy.channels["bearing_vertical"].tobytes()


@pytest.mark.parametrize("model", ["8dof", "casing"])
@pytest.mark.parametrize("bearing", ["pinion_bearing", "gear_bearing"])
def test_shaft_and_housing_feel_equal_and_opposite_forces(model: str, bearing: str) -> None:
    housing = {"housing": {"kind": "rigid"}} if model == "casing" else {}
    made = with_states({**SPALL, "bearing": bearing}, dynamics__model=model, **housing)
    (source,) = sources_of(made, 1)
    names = structure(made.gearbox(0)).coordinates
    for axis in "xy":
        on_shafts = source.vectors[:, [names.index(f"{axis}_{gear}") for gear in ("pinion", "gear")]].sum(axis=1)
        on_seats = -np.array([source.seat_forces[f"{bearing}/{one}"] for one in ("horizontal", "vertical")]).sum(axis=1)
        if model == "casing":
            on_housing = source.vectors[:, names.index(f"{axis}_casing")]
            np.testing.assert_allclose(on_shafts, -on_housing, atol=1e-12)
        assert np.abs(on_shafts).max() > 0.1
        np.testing.assert_allclose(on_seats, 1.0, atol=1e-12)  # stiff shafts and seats pass all of it on


def test_the_mean_force_of_the_bearing_is_the_torques_whether_a_ball_sinks_or_not() -> None:
    """What a spalled ball leaves the spring bears: the force on the seat is both, in the mean that of the teeth."""
    means = []
    for spall in (None, {**SPALL, "length_mm": 6.0}):
        made = with_states(spall, duration_s=2.0)
        specimen, record = made.gearbox(0), planned_record(made, 1)
        response, point = record_response(specimen, specimen_state(specimen, 1), record, internals=True)
        force = np.array([response.bearing_force_n[f"pinion_bearing/{axis}"] for axis in ("horizontal", "vertical")])
        means.append(force.mean(axis=1))
        expected = mean_force_n(specimen, structure(specimen), point, "pinion_bearing")
    (source,) = sources_of(made, 1)
    sunk = source.inputs(Drive(SPEED_HZ, 1.0).turning(np.linspace(0.0, 2.0, 50_000))).mean(axis=0)
    assert np.hypot(*sunk) > 50.0  # by so much the mean would be wrong if one of both were left out
    # a record holds no whole number of passing balls: 0.5 of 215 pulses of about 300 N over 0.4 of their spacing
    np.testing.assert_allclose(means[1], means[0], atol=2.0)
    np.testing.assert_allclose(means[0], expected, atol=0.01 * np.hypot(*expected))  # friction of the teeth


def sources_of(made: SetDesign, record_id: int) -> tuple[Any, ...]:
    record = planned_record(made, record_id)
    specimen = made.gearbox(record.specimen_id)
    parts = specimen_state(specimen, record.state_id).parts
    return spall_sources(specimen, structure(specimen), record, record_rotation(specimen, record), parts)


def test_an_exported_model_has_what_a_spall_pushes_and_what_of_it_the_housing_feels() -> None:
    model = exported_model(*drawn_record(with_states(SPALL, duration_s=0.02), 1))
    names = [str(name) for name in model["bearing_force_names"]]
    felt = model["input_bearing_force_rows"]
    assert np.abs(model["inputs"]).max() > 100.0
    # 8dof: a seat is the ground, so that a shaft's coordinate gets what its seat gets, with the other sign
    for axis, name in (("x_pinion", "pinion_bearing/horizontal"), ("y_pinion", "pinion_bearing/vertical")):
        on_shaft = model["input_vectors"][:, list(model["coordinates"]).index(axis)]
        np.testing.assert_allclose(felt[names.index(name)], -on_shaft, atol=1e-12)
    assert not felt[[names.index(name) for name in names if name.startswith("gear")]].any()
    assert "input_bearing_force_rows" not in exported_model(*drawn_record(with_states(None, duration_s=0.02), 1))


@pytest.mark.parametrize(("element", "turns"), [("outer", 2.0 / BALLS / CAGE), ("inner", 1.0), ("ball", 1.0 / CAGE)])
def test_steps_are_chosen_on_a_stretch_that_no_passage_of_the_zone_can_miss(element: str, turns: float) -> None:
    (source,) = sources_of(with_states({**SPALL, "element": element, "bearing": "gear_bearing"}), 1)
    of_pinion = source.sharp_turn_rad / (2.0 * math.pi)
    assert turns * 47 / 18 <= of_pinion <= turns * 47 / 18 / (1.0 - SLIP[1])
    angle = np.linspace(0.0, source.sharp_turn_rad, 20_000)
    for start in np.linspace(0.0, 30.0, 7):
        assert source.lost_n(start + angle)[0].max() > 100.0


def test_half_of_the_tooth_force_loads_the_bearing_along_the_line_of_action() -> None:
    made = with_states(SPALL, {**SPALL, "bearing": "gear_bearing"})
    (pinion,), (gear,) = sources_of(made, 1), sources_of(made, 2)
    pair = made.gearbox(0).pair
    force = 60.0 / (0.5 * 3e-3 * 18 * math.cos(math.radians(20.0)))
    for source in (pinion, gear):
        bearing = source.spall.bearing
        assert bearing.force_n(source.zone.deflection_m) == pytest.approx(0.5 * force, rel=1e-9)
    apart = pinion.zone.direction_rad - gear.zone.direction_rad
    assert abs(math.remainder(apart - math.pi, 2.0 * math.pi)) < 1e-12
    from_vertical = abs(math.remainder(pinion.zone.direction_rad - 0.5 * math.pi, math.pi))
    assert from_vertical == pytest.approx(pair.working_pressure_angle_rad)
    assert abs(gear.order) == pytest.approx(18 / 47)
    assert np.sign(gear.order) == -np.sign(pinion.order)


def test_a_grown_spall_takes_the_place_of_the_milder_one() -> None:
    drawn = [0.5, 3.0]
    longer = [1.0, 4.0]
    made = with_states(
        {**SPALL, "element": "inner", "length_mm": drawn},
        {**SPALL, "element": "inner", "length_mm": longer, "grows": True},
        {**SPALL, "grows": True},
    )
    slight, severe, both = (specimen_state(made.gearbox(0), n).parts for n in (1, 2, 3))
    assert [len(parts) for parts in (slight, severe, both)] == [1, 1, 2]
    (before,), (after,) = slight, severe
    assert isinstance(before, RollingSpall)
    assert isinstance(after, RollingSpall)
    assert after.length_m > before.length_m
    assert after.place_rad == before.place_rad
    assert after.hides(before)
    assert not before.hides(after)
    assert len(sources_of(made, 3)) == 2


def test_its_row_and_labels_name_the_bearing_and_no_gear() -> None:
    made = with_states({**SPALL, "element": "ball", "bearing": "gear_bearing"}, duration_s=0.1)
    (row,) = damage_rows(made, 1)
    assert (row["gear"], row["tooth"], row["kind"]) == ("none", -1, "bearing_spall")
    assert (row["bearing"], row["element"], row["length_mm"], row["depth_mm"]) == ("gear_bearing", "ball", 2.0, 0.1)
    (record,) = simulate(made, [1])
    found = {key: record.labels[key] for key in ("fault", "faulty_gear", "faulty_teeth_pinion", "damage_count")}
    assert found == {"fault": "bearing", "faulty_gear": "none", "faulty_teeth_pinion": [], "damage_count": 1}
    assert record.labels["damaged_area_mm2"] == 0.0


def test_its_row_tells_the_slip_that_its_cage_has_in_this_record() -> None:
    made = with_states(SPALL, None)
    (row,), (source,) = damage_rows(made, 1), sources_of(made, 1)
    assert SLIP[0] <= row["slip_share"] <= SLIP[1]
    assert source.cage.order == pytest.approx(CAGE * (1.0 - row["slip_share"]), rel=1e-12)
    repeated = with_states(SPALL, None, repeats=2)
    rows = damage_rows(repeated, 1, 2, 3)
    assert [row["record_id"] for row in rows] == [2, 3]
    assert rows == [*damage_rows(repeated, 2), *damage_rows(repeated, 3)]
    assert rows[0]["slip_share"] != rows[1]["slip_share"]


@pytest.mark.parametrize(
    ("damage", "changes", "path", "allowed"),
    [
        ({"length_mm": 0.0}, {}, "length_mm", "a number above 0"),
        ({"length_mm": 17.0}, {}, "length_mm", "below 16.3"),
        ({"element": "ball", "length_mm": 13.0}, {}, "length_mm", "half of the ball's girth"),
        ({"length_mm": [1.0, 40.0]}, {}, "length_mm", "the spacing of the balls"),
        ({"depth_mm": 4.0}, {}, "depth_mm", "below 3.97 mm, the radius of a ball"),
        (
            {"length_mm": 12.0}, {"dynamics__pinion__bearing": {"geometry": {"balls": 14}}},
            "length_mm", "the spacing of the balls",
        ),
        ({"geometry": {"balls": 8}}, {}, "geometry", "known keys: "),
        ({"element": "cage"}, {}, "element", "outer"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_what_is_allowed(
    damage: dict[str, Any], changes: dict[str, Any], path: str, allowed: str
) -> None:
    states = [{"name": "healthy"}, {"name": "slight", "damage": {**SPALL, **damage}}]
    parsed = parse(minimal(states=by_name(states), **changes))
    problems = [*parsed.problems, *physical_problems(PossibleGearbox.of_sections(parsed.sections))]
    found = {problem.path: problem for problem in problems}
    assert f"states.slight.damage.{path}" in found, problems
    assert allowed in found[f"states.slight.damage.{path}"].allowed


def test_a_spall_is_in_the_bearing_of_its_shaft_and_else_in_a_6205() -> None:
    geometry = {"balls": 8, "ball_diameter_mm": 12.3, "pitch_diameter_mm": 46.0, "clearance_um": 5.0}
    made = with_states(SPALL, {**SPALL, "bearing": "gear_bearing"}, dynamics__gear__bearing={"geometry": geometry})
    (plain,), (given,) = sources_of(made, 1), sources_of(made, 2)
    found, default = given.spall.bearing, plain.spall.bearing
    assert default.balls == 9
    assert default.outer_order == pytest.approx(9 * CAGE)
    assert found.outer_order == pytest.approx(8 * 0.5 * (1.0 - 12.3 / 46.0))
    assert found.clearance_m == pytest.approx(5e-6)
