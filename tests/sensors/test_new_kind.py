"""Somebody adds a kind of sensor, a module and a line: every program knows it, with its quantity and unit."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

import numpy as np
import pytest

import siggen
from diagnostics.recordings.columns import read_columns
from diagnostics.recordings.measured_recording import read_recording
from diagnostics.recordings.taken import RecordingFacts
from siggen.config import parse
from siggen.errors import UsageError
from tests.diagnostics.explore.unpacked import held
from tests.publication.conftest import facts_file
from tests.sensors.toy_strain_gauge import STRAIN_PER_FORCE
from tests.toy_process import said_by

CONFIG = """
extends: quickstart
name: toy
specimens: 1
duration_s: 0.2
repeats: 1
splits: {train: 10, validation: 5, test: 5}
states:
  others: null
  healthy: {}
  slight: {damage: {kind: spall, face_length_mm: 4, profile_length_mm: 1, depth_mm: 0.1}}
  severe: {damage: {kind: spall, face_length_mm: 12, profile_length_mm: 2, depth_mm: 0.2}}
sensors:
  others: null
  seat: {kind: toy_strain_gauge, range_um_m: 100, floor_um_m: [0.005, 0.02]}
"""
CLEAN = "internals: {quantities: [bearing_force_pinion_bearing_vertical_n]}"
SIGNAL = "strain_seat_vertical_um_m"
OTHER_QUANTITY = re.compile(r"accelerat\w*|accelerometer|(?<!m)m/s(²|\^?2)|m_s2", re.IGNORECASE)


MISTAKES = {
    "sensors.seat.range_um_m=0.05": "allowed: at least 0.1",
    "sensors.seat.kind=thermometer": "coupling_torque, bearing_force, motor_current, toy_strain_gauge",
}
LINES = {
    "generate": "siggen generate toy.yaml --out set --engine serial",
    "doubted": "siggen plan toy.yaml --trial 0 --set sensors.seat.range_um_m=0.5",
    **{change: f"siggen plan toy.yaml --trial 0 --set {change}" for change in MISTAKES},
    "publish": "siggen publish set --facts publication.yaml --to published",
    "alone": "siggen generate alone.yaml --out alone --engine serial",
    "both": "siggen generate both.yaml --out both --engine serial",
    "explore": "siggen-diagnostics explore set --out explorer.html",
    "simulate": "siggen simulate toy.yaml --record 0 --signals --out one.parquet",
}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, str]]:
    """Return a folder with all that commands made there in one process, and what they said."""
    folder = tmp_path_factory.mktemp("toy")
    (folder / "toy.yaml").write_text(CONFIG)
    lid = "  lid: {place: lid, position_mm: [5, 5], noise: {floor_m_s2: 0.01}}\n"
    gauge = CONFIG.partition("sensors:\n  others: null\n")[2]
    for name, sensors in (("alone", lid), ("both", gauge + lid)):
        own = CONFIG.replace("specimens: 1", f"specimens: 1\nbackground: null\n{CLEAN}").replace(gauge, sensors)
        (folder / f"{name}.yaml").write_text(own)
    facts_file(folder)
    return folder, said_by("tests.sensors.with_toys", folder, LINES, dict.fromkeys(MISTAKES, 2))


@pytest.fixture(scope="module")
def folder(made: tuple[Path, dict[str, str]]) -> Path:
    return made[0]


def words_of(page: Path) -> str:
    """Return what a reader of a page sees: its words, and the titles and axes that its scripts hold."""
    source = re.sub(r"(?s)<style\b.*?</style>|[A-Za-z0-9+/]{200,}", " ", page.read_text(encoding="utf-8"))
    return html.unescape(re.sub(r"<[^>]+>", " ", source))


def test_its_channel_holds_its_quantity_with_its_own_noise(folder: Path) -> None:
    dataset = siggen.open(folder / "set")
    (channel,) = dataset.channels
    assert (channel.name, channel.quantity, channel.unit) == ("seat_vertical", "strain", "um/m")
    assert channel.column == SIGNAL
    assert dataset.manifest["channels"][0]["quantity"] == "strain"
    assert 0.005 <= dataset.record(0)["noise_floor_seat_vertical_um_m"] <= 0.02


def test_the_plan_takes_it_and_mistakes_in_it_are_named(made: tuple[Path, dict[str, str]]) -> None:
    said = made[1]
    assert "seat_vertical" in said["doubted"]
    assert "range [µm/m]" in said["doubted"]
    for change, allowed in MISTAKES.items():
        assert allowed in " ".join(said[change].split()), said[change]


def test_card_and_publication_name_its_quantity_and_no_other(folder: Path) -> None:
    for card in ("set/README.md", "published/README.md"):
        text = " ".join((folder / card).read_text(encoding="utf-8").split())
        assert "labelled strain records" in text
        assert "Toy gauges show the strain of a bearing's seat" in text
        assert not OTHER_QUANTITY.search(text)
    text = json.dumps(json.loads((folder / "published/croissant.json").read_text()))
    assert not OTHER_QUANTITY.search(text)


def test_it_stands_beside_an_accelerometer_and_leaves_it_as_it_was(folder: Path) -> None:
    alone, both = (siggen.open(folder / name) for name in ("alone", "both"))
    record = both.record(0)
    assert record["accel_lid_vertical_m_s2"].tobytes() == alone.record(0)["accel_lid_vertical_m_s2"].tobytes()
    inner = next(row for batch in both.internals() for row in batch.to_pylist() if row["record_id"] == 0)
    strain = STRAIN_PER_FORCE * np.array(inner["bearing_force_pinion_bearing_vertical_n"])
    floor = record["noise_floor_seat_vertical_um_m"]
    assert np.std(record[SIGNAL] - strain) == pytest.approx(floor, rel=0.05)
    assert abs(record[SIGNAL].mean()) < 0.1 * abs(strain.mean())
    card = (folder / "both" / "README.md").read_text(encoding="utf-8")
    assert "labelled strain and acceleration records" in card
    assert "`seat_vertical` (pinion_bearing, vertical), in um/m; `lid_vertical` (lid, vertical), in m/s^2" in card


def test_the_explorer_shows_its_quantity_and_no_other(folder: Path) -> None:
    assert '"seat_vertical":{"word":"strain","unit":"µm/m"}' in (folder / "explorer.html").read_text("utf-8")
    titles = {one["title"] for one in held(folder / "explorer.html")["look-data"]["indicators"]}
    assert "RMS [µm/m]" in titles
    assert not OTHER_QUANTITY.search(" ".join((*titles, words_of(folder / "explorer.html"))))


def test_a_file_of_one_record_says_what_its_channel_holds(folder: Path) -> None:
    found = read_columns(folder / "one.parquet")
    assert found.own == {"seat_vertical": SIGNAL}
    assert found.units == {SIGNAL: "um/m"}
    file, names = folder / "one.parquet", ("seat_vertical",)
    for said in (None, "g", "um/m"):
        with pytest.raises(UsageError, match=r"states the unit 'um/m' .* no acceleration") as refused:
            read_recording(file, names, RecordingFacts(unit=said))
        assert "--unit g" not in str(refused.value)
    read = read_recording(file, names, RecordingFacts(), ("um/m",))
    assert read.units == {"seat_vertical": "um/m"}
    np.testing.assert_array_equal(read.channels["seat_vertical"], read_columns(file).values[SIGNAL])
    with pytest.raises(UsageError, match="received the unit 'um/m'; allowed: mm/m"):
        read_recording(file, names, RecordingFacts(), ("mm/m",))


@pytest.fixture(scope="module")
def judged(folder: Path) -> Path:
    """Return the folder with report and audit of a set of as many gearboxes as folds need."""
    lines = {
        "generate": "siggen generate toy.yaml --set specimens=10 --out judged --engine serial",
        "report": "siggen-diagnostics report judged --no-cnn --out report",
        "audit": "siggen-diagnostics audit judged --out audit",
    }
    said_by("tests.sensors.with_toys", folder, lines)
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("what", ["report", "audit"])
def test_report_and_audit_name_its_unit_and_no_other(judged: Path, what: str) -> None:
    said = words_of(judged / what / f"{what}.html")
    assert not OTHER_QUANTITY.search(said)


def test_an_entry_without_a_kind_is_an_accelerometer_and_the_identity_stays() -> None:
    raw = {
        "name": "small", "seed": 1, "specimens": 1,
        "gears": {"module_mm": 2.0, "face_width_mm": 20.0, "pressure_angle_deg": 20.0,
                  "pinion": {"teeth": 20, "bore_radius_mm": 5.0},
                  "gear": {"teeth": 40, "bore_radius_mm": 5.0}},
        "operating_points": [{"speed_hz": 10.0, "torque_nm": 10.0}],
        "states": {"healthy": {}},
    }  # fmt: skip
    found = [parse({**raw, "sensors": {"a": {**kind}}}) for kind in ({}, {"kind": "accelerometer"})]
    first, second = (one.config for one in found)
    assert first is not None, found[0].problems
    assert second is not None
    assert first.sensors[0].kind == "accelerometer"
    assert first.identity == second.identity
