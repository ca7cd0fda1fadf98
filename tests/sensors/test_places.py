"""Sensors at every shaft of a gearbox with two meshes: places by the user's names, and what they read there."""

from __future__ import annotations

from math import cos, pi, radians, sin
from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from siggen.record.structure import axis_places_m
from siggen.sets.drawn import set_columns
from tests.config.minimal import by_name
from tests.config.staged import SLOW, staged
from tests.simulated import simulate

TORQUE_NM = 20.0
DIRECTION_DEG = 35.0
TURNS = {"motor": 1.0, "pinion": 1.0, "gear": 18 / 47, "slow_pinion": 18 / 47, "slow_gear": 18 / 47 * 17 / 52}
TURNS["load"] = TURNS["slow_gear"]
BEARINGS = ("pinion_bearing", "gear_bearing", "slow_bearing")
WASHER = {"kind": "bearing_force", "axes": ["vertical", "horizontal"], "range_n": 1e6, "bits": None}
ENCODER = {"kind": "encoder", "pulses_per_turn": 2_000, "pitch_error": 0, "eccentricity": 0}


def loaded(*sensors: dict[str, Any], **changes: Any) -> SetDesign:
    """Return a configuration of two meshes without friction, errors of teeth or noise."""
    plain = {
        "sensors": by_name(sensors), "stages": [{**SLOW, "direction_deg": DIRECTION_DEG}], "fs_hz": 12_800.0,
        "states": {"healthy": {}}, "dynamics": {"model": "8dof", "friction": {"model": "off"}},
    }  # fmt: skip
    return load_config(staged(**{**plain, **changes}))


def refused(*sensors: dict[str, Any], **changes: Any) -> dict[str, str]:
    """Return path -> what was received and what is allowed."""
    with pytest.raises(ConfigError) as told:
        loaded(*sensors, **changes)
    return {one.path: f"{one.received}; {one.allowed}" for one in told.value.problems}


def signals(config: SetDesign) -> dict[str, np.ndarray]:
    """Return the channels of the first record, which has no noise."""
    (record,) = simulate(config, [0])
    assert isinstance(record, SimulatedRecord), record
    return {name: values.astype(float) for name, values in record.channels.items()}


def mean(signal: np.ndarray) -> float:
    """Return the mean with a Hann window, to which lines below the first turn of a shaft in a second leak nothing."""
    return float(np.average(signal, weights=np.hanning(signal.size)))


def test_bearings_carry_the_mesh_forces_of_their_shaft_and_couplings_and_encoders_what_passes() -> None:
    """Mesh forces by the torques along both lines of action, which a drawing of the gears gives: no structure in it."""
    washers = [{**WASHER, "name": place, "place": place} for place in BEARINGS]
    encoders = [{**ENCODER, "name": shaft.replace(".", "_"), "place": shaft} for shaft in TURNS]
    flange = {"kind": "coupling_torque", "name": "out", "place": "output_coupling", "range_nm": 1e5, "bits": None}
    config = loaded(*washers, flange, *encoders, duration_s=1.0)
    found, specimen = signals(config), config.gearbox(0)
    pairs = [mesh.pair for mesh in specimen.meshes]
    sizes = TORQUE_NM / pairs[0].pinion.base_radius_m, TORQUE_NM * 47 / 18 / pairs[1].pinion.base_radius_m
    # x from the first pinion to its gear; the first pinion turns from x to y, the second one back.
    first = radians(90.0) - pairs[0].working_pressure_angle_rad
    second = radians(DIRECTION_DEG - 90.0) + pairs[1].working_pressure_angle_rad
    driven = [size * np.array([cos(angle), sin(angle)]) for size, angle in zip(sizes, (first, second), strict=True)]
    for place, expected in zip(BEARINGS, (-driven[0], driven[0] - driven[1], driven[1]), strict=True):
        pressing = [mean(found[f"{place}_{axis}"]) for axis in ("horizontal", "vertical")]
        np.testing.assert_allclose(pressing, expected, rtol=1e-6)
    assert mean(found["out_rotation"]) == pytest.approx(TORQUE_NM * 47 / 18 * 52 / 17, rel=1e-6)
    for shaft, turns in TURNS.items():
        # Sampled speeds hold the vibration of both ends of the record: the angle of a mesh of 10 µm, of 200 rad.
        assert found[f"{shaft.replace('.', '_')}_rotation"].mean() == pytest.approx(60.0 * pi * turns, rel=1e-6)
    assert [(one.column, one.unit, one.place) for one in set_columns(config).channels][4:6] == [
        ("force_slow_bearing_vertical_n", "N", "slow_bearing"), ("force_slow_bearing_horizontal_n", "N", "slow_bearing")
    ]  # fmt: skip


