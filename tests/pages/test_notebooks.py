"""Notebooks run from their first to their last cell, and are kept without outputs."""

from __future__ import annotations

import importlib.util
import json
import re
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
IN_DEFAULT = "own_gearbox"
"""Shows the commands and the Python interface, and is the fastest: 11 s of CPU time."""


def cells(path: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return found


def test_there_are_five_and_the_page_lists_them() -> None:
    page = (ROOT / "docs/notebooks/README.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"\((\w+\.ipynb)\)", page)) == [path.name for path in NOTEBOOKS]
    assert len(NOTEBOOKS) == 5


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_has_no_outputs_and_its_links_lead_to_pages(path: Path) -> None:
    for cell in cells(path):
        if cell["cell_type"] == "code":
            assert (cell["outputs"], cell["execution_count"]) == ([], None)
        for target in re.findall(r"\]\(([^)#]+\.md)", "".join(cell["source"])):
            assert (path.parent / target).is_file(), target


@pytest.mark.timeout(1200)
@pytest.mark.filterwarnings("ignore")
def test_a_notebook_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The other four are executed where the site is built (test_site.py)."""
    pytest.importorskip("ipykernel")
    pytest.importorskip("nbclient")
    monkeypatch.setenv("PATH", "/usr/bin:/bin")
    spec = importlib.util.spec_from_file_location("run_notebooks", ROOT / "docs/scripts/run_notebooks.py")
    assert spec is not None
    assert spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    monkeypatch.setattr(script, "KEPT", tmp_path)  # no copy of an earlier run
    notebook = script.executed(script.FOLDER / f"{IN_DEFAULT}.ipynb")
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    assert not [output for output in outputs if output.output_type == "error"]
    assert any("image/png" in output.get("data", {}) for output in outputs)
