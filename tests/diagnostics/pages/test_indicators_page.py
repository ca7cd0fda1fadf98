"""The page docs/understand/indicators.md runs as it stands, and its table is that of the registry."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from diagnostics.cli.app import main as diagnostics_main
from diagnostics.indicators.own_indicator import unregister
from diagnostics.indicators.registry import ALL, definition_table
from siggen.cli.app import main as siggen_main

PAGE = (Path(__file__).resolve().parents[3] / "docs" / "understand" / "indicators.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def command(line: str, monkeypatch: pytest.MonkeyPatch) -> int:
    program, *arguments = shlex.split(line)
    monkeypatch.setattr(sys, "argv", [program, *arguments])
    try:
        {"siggen": siggen_main, "siggen-diagnostics": diagnostics_main}[program]()
    except SystemExit as stop:
        return int(stop.code or 0)
    return 0


def test_table_of_definitions_is_the_registrys() -> None:
    assert definition_table() in PAGE
    for definition in ALL:
        assert all((definition.title, definition.signal, definition.formula, definition.known, definition.undefined))


@pytest.mark.slow  # makes a set, ranks it three times
def test_page_runs_from_yaml_to_ranking(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    monkeypatch.delitem(sys.modules, "my_indicators", raising=False)
    try:
        for language, name, code in BLOCK.findall(PAGE):
            if language == "yaml":
                Path("indicators.yaml").write_text(code, encoding="utf-8")
            elif name:
                Path(name).write_text(code, encoding="utf-8")
            elif language == "sh":
                assert command(code, monkeypatch) == 0, capsys.readouterr().err
            else:
                exec(compile(code, "docs/understand/indicators.md", "exec"), {"__name__": "page"})
    finally:
        unregister("peak_to_peak")
    ranking = pq.read_table("ranking/evaluation.parquet")
    assert {"fm4_pinion", "mesh_band_rms"} <= set(ranking.column("indicator").to_pylist())
    assert Path("ranking/indicators.html").stat().st_size > 100_000
