"""`siggen-diagnostics report` of gearboxes that run to failure."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import siggen
from diagnostics.cli.app import app
from siggen.checks.loading import load_config
from siggen.errors import DatasetError, UsageError
from tests.diagnostics.explore.unpacked import held, listed
from tests.sets.test_lives import lives

RARE = {"interval_h": 1.5, "most": 6}
"""Three inspections of each gearbox."""


@pytest.fixture(scope="module")
def fleet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("fleet") / "set"
    raw = {**lives(RARE), "specimens": 4, "duration_s": 0.2}
    siggen.generate(load_config(raw), path, workers=0)
    return path


def report(*arguments: str) -> str:
    """Return what the command says; its errors are raised."""
    return CliRunner().invoke(app, ["report", *arguments], catch_exceptions=False).output


@pytest.fixture(scope="module")
def judged(fleet: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """Return the page of the set, by a network of few steps, and what the command printed."""
    out = tmp_path_factory.mktemp("judged")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("diagnostics.training.life_network.STEPS", 20)
        metrics = json.loads(report(str(fleet), "--json", "--out", str(out)))
    return out / "report.html", metrics


def test_a_report_of_lives_judges_baselines_of_remaining_life(fleet: Path, judged: tuple[Path, dict[str, Any]]) -> None:
    page, metrics = judged
    assert "five indicators, age" in page.read_text(encoding="utf-8")
    assert metrics["gearboxes_judged"] == 4
    assert list(metrics["baselines"])[:2] == ["constant", "age"]
    assert {"oil debris, age", "five indicators with their history, age"} < set(metrics["baselines"])
    assert "sequence network on averages, age" in metrics["baselines"]
    assert metrics["first_detection"]["pictures"]["detected"] == 4
    assert "hours since the inspections before" in [leak["clue"] for leak in metrics["leaks"]]
    rows = {row["record_id"]: row for row in siggen.open(fleet).life("inspections").to_pylist()}
    outlook = siggen.open(fleet).life("outlook").to_pylist()
    error_h = np.array([row["rul_q50_h"] - rows[row["record_id"]]["rul_h"] for row in outlook])
    known = metrics["baselines"]["the true state itself"]["rmse_h"][0]["value"]
    assert known == pytest.approx(np.sqrt(np.mean(error_h**2)), rel=1e-12)


def test_the_page_shows_each_gearbox_over_its_life_and_each_record_with_its_age(
    fleet: Path, judged: tuple[Path, dict[str, Any]]
) -> None:
    page, _ = judged
    found = held(page)
    lives = [value for name, value in found.items() if name.startswith("look-life-")]
    assert len(lives) == 4
    assert all(base64.b64decode(one["png"]).startswith(b"\x89PNG") for one in lives)
    ages = {row["record_id"]: row["age_h"] for row in siggen.open(fleet).life("inspections").to_pylist()}
    assert {record["record_id"]: record["age_h"] for record in listed(found["look-data"])} == pytest.approx(ages)
    said = page.read_text(encoding="utf-8").split('<section class="answer"')[1]
    assert re.search(r"<h2>What is found</h2><p><b>.*</b> tell the remaining life to <b>\d+ h</b>", said)
    assert "<b>4 gearboxes that failed</b>" in said


@pytest.mark.parametrize("command", ["audit", "indicators"])
def test_what_compares_states_refuses_lives_and_says_what_judges_them(fleet: Path, command: str) -> None:
    with pytest.raises(UsageError, match=r"received a set of lives, .* report judges what tells them"):
        CliRunner().invoke(app, [command, str(fleet)], catch_exceptions=False)


def test_options_of_sets_of_states_are_refused(fleet: Path) -> None:
    with pytest.raises(UsageError, match="--predictions: for sets of states; this one has lives"):
        report(str(fleet), "--predictions", "mine.csv")


def test_too_few_failed_gearboxes_are_refused_with_a_way_on(tmp_path: Path) -> None:
    siggen.generate(load_config({**lives(RARE), "specimens": 1}), tmp_path / "set", workers=0)
    with pytest.raises(DatasetError, match=r"received 1 failed of 1 gearboxes; allowed: at least 4 .* \(specimens\)"):
        report(str(tmp_path / "set"))
