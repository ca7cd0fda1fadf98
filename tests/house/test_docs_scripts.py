"""Scripts of the documentation find what they import: a moved module breaks them here, not at a reader's."""

from __future__ import annotations

import ast
import importlib
from pathlib import Path

import pytest

from tests.house.source_tree import ROOT

FOLDER = ROOT / "docs" / "scripts"
SCRIPTS = sorted(FOLDER.glob("*.py"))


def wanted(path: Path) -> list[tuple[str, str]]:
    """Return (module, name) of every import of a script, inside functions too; an empty name for whole modules."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [(alias.name, "") for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            found += [(node.module, alias.name) for alias in node.names]
    return found


def found(module: str, name: str) -> bool:
    """Return whether an import succeeds, as Python does it: an attribute, else a submodule."""
    try:
        if not name or hasattr(importlib.import_module(module), name):
            importlib.import_module(module)
            return True
        importlib.import_module(f"{module}.{name}")
    except ImportError:
        return False
    return True


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_all_imports_of_a_script_are_there(script: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(FOLDER)  # a script may import one beside it
    assert [f"{module}: {name}" for module, name in wanted(script) if not found(module, name)] == []


def test_a_moved_module_and_a_renamed_function_are_noticed(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text("import siggen.moved\ndef f():\n    from siggen.errors import Renamed, UsageError\n")
    assert [pair for pair in wanted(script) if not found(*pair)] == [("siggen.moved", ""), ("siggen.errors", "Renamed")]
