"""Somebody adds a kind of damage, of sensor and of noise, each a module and a line: every program knows them."""

from __future__ import annotations

import html
import json
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Literal

import numpy as np
import pytest

import siggen
from diagnostics.recordings.columns import read_columns
from diagnostics.recordings.measured_recording import read_recording
from diagnostics.recordings.taken import RecordingFacts
from siggen.damage.fault import Fault
from siggen.errors import UsageError
from tests.diagnostics.explore.unpacked import held
from tests.house.source_tree import ROOT
from tests.publication.conftest import facts_file
from tests.sensors.toy_strain_gauge import STRAIN_PER_FORCE

CONFIG = """
extends: quickstart
name: toy
specimens: 1
duration_s: 0.2
repeats: 1
splits: {train: 10, validation: 5, test: 5}
dynamics: {mesh: {damage: all}}
"""
TOY = """
states:
  others: null
  healthy: {}
  slight: {damage: {kind: toy_hinge, depth_mm: [0.8, 1.2]}}
  severe: {damage: {kind: toy_hinge, depth_mm: [3, 4]}}
"""
CLEAN = """
states: {others: null, healthy: {}, slight: {damage: {kind: toy_hinge, depth_mm: 1}}}
background: null
internals: {quantities: [bearing_force_pinion_bearing_vertical_n]}
"""
GAUGE = "  seat: {kind: toy_strain_gauge, range_um_m: 100, floor_um_m: [0.005, 0.02]}\n"
LID = "  lid: {place: lid, position_mm: [5, 5], bits: null, noise: {floor_m_s2: 0.01}}\n"
DRIFTS = LID.replace("}}", "}, toy_drift: {size_m_s2_per_s: [5, 9]}}")
CONFIGS = {
    "toy": (TOY, GAUGE), "alone": (CLEAN, LID), "both": (CLEAN, GAUGE + LID), "drift": (CLEAN, DRIFTS),
    "mistake": (CLEAN, DRIFTS.replace("[5, 9]", "-1")),
}  # fmt: skip
SIGNAL, LID_SIGNAL, DRIFT = "strain_seat_vertical_um_m", "accel_lid_vertical_m_s2", "toy_drift_lid_vertical_m_s2_per_s"
OTHER_KINDS = re.compile(r"\b(pits?|pitting|spall\w*)\b", re.IGNORECASE)
OTHER_QUANTITY = re.compile(r"accelerat\w*|accelerometer|(?<!m)m/s(²|\^?2)|m_s2", re.IGNORECASE)

MISTAKES = {
    "toy.yaml --set states.severe.damage.depth_mm=0.01": "states.severe.damage.depth_mm: received 0.01; allowed: at l",
    "toy.yaml --set sensors.seat.range_um_m=0.05": "allowed: at least 0.1",
    "toy.yaml --set sensors.seat.kind=thermometer": "coupling_torque, bearing_force, motor_current, toy_strain_gauge",
    "mistake.yaml": "sensors.lid.toy_drift.size_m_s2_per_s: received -1.0; allowed: a number of at least 0",
}
LINES = {
    **{
        name: f"siggen generate {name}.yaml --out {name} --executor serial"
        for name in ("toy", "alone", "both", "drift")
    },
    "plan": "siggen plan toy.yaml --trial 0 --set sensors.seat.range_um_m=0.5",
    **{change: f"siggen plan --trial 0 {change}" for change in MISTAKES},
    "publish": "siggen publish toy --facts publication.yaml --to published",
    "explore": "siggen-diagnostics explore toy --out explorer.html",
    "simulate": "siggen show toy.yaml --record 0 --out one.parquet",
}