def test_a_rigid_casing_moves_at_the_third_shaft_as_two_sensors_elsewhere_on_it_say() -> None:
    corner, other = (60.0, 50.0), (-70.0, -40.0)
    plain = {"axes": ["vertical", "horizontal"], "bits": None}
    placed = {"corner": corner, "other": other}
    sensors = [{**plain, "name": name, "place": "casing", "position_mm": list(at)} for name, at in placed.items()]
    sensors += [{**plain, "name": place, "place": place} for place in BEARINGS]
    config = loaded(*sensors, dynamics={"model": "casing"}, housing={"kind": "rigid"})
    found = signals(config)
    apart = 1e-3 * (np.array(corner) - other)
    x, y = (found[f"corner_{axis}"] - found[f"other_{axis}"] for axis in ("horizontal", "vertical"))
    for turned in (y / apart[0], -x / apart[1]):  # rocking from horizontal to vertical [rad/s²]
        for place, at in axis_places_m(config.gearbox(0)).items():
            across, up = np.array(at) - 1e-3 * np.array(corner)
            told = {
                "vertical": found["corner_vertical"] + across * turned,
                "horizontal": found["corner_horizontal"] - up * turned,
            }
            for axis, expected in told.items():
                seen = found[f"{place}_{axis}"]
                # Channels are float32, and rocking is a difference of two of them.
                assert np.abs(seen - expected).max() < 1e-6 * np.abs(seen).max(), (place, axis)


def test_unknown_places_are_refused_with_those_of_this_gearbox() -> None:
    found = refused(
        {"name": "a", "place": "fast_bearing"}, {**WASHER, "name": "b", "place": "slow_gear"},
        {**ENCODER, "name": "c", "place": "slow_gaer"},
    )  # fmt: skip
    where = "(dynamics.model: 8dof)"
    assert found["sensors.a.place"].startswith(
        f"'fast_bearing'; allowed: one of pinion_bearing, gear_bearing, slow_bearing {where}"
    )
    assert "one of pinion_bearing, gear_bearing, slow_bearing" in found["sensors.b.place"]
    turning = "motor, pinion, gear, slow_pinion, slow_gear, load"
    assert found["sensors.c.place"] == f"'slow_gaer'; allowed: one of {turning} {where}; did you mean 'slow_gear'?"
    one_mesh = refused({"name": "a", "place": "slow_bearing"}, stages=[])
    assert "one of pinion_bearing, gear_bearing (dynamics.model: 8dof)" in one_mesh["sensors.a.place"]


def test_a_transmission_error_of_a_further_mesh_has_its_own_base_circles() -> None:
    """A disc off its axis leads by e/r sin of its angle: 1.5 turns, so both extremes are there."""
    inner, out = {**ENCODER, "name": "in", "place": "slow_pinion"}, {**ENCODER, "name": "out", "place": "slow_gear"}
    error = {"kind": "transmission_error", "name": "of_out", "driver_encoder": "in"}
    off = {**out, "name": "off", "eccentricity": 1e-3}
    pairs = {**error, "driven_encoder": "out"}, {**error, "name": "of_off", "driven_encoder": "off"}
    found = signals(loaded(inner, out, off, *pairs, duration_s=0.4))
    added = found["of_off_line_of_action"] - found["of_out_line_of_action"]
    radius_um = 1e6 * 0.5 * 3e-3 * 52 * cos(radians(20.0))
    assert 0.5 * np.ptp(added) == pytest.approx(1e-3 * radius_um, rel=1e-3)
    assert found["of_out_line_of_action"].std() < 20.0  # of teeth; wrong radii would drift by the turns of a shaft


def test_encoders_of_a_transmission_error_sit_on_both_sides_of_one_mesh() -> None:
    error = {"kind": "transmission_error", "name": "te", "driver_encoder": "in", "driven_encoder": "out"}
    places = {"in": "pinion", "out": "load", "middle": "slow_pinion"}
    encoders = [{**ENCODER, "name": name, "place": place} for name, place in places.items()]
    first = refused(*encoders, error)
    assert first == {"sensors.te.driven_encoder": "'out'; allowed: an encoder at place gear: none there is; add one"}
    assert loaded(*encoders, {**error, "driver_encoder": "middle"}).sensors
    other = refused(*encoders, {**error, "driver_encoder": "out"})["sensors.te.driver_encoder"]
    assert other == "'out'; allowed: an encoder at place pinion or motor or slow_pinion: in, middle"
