"""`siggen verify`: text, JSON and exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import siggen.sets.drawn
from siggen.cli.app import app
from siggen.errors import EXIT_MISMATCH, DatasetError
from tests.dataset.fake_set import FAKE_FILES, copy_fake_set, simulate


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(siggen.sets.drawn, "simulated", simulate)
    copy_fake_set(tmp_path / "set")
    return tmp_path / "set"


def test_a_set_that_is_as_promised_ends_with_0(folder: Path) -> None:
    result = CliRunner().invoke(app, ["verify", str(folder), "--sample", "2"])
    assert result.exit_code == 0
    assert f"{len(FAKE_FILES)} files" in result.stdout
    assert "2 records simulated again, compared bit for bit" in result.stdout
    assert "as its manifest promises" in result.stdout


def test_json_names_what_differs_and_the_exit_code_is_4(folder: Path) -> None:
    (folder / "README.md").write_text("x")
    result = CliRunner().invoke(app, ["verify", str(folder), "--json"])
    assert result.exit_code == EXIT_MISMATCH
    answer = json.loads(result.stdout)
    assert answer["ok"] is False
    assert [mismatch["what"] for mismatch in answer["mismatches"]] == ["README.md"]


def test_a_folder_that_is_no_set_is_a_usage_error(tmp_path: Path) -> None:
    result = CliRunner().invoke(app, ["verify", str(tmp_path)])
    assert isinstance(result.exception, DatasetError)
    assert result.exception.exit_code == 2
