"""`siggen-diagnostics audit`: files, exit codes, messages, and the card."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from planted_set import Plant, PlantedSet, planted
from scipy.io import wavfile

from diagnostics.audit import bank, condition_leaks, signal_detectors
from diagnostics.cli.app import main
from siggen.dataset import reading


@pytest.fixture(scope="module")
def perfect_gears() -> PlantedSet:
    return planted(Plant(specimens=4, points=1, error_depth=0.0))


@pytest.fixture(scope="module")
def clean() -> PlantedSet:
    return planted(Plant(specimens=6))


@pytest.fixture(autouse=True)
def quick_bank(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few steps of training and few permutations: what they find is tested with the detectors."""
    monkeypatch.setattr(condition_leaks, "PERMUTATIONS", 19)
    monkeypatch.setattr(bank, "PERMUTATIONS", 19)
    monkeypatch.setattr(signal_detectors, "SHOWN", 0)
    monkeypatch.setattr(signal_detectors, "FEWEST_EPOCHS", 1)
    monkeypatch.setattr(signal_detectors, "DILATIONS", (1, 8))


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr(sys, "argv", ["siggen-diagnostics", "audit", *arguments])
    try:
        main()
    except SystemExit as stop:
        return int(stop.code or 0)
    return 0


def test_a_finding_fails_with_strict(
    perfect_gears: PlantedSet, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(reading, "open", lambda path: perfect_gears)
    assert run(monkeypatch, "anything", "--out", str(tmp_path), "--strict") == 4
    shown = capsys.readouterr()
    assert shown.out.startswith("Scores on this set do not measure damage alone: ")
    assert "healthy_without_sidebands" in shown.out
    assert "--strict" in shown.err
    numbers = json.loads((tmp_path / "audit.json").read_text())
    assert [finding["leak"] for finding in numbers["findings"]] == ["healthy_without_sidebands"]


def test_a_clean_set_passes_strict_and_the_report_holds_every_part(
    clean: PlantedSet, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(reading, "open", lambda path: clean)
    recordings = tmp_path / "healthy"
    recordings.mkdir()
    noise = 0.1 * np.random.default_rng(1).standard_normal(26_000)
    wavfile.write(recordings / "one.wav", 12_800, noise.astype(np.float32))
    given = ("--reference", str(recordings))
    assert run(monkeypatch, "x", "--out", str(tmp_path), "--strict", *given) == 0
    assert capsys.readouterr().out.strip().endswith("audit.html")
    page = (tmp_path / "audit.html").read_text()
    for part in (
        "No leak",
        "Against healthy gearboxes",
        "Spread between the sensors",
        "Best of",
        "stays below",
        "Random convolutions",
        "Against your recordings",
        "Windows of one recording do not count as several",
        "base64",
    ):
        assert part in page
    assert "http" not in page.replace("http-equiv", "")
    assert len(json.loads((tmp_path / "audit.json").read_text())["realism"]["quantities"]) == 13


def test_too_few_gearboxes_do_not_pass_and_no_file_names_a_length(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    few = planted(Plant(specimens=4, points=1))
    monkeypatch.setattr(reading, "open", lambda path: few)
    assert run(monkeypatch, "x", "--out", str(tmp_path), "--strict") == 4
    shown = capsys.readouterr()
    assert shown.out.startswith("There are too few gearboxes to tell: chance reaches an AUC of ")
    assert "not passed (--strict)" in shown.err
    page, numbers = (tmp_path / "audit.html").read_text(), json.loads((tmp_path / "audit.json").read_text())
    assert numbers["findings"] == []
    assert numbers["gearboxes_needed"] > 10  # 4 (0.4 / 0.25)^2
    for text in (shown.out, page, json.dumps(numbers)):
        assert "No leak was found" not in text
        assert "is reached from" not in text
        assert "Interpolated damaged area" not in text
    areas = [entries["damaged_area_mm2_at_auc"] for entries in numbers["strongest"].values()]
    assert {area for by_auc in areas for faults in by_auc.values() for area in faults.values()} <= {None}


def test_a_folder_without_a_set_is_a_usage_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, str(tmp_path / "nothing")) == 2
    assert "no data set here" in capsys.readouterr().err
    assert not (tmp_path / "nothing").exists()
    (tmp_path / "photo.jpg").write_bytes(b"x")
    assert run(monkeypatch, str(tmp_path)) == 2
    assert "not a siggen data set" in capsys.readouterr().err


def test_help_has_an_example(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(monkeypatch, "-h") == 0
    assert "Example: siggen-diagnostics audit" in capsys.readouterr().out
