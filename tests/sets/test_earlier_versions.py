"""Sets of other versions of siggen are refused in words."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import siggen
from siggen.cli.app import app
from siggen.columns.versions import SIMULATION_VERSION
from siggen.dataset.seal import sealed, unsealed
from siggen.errors import DatasetError
from siggen.sets.verification import verify
from tests.dataset.fake_set import copy_fake_set, write_fake_set


def say(folder: Path, **facts: object) -> None:
    """Change what a manifest says about its set, and seal it again."""
    manifest = folder / "manifest.json"
    manifest.write_bytes(sealed({**unsealed("manifest.json", manifest.read_bytes()), **facts}))


@pytest.mark.parametrize("version", ["7", "99"])
def test_a_set_of_another_version_is_refused_in_words_by_whatever_reads_it(tmp_path: Path, version: str) -> None:
    copy_fake_set(tmp_path)
    say(tmp_path, schema_version=version)
    (tmp_path / "config.yaml").write_text("gears: {a_key_that_is_gone: 206}")  # the version speaks before its keys
    for reads in (siggen.open, verify, write_fake_set):
        with pytest.raises(DatasetError, match=f"received schema version {version}; allowed is 8. Another version"):
            reads(tmp_path)


def test_records_of_another_simulation_are_not_simulated_again_and_that_is_said(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    other = SIMULATION_VERSION + 1
    say(tmp_path, simulation_version=other)
    result = CliRunner().invoke(app, ["verify", str(tmp_path), "--sample", "3"])
    assert result.exit_code == 0, result.output
    told = f"hashes checked; 3 records not simulated again: made by simulation version {other}, this is {other - 1}"
    assert told in result.stdout.splitlines()
    found = json.loads(CliRunner().invoke(app, ["verify", str(tmp_path), "--json"]).stdout)
    assert found["records"] == []
    assert found["ok"]
