"""The command: help, version, errors without a traceback."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pyarrow.parquet as pq
import pytest
import typer

import diagnostics.cli.app
import siggen.cli.app
from diagnostics.cli.app import COMMANDS, main
from diagnostics.records.recording import LABEL_NAMES, TACHO_NAME
from siggen.cli.program import STAYS
from siggen.columns.labels import operating_columns, target_columns
from siggen.columns.record import ID_COLUMNS, TACHO_COLUMN
from siggen.dataset import reading
from siggen.errors import UsageError, how_to_install
from siggen.names import PAIR


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr(sys, "argv", ["siggen-diagnostics", *arguments])
    with pytest.raises(SystemExit) as stop:
        main()
    return int(stop.value.code or 0)


@pytest.mark.parametrize("command", [one for some in COMMANDS.values() for one in some])
def test_every_command_explains_itself_with_an_example(
    command: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, command.__name__, "-h") == 0
    assert "Example: siggen-diagnostics" in capsys.readouterr().out


def test_version(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(monkeypatch, "--version") == 0
    assert capsys.readouterr().out.startswith("siggen-diagnostics ")


def test_help_loads_nothing_heavy() -> None:
    heavy = ("numpy", "scipy", "torch", "sklearn", "pyarrow", "matplotlib")
    code = f"import sys, diagnostics.cli.app; print([m for m in {heavy} if m in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def test_missing_extra_names_the_line_that_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(
        "diagnostics.base.extras.missing_packages", lambda *names: ("skops",) if "skops" in names else ()
    )
    assert run(monkeypatch, "predict", str(tmp_path), "run.csv", "--teeth", "18,47") == 2
    assert how_to_install("diagnostics") in capsys.readouterr().err


def test_an_interruption_says_what_stays_and_how_to_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(path: Path) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(reading, "open", interrupted)
    assert run(monkeypatch, "report", str(tmp_path)) == 130
    assert capsys.readouterr().err == (
        "siggen-diagnostics: interrupted; the page is not written; the set is unchanged; indicators once taken stay "
        "beside it, and the same command goes on with them\n"
    )


@pytest.mark.parametrize("program", ["siggen", "siggen-diagnostics"])
def test_both_programs_word_every_kind_of_error_alike(
    program: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    module = {"siggen": siggen.cli.app, "siggen-diagnostics": diagnostics.cli.app}[program]
    monkeypatch.setattr(sys, "argv", [program])
    monkeypatch.delenv("SIGGEN_TRACEBACK", raising=False)
    again = "run again with SIGGEN_TRACEBACK=1 for details"
    expected = {
        UsageError("no such set"): (2, f"{program}: no such set\n"),
        KeyboardInterrupt(): (130, f"{program}: interrupted; {STAYS}\n"),
        ValueError("odd"): (
            1,
            f"{program}: unexpected ValueError: odd; {again}\n",
        ),
    }
    for error, (code, text) in expected.items():
        monkeypatch.setattr(typer.Typer, "__call__", Mock(side_effect=error))
        with pytest.raises(SystemExit) as stop:
            module.main()
        assert (stop.value.code, capsys.readouterr().err) == (code, text)
    monkeypatch.setenv("SIGGEN_TRACEBACK", "1")
    monkeypatch.setattr(typer.Typer, "__call__", Mock(side_effect=ZeroDivisionError))
    with pytest.raises(ZeroDivisionError):
        module.main()


def test_features_are_written_where_asked(
    make_dataset: Callable[..., Any],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(reading, "open", lambda path: make_dataset(("train", "test")))
    out = tmp_path / "sub" / "features.parquet"
    assert run(monkeypatch, "indicators", str(tmp_path), "--out", str(out)) == 0
    assert capsys.readouterr().out.strip() == str(out)
    table = pq.read_table(out)
    assert table.num_rows == 6
    assert set(table.column("revolutions_pinion").to_pylist()) <= {28, 29, 30}


def test_records_that_cannot_be_used_are_a_usage_error_with_a_way_out(
    make_dataset: Callable[..., Any],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    short = make_dataset(("test",) * 2, duration_s=0.15)  # four pinion revolutions, one of the gear
    monkeypatch.setattr(reading, "open", lambda path: short)
    # 7 / 30 s: six pinion revolutions at 30 Hz, and one until the first pulse
    assert run(monkeypatch, "indicators", str(tmp_path), "--out", str(tmp_path / "o")) == 2
    error = capsys.readouterr().err
    assert "not one of 6 records can be used" in error
    assert "they have to last 0.24 s" in error
    assert run(monkeypatch, "indicators", str(tmp_path), "--speed", "40,30") == 2
    assert "--speed: received 40 to 30 Hz" in capsys.readouterr().err


def test_columns_that_are_read_exist_in_every_set() -> None:
    columns = {column.name for column in (*ID_COLUMNS, *target_columns(PAIR), *operating_columns(PAIR), TACHO_COLUMN)}
    assert {*LABEL_NAMES, TACHO_NAME} <= columns
