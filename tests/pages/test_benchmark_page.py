"""The measured part of docs/develop/benchmarks.md is what its script prints from the results that are committed."""

from __future__ import annotations

import importlib.util
import json
from types import ModuleType
from typing import Any

import pytest

from tests.house.source_tree import ROOT

PAGE = ROOT / "docs" / "develop" / "benchmarks.md"
RESULTS = [PAGE.with_name("benchmarks.json")]


def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("benchmark_page", ROOT / "docs" / "scripts" / "benchmark_page.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def row(what: str, **values: Any) -> dict[str, Any]:
    empty = {"measured": "", "alternative": "", "ratio": None, "goal": "", "met": None, "numbers": None}
    return {"what": what, **empty, **values}


def test_rows_with_a_goal_become_lines_and_points_of_the_figure_none() -> None:
    point = {"law": "linear", "method": "product", "setting": "4 steps", "cost_s": 0.05, "error": 2e-5, "rule": True}
    rows = [row("a | b", measured="1 s", ratio=2.0, goal="<= 2 s", met=True), row("aside"), row("c", numbers=point)]
    topics = {"precision": {"rows": rows}, "storage": {"rows": [row("not on the page")]}}
    text = script().printed([{"machine": ["a machine"], "topics": topics}])
    assert text.startswith("a machine.")
    assert "| precision: a / b | 1 s |  (×2) | <= 2 s: met |" in text
    assert not any(word in text for word in ("aside", "| c |", "not on the page"))


def test_the_page_holds_what_is_printed_from_the_committed_results() -> None:
    page = PAGE.read_text(encoding="utf-8")
    tables = script().printed([json.loads(file.read_text(encoding="utf-8")) for file in RESULTS])
    assert script().with_tables(page, tables) == page
    with pytest.raises(ValueError, match="without"):
        script().with_tables("no marks", tables)
