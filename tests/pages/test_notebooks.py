"""Notebooks are kept without outputs, and call what is there."""

from __future__ import annotations

import ast
import json
import re
import shlex
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from tests.every_command import COMMANDS, LEAVES

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
PACKAGES = ("siggen", "diagnostics")


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


def uses(tree: ast.AST) -> Iterator[tuple[str, str]]:
    """Yield (module, name) of what a cell takes from the packages: imports, and attributes of imported packages."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and str(node.module).partition(".")[0] in PACKAGES:
            yield from ((str(node.module), alias.name) for alias in node.names)
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in PACKAGES:
            yield node.value.id, node.attr


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_what_a_notebook_calls_exists(path: Path) -> None:
    """Cells are executed where the site is built (test_site.py), four minutes of CPU time."""
    called: set[object] = set()
    for source in ("".join(cell["source"]) for cell in cells(path) if cell["cell_type"] == "code"):
        if source.startswith("%%"):
            for line in re.findall(r"^siggen.*$", source.replace("\\\n", " "), re.MULTILINE):
                name = max((name for name in LEAVES if f"{line} ".startswith(f"{name} ")), key=len)
                options = {word for one in COMMANDS[name].params for word in (*one.opts, *one.secondary_opts)}
                assert {word for word in shlex.split(line) if word.startswith("--")} <= options
                called.add(name)
        else:
            for module, name in uses(ast.parse(source)):
                assert hasattr(import_module(module), name), f"{module}.{name}"
                called.add((module, name))
    assert called
