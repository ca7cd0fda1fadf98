"""Every kind of damage, sensor, source, housing and mesh passes the same checks; a new one needs an entry to be here.

A record alone is that of its set, to the byte. What is taken away leaves nothing behind. Labels say what is there, and
a number that cannot be is refused with its key and line.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
import yaml

import siggen
from siggen.checks.loading import load_config
from siggen.config.background import Background
from siggen.config.housing import ModalHousing, PlateHousing, RigidHousing
from siggen.damage.registry import BY_WORD
from siggen.dataset.reading import Dataset
from siggen.errors import ConfigError
from siggen.sensors.kinds import KINDS as SENSOR_KINDS
from tests.kinds.machines import DAMAGES, HOUSINGS, MESHES, SENSORS, SIZES, SOURCES, machine, smaller

TINY = 1e-3
SETS = ("full", "tiny", "sham", "none")
"""Sets of one gearbox whose states have every kind: at its size, at a thousandth, with nothing removed, and without."""


def states(what: str) -> dict[str, Any]:
    """Return the states of a set, each in the same place: start and noise of a record follow from it."""
    made: dict[str, Any] = {"healthy": {}}
    for kind in DAMAGES:
        damage = {} if what == "none" else {"damage": smaller(kind, TINY if what == "tiny" else 1.0)}
        made[kind] = {**damage, **({"acts": False} if what == "sham" else {})}
    return made


@pytest.fixture(scope="module")
def sets(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Dataset]:
    folder = tmp_path_factory.mktemp("kinds")
    for what in SETS:
        siggen.generate(load_config(machine(states=states(what), sensors=SENSORS)), folder / what, executor="serial")
    return {what: siggen.open(folder / what) for what in SETS}


@pytest.fixture(scope="module")
def gearbox() -> siggen.Gearbox:
    """Return the gearbox of the set of full damage, drawn alone."""
    return siggen.draw(load_config(machine(states=states("full"), sensors=SENSORS)))


@pytest.fixture(scope="module")
def records(sets: dict[str, Dataset]) -> dict[tuple[str, str], dict[str, Any]]:
    """Return the records of all sets by set and kind."""
    return {(what, kind): one.record(1 + n) for what, one in sets.items() for n, kind in enumerate(DAMAGES)}


Records = dict[tuple[str, str], dict[str, Any]]


def signals(record: dict[str, Any], gearbox: siggen.Gearbox) -> dict[str, np.ndarray]:
    """Return channel -> signal of a record as its set has it."""
    sensors = gearbox._design.sensors
    columns = {name: sensor.quantity.column(name) for sensor in sensors for name, _ in sensor.channels}
    return {name: np.asarray(record[column], dtype=np.float64) for name, column in columns.items()}


def test_nothing_is_left_out() -> None:
    assert set(DAMAGES) == set(SIZES) == set(BY_WORD)
    assert {one["kind"] for one in SENSORS.values()} == {one.kind_word() for one in SENSOR_KINDS}
    assert set(SOURCES) == {name for name in Background.model_fields if name not in ("like", "base")}
    housings = (PlateHousing, RigidHousing, ModalHousing)
    assert set(HOUSINGS) == {get_args(one.model_fields["kind"].annotation)[0] for one in housings}


@pytest.mark.parametrize("kind", DAMAGES)
def test_a_record_alone_is_that_of_the_set_to_the_byte(kind: str, gearbox: siggen.Gearbox, records: Records) -> None:
    alone, of_set = siggen.run(gearbox, kind), signals(records["full", kind], gearbox)
    assert set(alone.channels) == set(of_set)
    for name, values in of_set.items():
        assert alone.channels[name].tobytes() == values.tobytes(), name


@pytest.mark.parametrize("kind", DAMAGES)
def test_a_damage_with_nothing_removed_is_healthy_to_the_byte(kind: str, records: Records) -> None:
    """Signals, pulses and labels: numbers of steps and solved ones are among the labels."""
    sham, healthy = records["sham", kind], records["none", kind]
    for name in healthy:
        assert np.asarray(sham[name]).tobytes() == np.asarray(healthy[name]).tobytes(), name
    assert {name: sham[name] for name in sham if name not in healthy} == {"sham": True}


@pytest.mark.parametrize("kind", DAMAGES)
def test_a_vanishing_damage_is_healthy_in_the_limit(kind: str, gearbox: siggen.Gearbox, records: Records) -> None:
    """Sizes a thousandth: the change falls at least as their square root; a halo or a sink of fixed size would not."""
    healthy, tiny, full = (
        signals(records[what, kind], gearbox)["pinion_vertical"] for what in ("none", "tiny", "full")
    )
    assert (change := np.std(full - healthy)) > 0.0
    assert np.std(tiny - healthy) < np.sqrt(TINY) * change


@pytest.mark.parametrize("kind", DAMAGES)
def test_labels_and_rows_say_what_is_there(kind: str, records: Records, sets: dict[str, Dataset]) -> None:
    rows = {
        what: [row for row in sets[what].damage().to_pylist() if row["record_id"] == records[what, kind]["record_id"]]
        for what in SETS
    }
    assert records["full", kind]["fault"] in BY_WORD[kind].words
    assert records["full", kind]["damage_count"] == len(rows["full"]) > 0
    assert len(rows["tiny"]) == len(rows["sham"]) == len(rows["full"])
    assert {row["kind"] for row in rows["sham"]} == {"sham"}
    assert records["sham", kind]["fault"] == records["none", kind]["fault"] == "healthy"
    assert rows["none"] == []


@pytest.mark.parametrize("name", SENSORS)
def test_what_a_sensor_shows_follows_from_it_alone(name: str, gearbox: siggen.Gearbox, records: Records) -> None:
    """Whatever else measures: to the byte. Its channels have a unit, and something happens in them."""
    entry = SENSORS[name]
    needed = {one: SENSORS[one] for one in entry.values() if isinstance(one, str) and one in SENSORS}
    config = load_config(machine(states=states("full"), sensors={**needed, name: entry}))
    alone, beside = siggen.run(siggen.draw(config), "spall"), signals(records["full", "spall"], gearbox)
    for channel in alone.channels:
        assert alone.channels[channel].tobytes() == beside[channel].tobytes(), channel
        assert alone.units[channel]
        assert np.isfinite(alone.channels[channel]).all()
        assert np.std(alone.channels[channel]) > 0.0


def with_background(background: dict[str, Any]) -> siggen.Record:
    """Return what a sensor on a lid records among sources of noise, its own noise and converter left out."""
    raw = machine(background=background, sensors={"lid": {"place": "lid", "bits": None, "noise": None}})
    raw["dynamics"]["model"] = "casing"
    raw["dynamics"]["friction"] = {
        **raw["dynamics"].get("friction", {}),
        "oil_temperature_c": 100.0,
    }  # thin: flanks touch
    return siggen.run(siggen.draw(load_config(raw)))


@pytest.fixture(scope="module")
def quiet() -> siggen.Record:
    return with_background({})


@pytest.mark.parametrize("part", SOURCES)
def test_a_source_adds_to_channels_and_nothing_to_gears_and_of_size_0_nothing(part: str, quiet: siggen.Record) -> None:
    needed, size = SOURCES[part]
    found = with_background({part: needed})
    assert any(found.channels[name].tobytes() != values.tobytes() for name, values in quiet.channels.items())
    assert found.tacho_s.tobytes() == quiet.tacho_s.tobytes()
    assert {name for name in found.labels if name not in quiet.labels}, "a source is labelled"
    kept = {name: value for name, value in found.labels.items() if name in quiet.labels}
    assert repr(kept) == repr(dict(quiet.labels)), "what it is labelled with is all that it changes"
    if size:
        nothing = with_background({part: {**needed, size: 0.0}})
        for name, values in quiet.channels.items():
            np.testing.assert_allclose(nothing.channels[name], values, rtol=0.0, atol=1e-6 * np.abs(values).max())


@pytest.mark.parametrize("kind", HOUSINGS)
def test_housings_carry_the_same_torque_and_are_named(kind: str, tmp_path: Path) -> None:
    """The mean force of a mesh is torque over base radius, whatever carries the bearings; alone as in a set."""
    needed, place = HOUSINGS[kind]
    raw = machine(
        housing={"kind": kind, **needed}, sensors={"lid": place}, duration_s=0.6,
        internals={"quantities": ["mesh_force_n"]}, operating_points=[{"speed_hz": 30.0, "torque_nm": 60.0}],
    )  # fmt: skip
    raw["dynamics"]["model"] = "casing"
    config = load_config(raw)
    siggen.generate(config, tmp_path / "set", executor="serial")
    dataset = siggen.open(tmp_path / "set")
    gearbox, row = siggen.draw(config), dataset.record(0)
    alone = siggen.run(gearbox, truth=["mesh_force_n"])
    for name, values in signals(row, gearbox).items():
        assert alone.channels[name].tobytes() == values.tobytes()
    base_radius_m = 0.5 * 18 * 3e-3 * np.cos(np.radians(20.0))
    assert alone.truth["mesh_force_n"].mean() == pytest.approx(60.0 / base_radius_m, rel=0.02)


@pytest.mark.parametrize("kind", MESHES)
def test_meshes_give_the_same_bytes_again_and_lines_at_teeth_times_turns(kind: str) -> None:
    make, orders = MESHES[kind]
    found, again = (siggen.run(make(), speed_hz=20.0, torque_nm=30.0, duration_s=0.1) for _ in range(2))
    for name, values in found.channels.items():
        assert np.std(values) > 0.0
        assert values.tobytes() == again.channels[name].tobytes()
    assert [line.order for line in found.lines] == pytest.approx(orders, rel=1e-12)


NUMBERS = [
    (kind, key)
    for kind, section in BY_WORD.items()
    for key, field in section.model_fields.items()
    if key.endswith(("_mm", "_um", "_deg", "_share", "_ratio"))
    and key in {**DAMAGES[kind], **dict.fromkeys(SIZES[kind])}
]


@pytest.mark.parametrize(("kind", "key"), NUMBERS)
@pytest.mark.parametrize("bad", [float("nan"), "much", -1.0, [2.0, 1.0]])
def test_a_number_that_cannot_be_is_refused_with_its_key_and_line(
    kind: str, key: str, bad: object, tmp_path: Path
) -> None:
    raw = machine(states={"healthy": {}, "hurt": {"damage": {"kind": kind, **DAMAGES[kind], key: bad}}})
    file = tmp_path / "bad.yaml"
    file.write_text(text := yaml.safe_dump(raw, sort_keys=False))
    line = 1 + next(n for n, one in enumerate(text.splitlines()) if one.strip().startswith(f"{key}:"))
    with pytest.raises(ConfigError) as refused:
        load_config(file)
    (said,) = [one for one in str(refused.value).splitlines() if f"states.hurt.damage.{key}" in one]
    assert "allowed: " in said
    assert f"line {line}" in said