def said(folder: Path, lines: Mapping[str, str], codes: Mapping[str, int]) -> dict[str, str]:
    """Run command lines one after the other in a fresh process, in a folder; return by name all that each said.

    Parameters
    ----------
    folder : Path
        Where they run.
    lines : mapping of str to str
        Command lines by name.
    codes : mapping of str to int
        Exit codes that are not 0, by name.
    """
    words = json.dumps([shlex.split(line) for line in lines.values()])
    done = subprocess.run(
        [sys.executable, "-m", "tests.kinds.with_toys"], input=words,
        cwd=folder, env={**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "COLUMNS": "160"},
        capture_output=True, text=True, timeout=500, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    found = {}
    for name, (code, printed, told) in zip(lines, json.loads(done.stdout), strict=True):
        found[name] = printed + told
        assert code == codes.get(name, 0), f"{lines[name]}: exit code {code}\n{found[name]}"
        assert "Traceback" not in found[name]
    return found


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, str]]:
    """Return a folder with all that commands made there in one process, and what they said."""
    folder = tmp_path_factory.mktemp("toy")
    for name, (rest, sensors) in CONFIGS.items():
        (folder / f"{name}.yaml").write_text(f"{CONFIG}{rest}sensors:\n  others: null\n{sensors}")
    facts_file(folder)
    return folder, said(folder, LINES, dict.fromkeys(MISTAKES, 2))


@pytest.fixture(scope="module")
def folder(made: tuple[Path, dict[str, str]]) -> Path:
    return made[0]


def words_of(page: Path) -> str:
    """Return what a reader of a page sees: its words, and the titles and axes that its scripts hold."""
    source = re.sub(r"(?s)<style\b.*?</style>|[A-Za-z0-9+/]{200,}", " ", page.read_text(encoding="utf-8"))
    return html.unescape(re.sub(r"<[^>]+>", " ", source))


def without_scripts(page: Path) -> str:
    """Return its words alone."""
    source = re.sub(r"(?s)<(script|style)\b.*?</\1>", " ", page.read_text(encoding="utf-8"))
    return html.unescape(re.sub(r"<[^>]+>", " ", source))


def test_a_damage_is_labelled_softens_its_tooth_and_has_its_rows(folder: Path) -> None:
    dataset = siggen.open(folder / "toy")
    labels = dataset.labels().to_pylist()
    assert {label["fault"] for label in labels} == {"healthy", "hinge"}
    losses = {s: [one["mesh_stiffness_loss"] for one in labels if one["state"] == s] for s in ("healthy", "severe")}
    assert max(losses["healthy"]) == 0.0 < min(losses["severe"])
    assert {row["kind"] for row in dataset.damage().to_pylist()} == {"hinge"}


def test_a_channel_holds_its_quantity_with_its_own_noise(folder: Path) -> None:
    dataset = siggen.open(folder / "toy")
    (channel,) = dataset.channels
    assert (channel.name, channel.quantity, channel.unit) == ("seat_vertical", "strain", "um/m")
    assert channel.column == SIGNAL
    assert dataset.manifest["channels"][0]["quantity"] == "strain"
    assert 0.005 <= dataset.record(0)["noise_floor_seat_vertical_um_m"] <= 0.02


def test_a_source_of_noise_has_its_column_and_adds_what_it_says(folder: Path) -> None:
    without, drift = (siggen.open(folder / name) for name in ("alone", "drift"))
    record = drift.record(0)
    added = record[LID_SIGNAL].astype(float) - without.record(0)[LID_SIGNAL].astype(float)
    # signals are float32, below 100 m/s²
    np.testing.assert_allclose(added, record[DRIFT] * np.arange(added.size) / drift.fs_hz, atol=2e-5)
    assert 5.0 <= record[DRIFT] <= 9.0
    assert DRIFT not in without.labels().column_names
    card = (folder / "drift" / "README.md").read_text(encoding="utf-8")
    assert f"| `{DRIFT}` | double | m/s^2/s | drift per second in lid_vertical |" in card


