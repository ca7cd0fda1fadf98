"""Machines with names of one's own, planetary sets, sensors of one's own, and a newcomer's script as a whole."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import siggen
from siggen import Channel, Crack, Pit, Reading, Spall, State
from siggen.errors import UsageError
from tests.command import script

NEWCOMER = Path(__file__).with_name("newcomer.py")
HOIST: dict[str, Any] = {
    "shafts": {"input": {}, "middle": {"span_mm": 120}, "drum": {"mass_kg": 6}},
    "gears": {
        "a": {"teeth": 18, "shaft": "input"},
        "b": {"teeth": 47, "shaft": "middle"},
        "c": {"teeth": 17, "shaft": "middle"},
        "d": {"teeth": 52, "shaft": "drum"},
    },
    "meshes": {
        "fast": {"gears": ["a", "b"], "module_mm": 2},
        "slow": {"gears": ["c", "d"], "module_mm": 3, "direction_deg": 30},
    },
    "rated_nm": 60,
}


@dataclass(frozen=True)
class Gauge:
    """One channel."""

    name: str
    reads: tuple[Reading, ...]
    response: Callable[[Any], Any] | None = None

    def channels(self, gearbox: siggen.Gearbox) -> Sequence[Channel]:
        return [Channel(self.name, "N", self.reads, self.response)]


def test_what_a_newcomer_writes_runs() -> None:
    assert script(NEWCOMER).split() == list(siggen.load_config("quickstart").state_names)


def test_a_machine_runs_under_its_own_names_and_bears_damage_on_any_gear() -> None:
    hoist = siggen.machine(**HOIST)
    assert hoist.gears == ("a", "b", "c", "d")
    assert hoist.channels == ("input_vertical", "output_horizontal")
    pits = tuple(Pit("c", face_mm=z, semi_axes_mm=(0.9, 0.3)) for z in np.linspace(1.0, 23.0, 12))
    hoist = hoist.with_(State("c_pitted", pits), State("d_cracked", (Crack("d", depth_mm=1.0),)))
    healthy, pitted, cracked = (siggen.run(hoist, one.name, 16, 50, duration_s=0.07) for one in hoist.states)
    assert {record.labels["faulty_gear"] for record in (healthy, pitted, cracked)} == {"none", "c", "d"}
    assert pitted.labels["damage_count"] == 12
    fast, slow = healthy.lines
    assert (fast.name, slow.name) == ("fast", "slow")
    assert slow.order == pytest.approx(18 / 47 * 17)
    assert slow.shafts == pytest.approx({"middle": 18 / 47, "drum": 18 / 47 * 17 / 52})
    assert not np.array_equal(healthy.channels["input_vertical"], pitted.channels["input_vertical"])


def test_a_planetary_set_runs_with_damage_on_sun_and_ring() -> None:
    gearbox = siggen.planetary((25, 26, 77), 2.0).with_(
        State("sun_pitted", (Pit("sun", semi_axes_mm=(2.0, 0.3)),)),
        State("ring_spalled", (Spall("ring", 3, ((3.5, 2.0), (4.3, 2.0), (4.3, 14.0), (3.5, 14.0))),)),
    )
    assert gearbox.gears == ("sun", "planet", "ring")
    found = [siggen.run(gearbox, one.name, 25, 60, duration_s=0.05).labels["faulty_gear"] for one in gearbox.states]
    assert found == ["none", "sun", "ring"]


def test_a_sensor_of_ones_own_reads_what_a_built_one_reads_and_moves_no_other() -> None:
    washer = {"kind": "bearing_force", "place": "pinion_bearing", "axes": ["vertical"],
              "range_n": 1e6, "bits": None}  # fmt: skip
    config = siggen.load_config("quickstart", ["duration_s=0.1"])
    plain = siggen.draw(config, 1)
    sensors = {**config.canonical()["sensors"], "washer": washer}
    (known,) = siggen.runs(
        siggen.draw(siggen.load_config({**config.canonical(), "sensors": sensors}), 1),
        [siggen.Case("healthy", plain.points[0])],
    )
    force = Reading("input.bearing", "vertical", order=0)
    gauges = Gauge("force", (force,)), Gauge("half", (force,), lambda f: 0.5 + 0.0 * f)
    own = siggen.run(plain.with_(*gauges), "healthy", plain.points[0].speed_hz, plain.points[0].torque_nm)
    assert own.units["force"] == "N"
    assert np.allclose(own.channels["force"], known.channels["washer_vertical"], rtol=1e-6, atol=1e-3)
    assert np.std(own.channels["half"]) == pytest.approx(0.5 * np.std(own.channels["force"]), rel=1e-4)
    assert np.array_equal(own.channels["lid_vertical"], known.channels["lid_vertical"])


MISPLACED = {**HOIST["gears"], "a": {"teeth": 18, "shaft": "inpt"}}
BAD = [
    ({"gears": MISPLACED}, r"gears\['a'\].shaft: received 'inpt'.*did you mean 'input'"),
    (
        {"meshes": {"fast": {"gears": ["a"], "module_mm": 2}}},
        r"meshes\['fast'\]\['gears'\]: received \['a'\]; allowed: the n",
    ),
    ({"rated_nm": 9000}, r"rated_nm: received 9000.0; allowed: above 0 up to 75"),
    ({"shafts": {**HOIST["shafts"], "input": {"mass": 3}}}, r"shafts\['input'\].mass: received 3; there is no such"),
    ({"shafts": 3}, "shafts: received 3; allowed: a mapping"),
]


@pytest.mark.parametrize(("change", "said"), BAD, ids=lambda one: str(one)[:30])
def test_a_machine_that_cannot_be_is_refused_by_its_own_names(change: dict[str, Any], said: str) -> None:
    with pytest.raises(UsageError, match=said):
        siggen.machine(**{**HOIST, **change})


def test_sets_and_sensors_that_cannot_be_are_refused() -> None:
    with pytest.raises(UsageError, match=r"teeth=\(25, 26, 70\), ring: received ring and sun on one axis: 70 teeth"):
        siggen.planetary((25, 26, 70), 2.0)
    with pytest.raises(UsageError, match=r"planets: received planet does not fit"):
        siggen.planetary((21, 30, 81), 3.0, planets=4)
    gearbox = siggen.single_stage((23, 61), 2.5)
    for gauge, said in (
        (Gauge("x", (Reading("roof"),)), "Reading.of: received 'roof'; allowed: lid, "),
        (Gauge("x", (Reading("lid", "up"),)), "Reading.along: received 'up'; allowed: vertical, horizontal, axial"),
        (Gauge("x", (Reading("lid", order=0),)), "Reading.order: received 0; allowed: 0 for the force in a bearing, 2"),
        (Gauge("x", (Reading("input.coupling"),)), "Reading.order: received 2; allowed: 0 of a coupling"),
        (Gauge("x", ()), "Channel.reads: received 0 readings of nothing"),
        (Gauge("1st", (Reading("lid"),)), "Channel.name: received '1st'; allowed: letters"),
        (Gauge("sensor_1_vertical", (Reading("lid"),)), "Channel.name: received 'sensor_1_vertical'; allowed: a name"),
        (3, "more: received 3; allowed: objects of State, or sensors"),
    ):
        with pytest.raises(UsageError, match=said):
            gearbox.with_(gauge)  # type: ignore[arg-type]
    broken = gearbox.with_(Gauge("broken", (Reading("lid"),), lambda f: 1 / (0.0 * f)))
    with (
        np.errstate(all="ignore"),
        pytest.raises(UsageError, match=r"response of broken: received .* not finite"),
    ):
        siggen.run(broken, speed_hz=25, torque_nm=40, duration_s=0.1)
