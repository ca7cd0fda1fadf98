"""A state that changes keys is the healthy gearbox but for these keys: same draws, and no other state moves."""

from __future__ import annotations

from typing import Any

import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.errors import ConfigError
from siggen.gearbox.configured import state_config
from siggen.gearbox.design import SetDesign
from tests.config.minimal import by_name, minimal
from tests.simulated import simulate

SPREAD = [0.05, 0.10]
HOT = {"name": "hot", "fault": "lubrication", "severity": "moderate"}


def config(*states: dict[str, Any], **more: Any) -> SetDesign:
    dynamics = {"model": "8dof", "mesh_damping_ratio": SPREAD, "mesh": {"law": "linear"}, "friction": {"model": "off"}}
    raw = minimal(specimens=2, duration_s=0.05, fs_hz=20480.0, mesh_harmonics=3, dynamics=dynamics)
    sensors = [{"name": "bearing", "gain": [0.95, 1.05]}, {"name": "other"}]
    return load_config(raw | {"sensors": by_name(sensors), "states": by_name([{"name": "healthy"}, *states])} | more)


def changed(changes: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {**HOT, "changes": changes, **more}


def record(chosen: SetDesign, record_id: int) -> SimulatedRecord:
    result = simulate(chosen, [record_id])[0]
    assert isinstance(result, SimulatedRecord), result
    return result


def signals(found: SimulatedRecord) -> dict[str, bytes]:
    return {name: signal.tobytes() for name, signal in found.channels.items()}


@pytest.mark.parametrize(
    "changes",
    [{"dynamics.mesh_damping_ratio": {"times": 1}}, {"sensors.bearing.gain": {"add": 0}}, {"dynamics.backlash_um": 80}],
)
def test_what_changes_nothing_gives_the_bytes_of_healthy(changes: dict[str, Any]) -> None:
    found = record(config(changed(changes)), 1)
    assert signals(found) == signals(record(config({"name": "again"}), 1))
    assert found.labels["changed_keys"] == [*changes]


def test_a_patch_is_the_set_whose_healthy_gearbox_has_these_numbers() -> None:
    patch = {"dynamics.mesh_damping_ratio": {"times": 0.5}, "dynamics.pinion.mass_kg": 2, "sensors.bearing.gain": 0.5}
    found = config(changed(patch), {"name": "last"})
    half = [0.025, 0.05]
    dynamics = {
        "model": "8dof", "mesh_damping_ratio": half, "mesh": {"law": "linear"}, "friction": {"model": "off"},
        "pinion": {"mass_kg": 2},
    }  # fmt: skip
    sensors = [{"name": "bearing", "gain": 0.5}, {"name": "other"}]
    same = config({"name": "again"}, {"name": "last"}, dynamics=dynamics, sensors=by_name(sensors))
    for patched in (1, 4):  # both gearboxes
        assert signals(record(found, patched)) == signals(record(same, patched))
    # and the healthy states beside it are those of the set without a patch
    plain = config({"name": "again"}, {"name": "last"})
    for other in (0, 2, 3, 5):
        assert signals(record(found, other)) == signals(record(plain, other))


def test_factor_and_shift_act_on_what_the_healthy_gearbox_drew() -> None:
    chosen = config(changed({"dynamics.mesh_damping_ratio": {"times": 2}, "dynamics.backlash_um": {"add": 40}}))
    for gearbox in range(2):
        healthy = chosen.gearbox(gearbox).law
        own = SetDesign(state_config(chosen.config, gearbox, 1)).gearbox(gearbox).law
        assert own.damping_ratio == 2.0 * healthy.damping_ratio
        assert own.backlash_m == pytest.approx(healthy.backlash_m + 40e-6, rel=1e-12)


def test_a_drawn_change_belongs_to_gearbox_and_state_and_stays_while_it_grows() -> None:
    wide = {"dynamics.backlash_um": {"add": [10, 200]}}
    worse = {"name": "worse", "fault": "lubrication", "severity": "severe", "grows": "hot"}
    chosen = config(changed(wide), {**worse, "changes": {"dynamics.motor_inertia_kg_m2": {"times": 2}}})
    drawn = [[SetDesign(state_config(chosen.config, g, s)).gearbox(g) for s in range(3)] for g in range(2)]
    assert drawn[0][1].law.backlash_m == drawn[0][2].law.backlash_m != drawn[1][1].law.backlash_m
    healthy, heavy = (drawn[0][s].train.first.motor_inertia_kg_m2 for s in (0, 2))  # type: ignore[union-attr]
    assert heavy == 2.0 * healthy
    assert [one.path for _, one in chosen.config.changes_of(2)] == [
        "dynamics.backlash_um",
        "dynamics.motor_inertia_kg_m2",
    ]


def test_each_direction_of_a_bearing_draws_its_own_change() -> None:
    soft = "dynamics.pinion.bearing.stiffness_n_per_m"
    own = {"dynamics": {"model": "8dof", "pinion": {"bearing": {"stiffness_n_per_m": {"each": [1e8, 2e8]}}}}}
    for change, healthy in (({"times": [0.2, 0.8]}, (1e8, 2e8)), ([2e7, 8e7], (1e8, 1e8))):
        chosen = config(changed({soft: change}), **own)
        bearing = SetDesign(state_config(chosen.config, 0, 1)).gearbox(0).train.first.pinion.bearing  # type: ignore[union-attr]
        found = bearing.stiffness_x_n_per_m, bearing.stiffness_y_n_per_m
        shares = [one / whole for one, whole in zip(found, healthy, strict=True)]
        assert shares[0] != shares[1]
        assert all(0.2 <= share <= 0.8 for share in shares)


def test_a_sensors_fault_is_in_its_channel_alone() -> None:
    found = record(config(changed({"sensors.bearing.gain": {"times": 0.5}}, fault="sensor")), 1)
    same = record(config({"name": "again"}), 1)
    assert [name for name in found.channels if found.channels[name].tobytes() != same.channels[name].tobytes()] == [
        "bearing_vertical"
    ]
    assert found.labels["faulty_gear"] == "none"
    assert found.labels["fault"] == "sensor"


def test_a_state_at_the_end_moves_no_other() -> None:
    alone, more = config(), config(changed({"dynamics.pinion.mass_kg": 2}))
    for one, other in ((0, 0), (1, 2)):  # the healthy state of both gearboxes
        assert signals(record(alone, one)) == signals(record(more, other))


@pytest.mark.parametrize(
    ("path", "change", "said"),
    [
        ("fs_hz", 10000, "same in all states"),
        ("gears.module_mm", 4, "same in all states"),
        ("operating_points.0.speed_hz", {"times": 2}, "same in all states"),
        ("sensors.bearing.name", "x", "there is no such key here"),
        ("sensors.bearing.axes", 2, "keys with numbers"),
        ("dynamics.model", "8dof", "keys with numbers"),
        ("dynamics.mesh_dampin_ratio", 0.1, "did you mean 'mesh_damping_ratio'"),
        ("dynamic.backlash_um", 0.1, "did you mean 'dynamics"),
        ("sensors.bering.gain", 0.1, "did you mean 'bearing'"),
        ("dynamics.backlash_um", {"add": -500}, "at least 0"),
        ("dynamics.backlash_um", -5, "at least 0"),
        ("dynamics.mesh_damping_ratio", {"times": 20}, "below 1"),
        ("dynamics.backlash_um", {"times": 2, "add": 1}, "{add: x}"),
        ("dynamics.backlash_um", None, "{add: x}"),
        ("variation.speed.random_rms", 0.001, "leaves the columns"),
        ("manufacture.accuracy_class", 5, "manufacture is null"),
        ("dynamics.backlash_um", {"plus": 1}, "received a mapping with plus; allowed: a number, a range such as"),
        ("dynamics.pinion.bearing.stiffness_n_per_m.0", {"times": 0.5}, "stiffness_n_per_m is a number, changed as a"),
        ("sensors.bearing", 2, "a key below sensors.bearing: kind, place"),
    ],
)
def test_what_may_not_change_is_refused_by_its_key(path: str, change: object, said: str) -> None:
    with pytest.raises(ConfigError) as refused:
        config(changed({path: change}))
    text = str(refused.value)
    assert f"states.hot.changes{'' if 'columns' in said else f'.{path}'}" in text
    assert said in text


def test_what_the_first_state_changes_stays_with_it_in_any_order_of_states() -> None:
    quiet = changed({"sensors.bearing.gain": {"times": 0.25}})
    raw = {"states": by_name([quiet, {"name": "healthy"}])}
    first, second = record(config(**raw), 1), record(config({"name": "again"}), 1)
    assert first.labels["changed_keys"] == []
    assert signals(first) == signals(second)
