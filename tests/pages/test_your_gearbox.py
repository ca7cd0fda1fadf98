"""The commands of docs/start/your_gearbox.md run in their order on recordings of a machine that it does not know."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

import siggen
from diagnostics.cli.app import app as diagnostics_app
from siggen.cli.app import app as siggen_app
from tests.diagnostics.calibration.hidden_machine import HIDDEN, write_recording

PAGE = Path(__file__).resolve().parents[2] / "docs" / "start" / "your_gearbox.md"
APPS = {"siggen": siggen_app, "siggen-diagnostics": diagnostics_app}
SPALL = {"kind": "irregular", "gear": "pinion", "teeth": 1, "profile_length_mm": 1.5, "face_share": 1.0}


def commands() -> list[list[str]]:
    blocks = re.findall(r"^```console\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    return [shlex.split(line) for block in blocks for line in block.splitlines()]


def record(folder: Path) -> None:
    """Write four healthy recordings and one with a spalled tooth."""
    healthy = siggen.load_config(HIDDEN)
    names = ("may", "june", "july", "august")
    for name, result in zip(names, siggen.simulate(healthy, range(4)), strict=True):
        write_recording(result, folder / f"{name}.csv")
    damaged = siggen.load_config({**HIDDEN, "states": [{"name": "spalled", "severity": "severe", "damage": SPALL}]})
    write_recording(siggen.simulate(damaged, [1])[0], folder / "september.csv")


@pytest.mark.slow  # a set of 40 records, and a classifier on it
def test_the_page_leads_from_a_drawing_to_verdict_set_and_detector(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    record(tmp_path)
    monkeypatch.chdir(tmp_path)
    said = {}
    for program, *arguments in commands():
        result = CliRunner().invoke(APPS[program], arguments)
        allowed = {0, 4} if arguments[0] == "check" else {0}
        assert result.exit_code in allowed, (arguments, result.output, result.exception)
        said[arguments[0]] = result.output
    assert "august.csv: unchanged" in said["check"]
    assert "september.csv: changed" in said["check"]
    assert (tmp_path / "mine_data" / "calibration.html").stat().st_size > 50_000
    assert siggen.open("mine").labels().num_rows == 40
    assert (tmp_path / "beside.html").read_text().count("recording</bdi>") >= 5
    assert "changed" in said["predict"]
