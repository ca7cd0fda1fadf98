"""ISA-PHM metadata: what a state, a channel and an operating point become, and what isatools finds in it."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from siggen.checks.loading import load_config
from siggen.publication.isa_phm import isa_phm
from siggen.publication.publication_facts import read_publication_facts
from tests.publication.conftest import facts_file

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def investigation(published: Path) -> dict[str, Any]:
    return json.loads((published / "i_investigation.json").read_text())


SHAFTS = """
extends: quickstart
name: shafts
sensors:
  - {kind: accelerometer, name: side}
  - {kind: encoder, name: first, place: pinion}
  - {kind: encoder, name: second, place: gear}
  - {kind: transmission_error, name: error, pinion_encoder: first, gear_encoder: second}
  - {kind: coupling_torque, name: flange, range_nm: 200, floor_nm: 0.05}
  - {kind: motor_current, name: clamp, rated_torque_nm: 60, pole_pairs: 2, range_a: 100, floor_a: 0.01}
"""


def objects(node: Any) -> Iterator[dict[str, Any]]:
    if isinstance(node, dict):
        yield node
    for child in node.values() if isinstance(node, dict) else node if isinstance(node, list) else ():
        yield from objects(child)


def test_a_state_is_a_study_and_a_channel_an_assay_with_the_files_of_the_set(
    published: Path, investigation: dict[str, Any]
) -> None:
    assert [study["identifier"] for study in investigation["studies"]] == ["healthy", "severe"]
    for study in investigation["studies"]:
        (assay,) = study["assays"]
        values = {v["category"]["@id"]: v["value"] for v in assay["processSequence"][0]["parameterValues"]}
        assert values["#parameter/sampling_rate"] == 16000.0
        assert values["#parameter/column"] == "accel_lid_vertical_m_s2"
        assert all((published / file["name"]).is_file() for file in assay["dataFiles"])
        (sample,) = study["materials"]["samples"]
        factors = {value["category"]["@id"]: value["value"] for value in sample["factorValues"]}
        assert factors["#factor/fault_severity"] == study["identifier"]
        assert factors["#factor/torque"] > 0.0


def test_every_reference_has_its_declaration_in_the_same_study(investigation: dict[str, Any]) -> None:
    for study in investigation["studies"]:
        declared = {node["@id"] for node in objects(study) if "@id" in node and len(node) > 1}
        used = {node["@id"] for node in objects(study) if set(node) == {"@id"}}
        assert used <= declared


@pytest.mark.parametrize("preset", ["quickstart", "families", "industrial"])
def test_ranges_of_a_preset_are_texts_from_the_least_to_the_most(preset: str, tmp_path: Path) -> None:
    config = load_config(ROOT / f"configs/{preset}.yaml")
    facts = read_publication_facts(facts_file(tmp_path))
    channels = [{"name": config.channels[0], "place": "casing", "axis": "vertical", "column": "accel_a_m_s2"}]
    found = isa_phm(config, facts, "text", channels, ["data/train-00000.parquet"])
    assert len(found["studies"]) == len(config.states)
    source = found["studies"][0]["materials"]["sources"][0]
    values = {c["category"]["@id"]: c["value"] for c in source["characteristics"]}
    assert (" to " in str(values["#characteristic/module"])) == bool(config.gears.pairs)
    assert len(found["studies"][0]["materials"]["samples"]) == len(config.operating_points)


def test_every_assay_names_quantity_and_unit_of_its_sensor(tmp_path: Path) -> None:
    path = tmp_path / "shafts.yaml"
    path.write_text(SHAFTS, encoding="utf-8")
    config = load_config(path)
    facts = read_publication_facts(facts_file(tmp_path))
    channels = [{"name": name, "place": "", "axis": "", "column": name} for name in config.channels]
    found = isa_phm(config, facts, "text", channels, ["data/train-00000.parquet"])
    shown = []
    for assay in found["studies"][0]["assays"]:
        values = {v["category"]["@id"]: v["value"] for v in assay["processSequence"][0]["parameterValues"]}
        shown.append((values["#parameter/quantity"], values["#parameter/unit"]))
    assert shown == [
        ("acceleration", "m/s^2"),
        ("angular speed", "rad/s"),
        ("angular speed", "rad/s"),
        ("transmission error", "um"),
        ("torque", "N m"),
        ("current", "A"),
    ]


@pytest.mark.slow  # installs isatools into an environment of its own: its pins exclude those of constraints.txt
@pytest.mark.timeout(900)
def test_isatools_loads_it_and_finds_nothing_of_the_file(published: Path, tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "isa"], check=True)
    python = tmp_path / "isa/bin/python"
    subprocess.run([python, "-m", "pip", "install", "-q", "isatools==0.14.3"], check=True)
    command = [python, "-W", "ignore", ROOT / "docs/scripts/isa_findings.py", published / "i_investigation.json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    said = [json.loads(line) for line in done.stdout.splitlines()]
    assert done.returncode == 0, done.stdout + done.stderr
    assert said == [{"studies": 2, "assays": 2}, {"of isatools": {"4002": 2, "1020": 2}}, {"of the file": []}]