def test_a_sensor_stands_beside_an_accelerometer_and_leaves_it_as_it_was(folder: Path) -> None:
    alone, both = (siggen.open(folder / name) for name in ("alone", "both"))
    record = both.record(0)
    assert record[LID_SIGNAL].tobytes() == alone.record(0)[LID_SIGNAL].tobytes()
    inner = next(row for batch in both.internals() for row in batch.to_pylist() if row["record_id"] == 0)
    strain = STRAIN_PER_FORCE * np.array(inner["bearing_force_pinion_bearing_vertical_n"])
    floor = record["noise_floor_seat_vertical_um_m"]
    assert np.std(record[SIGNAL] - strain) == pytest.approx(floor, rel=0.05)
    assert abs(record[SIGNAL].mean()) < 0.1 * abs(strain.mean())
    card = (folder / "both" / "README.md").read_text(encoding="utf-8")
    assert "labelled strain and acceleration records" in card
    assert "`seat_vertical` (pinion_bearing, vertical), in um/m; `lid_vertical` (lid, vertical), in m/s^2" in card


def test_the_plan_takes_them_and_mistakes_are_named(made: tuple[Path, dict[str, str]]) -> None:
    heard = {name: " ".join(text.split()) for name, text in made[1].items()}
    assert "hinge" in heard["plan"]
    assert "seat_vertical" in heard["plan"]
    assert "range [µm/m]" in heard["plan"]
    for change, allowed in MISTAKES.items():
        assert allowed in heard[change]


def test_card_and_publication_name_them_and_no_others(folder: Path) -> None:
    for card in ("toy/README.md", "published/README.md"):
        text = " ".join((folder / card).read_text(encoding="utf-8").split())
        assert "labelled strain records" in text
        assert "Toy gauges show the strain of a bearing's seat" in text
        assert "Toy hinges soften their teeth" in text
        assert not OTHER_QUANTITY.search(text)
        assert not OTHER_KINDS.search(text)
    text = json.dumps(json.loads((folder / "published/croissant.json").read_text()))
    assert "hinge" in text
    assert not OTHER_QUANTITY.search(text)


def test_the_explorer_shows_them_and_no_others(folder: Path) -> None:
    page = folder / "explorer.html"
    assert '"seat_vertical":{"word":"strain","unit":"µm/m"}' in page.read_text("utf-8")
    assert "hinge" in page.read_text("utf-8")
    titles = {one["title"] for one in held(page)["look-data"]["indicators"]}
    assert "RMS [µm/m]" in titles
    assert not OTHER_QUANTITY.search(" ".join((*titles, words_of(page))))
    assert not OTHER_KINDS.search(without_scripts(page))


def test_a_file_of_one_record_says_what_its_channel_holds(folder: Path) -> None:
    found = read_columns(folder / "one.parquet")
    assert found.own == {"seat_vertical": SIGNAL}
    assert found.units == {SIGNAL: "um/m"}
    file, names = folder / "one.parquet", ("seat_vertical",)
    for given in (None, "g", "um/m"):
        with pytest.raises(UsageError, match=r"states the unit 'um/m' .* no acceleration") as refused:
            read_recording(file, names, RecordingFacts(unit=given))
        assert "unit: g" not in str(refused.value)
    read = read_recording(file, names, RecordingFacts(), ("um/m",))
    assert read.units == {"seat_vertical": "um/m"}
    np.testing.assert_array_equal(read.channels["seat_vertical"], read_columns(file).values[SIGNAL])
    with pytest.raises(UsageError, match="received the unit 'um/m'; allowed: mm/m"):
        read_recording(file, names, RecordingFacts(), ("mm/m",))


@pytest.mark.slow
def test_report_and_audit_name_them_and_no_others(folder: Path) -> None:
    lines = {
        "generate": "siggen generate toy.yaml --set specimens=10 --out judged --executor serial",
        "report": "siggen-diagnostics report judged --no-cnn --out report",
        "audit": "siggen-diagnostics audit judged --out audit",
    }
    said(folder, lines, {})
    for what in ("report", "audit"):
        page = folder / what / f"{what}.html"
        assert not OTHER_QUANTITY.search(words_of(page))
        assert "hinge" in without_scripts(page)
        assert not OTHER_KINDS.search(without_scripts(page))


def test_a_kind_without_words_is_refused_when_it_is_made() -> None:
    with pytest.raises(TypeError, match=r"Nameless\.words: received \(\)"):

        class Nameless(Fault):
            kind: Literal["nameless"] = "nameless"
