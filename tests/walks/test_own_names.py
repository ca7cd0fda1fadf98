"""A machine of three shafts by command, its gears, shafts and meshes named by its user: nobody says pinion.

The set is that of `tests.config.staged`, renamed: signals are equal to the bit. Its state and its sensor have the
program's own word in their names: these are data, which no table, document or page may rewrite.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import siggen
from diagnostics.judging.alarms import INDICATOR
from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.config import yaml_text
from siggen.errors import UsageError
from siggen.views.pressure import face_pressure
from tests.command import command
from tests.config.mill import mill
from tests.config.minimal import by_name
from tests.config.staged import SLOW, SPALL, staged
from tests.diagnostics.explore.unpacked import held
from tests.simulated import drawn_record, simulate

COMMON: dict[str, Any] = {
    "specimens": 4, "fs_hz": 12_800.0, "duration_s": 0.3, "manufacture": {"accuracy_class": 6, "flank_waves": "on"},
}  # fmt: skip


STATE, SENSOR = "pinion_spalled", "pinion_end"
CHANNEL = f"{SENSOR}_vertical"
SPELT = [name.replace("_", "_(<wbr>)?") for name in (STATE, SENSOR)]
OF_THE_USER = re.compile("|".join(SPELT))
"""Data that hold the program's word for a gear, as they stand in files and on pages."""


def states(gear: str) -> list[dict[str, Any]]:
    damage = {**SPALL, "gear": gear, "teeth": 1}
    return [{"name": "healthy"}, {"name": STATE, "severity": "severe", "damage": damage}]


def run(app: str, *arguments: object) -> str:
    """Return what a command printed."""
    done = command(app, *map(str, arguments))
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def words_of(file: Path) -> str:
    """Return all that a file says; of tables names and texts, of what a page's program reads what it shows."""
    if file.suffix == ".html":
        listed = held(file).get("look-data", {})
        columns = [one for group in ("labels", "indicators") for one in listed.get(group, [])]
        shown = [one.get(text, "") for one in columns for text in ("title", "definition")]
        document = re.sub(r"(?s)<script\b.*?</script>", "", file.read_text(encoding="utf-8"))
        return "\n".join([document, *shown])
    if file.suffix != ".parquet":
        return file.read_bytes().decode("utf-8", "replace")
    table = pq.read_table(file)
    texts = [text for one in table.columns if pa.types.is_string(one.type) for text in one.to_pylist()]
    return "\n".join([str(table.schema.to_string(truncate_metadata=False)), *map(str, texts)])


def said(folder: Path) -> dict[str, list[str]]:
    """Return file -> lines that call a gear as a pair does; data aside."""
    files = [file for file in folder.rglob("*") if file.is_file() and file.suffix != ".png"]
    assert files
    found = {
        str(file.relative_to(folder)): [
            line[:200] for line in OF_THE_USER.sub("", words_of(file)).splitlines() if "pinion" in line.lower()
        ]
        for file in files
    }
    return {file: lines for file, lines in found.items() if lines}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("mill")
    sensors = [{"name": SENSOR, "place": "output_bearing"}, {"kind": "encoder", "name": "out", "place": "karl"}]
    (folder / "mill.yaml").write_text(
        yaml_text(mill(**COMMON, sensors=by_name(sensors), states=by_name(states("eva"))))
    )
    printed = run("siggen", "generate", folder / "mill.yaml", "--out", folder / "set", "--executor", "serial")
    assert "pinion" not in OF_THE_USER.sub("", printed)
    return folder


def test_plan_set_card_and_records_say_the_users_names_alone(made: Path) -> None:
    plan = run("siggen", "plan", made / "mill.yaml", "--trial", 0)
    assert "mesh of fast" in plan
    assert "mesh of slow" in plan
    shown = run("siggen", "show", made / "set", "--record", 1, "--png", made / "record.png")
    shown += run("siggen", "show", made / "set", "--record", 1)
    assert "pinion" not in OF_THE_USER.sub("", plan + shown)
    assert said(made / "set") == {}
    card = siggen.open(made / "set").card()
    assert "`slow`, in which eva with 17 teeth drives karl with 52" in " ".join(card.split())
    assert f"* `{STATE}`: fault spalling" in card


