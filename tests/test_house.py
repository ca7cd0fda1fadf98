"""The house rules that a machine can check: file and function length, names, docstrings, sources of randomness."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
CODE = sorted([*(ROOT / "siggen").rglob("*.py"), *(ROOT / "diagnostics").rglob("*.py")])
ALL = sorted([*CODE, *(ROOT / "tests").rglob("*.py"), *(ROOT / "benchmarks").rglob("*.py")])
FORBIDDEN_NAMES = {"utils", "util", "helpers", "common", "misc"}


def label(path: Path) -> str:
    return str(path.relative_to(ROOT))


def is_kernel(node: ast.FunctionDef) -> bool:
    """Compiled kernels may be longer: numba inlines poorly across many small functions."""
    return any("njit" in ast.unparse(d) for d in node.decorator_list)


def body_lines(node: ast.FunctionDef) -> int:
    body = node.body[1:] if ast.get_docstring(node) is not None else node.body
    return (body[-1].end_lineno or 0) - body[0].lineno + 1 if body else 0


@pytest.mark.parametrize("path", ALL, ids=label)
def test_a_file_holds_one_concept_of_at_most_350_lines(path: Path) -> None:
    assert len(path.read_text().splitlines()) <= 350
    assert path.stem not in FORBIDDEN_NAMES


@pytest.mark.parametrize("path", CODE, ids=label)
def test_functions_are_short(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.FunctionDef):
            limit = 150 if is_kernel(node) else 50
            assert body_lines(node) <= limit, f"{node.name} has {body_lines(node)} lines"


@pytest.mark.parametrize("path", CODE, ids=label)
def test_modules_and_public_names_are_documented(path: Path) -> None:
    tree = ast.parse(path.read_text())
    assert ast.get_docstring(tree), "module docstring"
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            assert ast.get_docstring(node), node.name


@pytest.mark.parametrize("path", [p for p in CODE if p.name != "seeding.py" and "siggen" in p.parts], ids=label)
def test_generators_are_made_in_one_place(path: Path) -> None:
    text = path.read_text()
    for call in ("default_rng(", "RandomState(", "SeedSequence(", "np.random.seed", "np.random.normal", "Philox("):
        assert call not in text


@pytest.mark.parametrize("path", CODE, ids=label)
def test_nothing_is_left_undone(path: Path) -> None:
    assert not re.search(r"\b(TODO|FIXME|XXX|raise NotImplementedError)\b", path.read_text())