def test_columns_and_labels_of_other_names_hold_the_same(made: Path) -> None:
    sensors = [{"name": SENSOR, "place": "slow_bearing"}, {"kind": "encoder", "name": "out", "place": "slow_gear"}]
    stage = {**SLOW, "gear": {"mass_kg": 6.0}, "span_mm": 120.0}
    short = siggen.load_config(
        staged(**COMMON, stages=[stage], sensors=by_name(sensors), states=by_name(states("slow_pinion")))
    )
    (other,) = simulate(short, [1])
    assert isinstance(other, SimulatedRecord)
    record = siggen.open(made / "set").record(1)
    for name, signal in other.channels.items():
        column = {CHANNEL: f"accel_{CHANNEL}_m_s2", "out_rotation": "speed_out_rotation_rad_s"}[name]
        np.testing.assert_array_equal(record[column], signal)
    names = {
        "teeth_pinion": "teeth_ida", "teeth_slow_gear": "teeth_karl", "faulty_teeth_slow_pinion": "faulty_teeth_eva",
        "pinion_shaft_hz": "input_shaft_hz", "slow_shaft_hz": "output_shaft_hz", "mesh_fast_hz": "mesh_fast_hz",
        "mesh_slow_hz": "mesh_slow_hz", "runout_gear_um": "runout_otto_um", "ghost_orders_pinion": "ghost_orders_ida",
    }  # fmt: skip
    assert {short: record[own] for short, own in names.items()} == {short: other.labels[short] for short in names}
    assert record["faulty_gear"] == "eva"
    assert siggen.open(made / "set").damage()["gear"].to_pylist() == ["eva"] * 4


def test_a_flank_is_asked_for_by_the_name_of_its_gear(made: Path) -> None:
    config = load_config(made / "mill.yaml")
    with pytest.raises(UsageError, match="--tooth pinion; allowed: ida, otto, eva, karl"):
        face_pressure(*drawn_record(config, 1), "pinion")
    assert face_pressure(*drawn_record(config, 1), "otto", 0).view.gear == "otto"


@pytest.mark.slow
def test_indicators_say_the_users_names_alone(made: Path) -> None:
    run("diagnostics", "indicators", made / "set", "--out", made / "indicators")
    assert said(made / "indicators") == {}
    names = pq.read_schema(made / "indicators/indicators.parquet").names
    assert f"sideband_ratio_ida_h1_k3__{CHANNEL}" in names
    assert f"sideband_ratio_eva_h1_k3__{CHANNEL}" in names
    assert f"snr_{CHANNEL}_db" in names
    values = pq.read_table(made / "indicators/indicators.parquet")["state"].to_pylist()
    assert values == siggen.open(made / "set").labels()["state"].to_pylist()
    numbers = json.loads((made / "indicators/indicators.json").read_text())
    assert numbers["states"] == [STATE]


@pytest.mark.slow
def test_a_report_says_the_users_names_alone(made: Path) -> None:
    run("diagnostics", "report", made / "set", "--out", made / "report", "--no-cnn")
    assert said(made / "report") == {}
    page = (made / "report/report.html").read_text()
    assert f">{STATE}<" in page.replace("<wbr>", "")
    assert "ida_spalled" not in page
    assert STATE in json.loads((made / "report/metrics.json").read_text())["detectors"]["alone"][INDICATOR]["states"]


@pytest.mark.slow
def test_an_audit_keeps_the_names_of_states(made: Path) -> None:
    run("diagnostics", "audit", made / "set", "--out", made / "audit")
    assert said(made / "audit") == {}
    strongest = json.loads((made / "audit/audit.json").read_text())["strongest"]
    assert {row["state"] for one in strongest.values() for row in one["states"]} == {STATE}


def test_a_message_repeats_what_the_file_says(made: Path) -> None:
    wrong = made / "wrong.yaml"
    wrong.write_text((made / "mill.yaml").read_text().replace("severity: severe", "severity: Pinion rough"))
    done = command("siggen", "plan", str(wrong))
    assert done.returncode == 2
    assert "received the text 'Pinion rough'" in done.stderr


@pytest.mark.slow
def test_the_explorer_draws_flanks_of_every_mesh_and_knows_the_users_names(made: Path) -> None:
    run("diagnostics", "explore", made / "set", "--out", made / "page.html")
    page = (made / "page.html").read_text()
    assert '"gears":["ida","otto"]' in page
    assert '"gear":"eva","tooth"' in page
    assert '"eva":{"face_mm":30.0' in page
