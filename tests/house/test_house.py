"""The house rules that a machine can check; each test lists its offenders."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from pathlib import Path

from tests.house.source_tree import ROOT, tree

CODE = sorted([*(ROOT / "siggen").rglob("*.py"), *(ROOT / "diagnostics").rglob("*.py")])
ALL = sorted([*CODE, *(ROOT / "tests").rglob("*.py"), *(ROOT / "benchmarks").rglob("*.py")])
FORBIDDEN_NAMES = {"utils", "util", "helpers", "common", "misc"}
GENERATORS = ("default_rng(", "RandomState(", "SeedSequence(", "np.random.seed", "np.random.normal", "Philox(")
MOST_PARAMETERS = 8


def offenders(paths: list[Path], of_file: Callable[[Path], Iterator[str]]) -> str:
    return "\n".join(f"{path.relative_to(ROOT)}: {what}" for path in paths for what in of_file(path))


def is_kernel(node: ast.FunctionDef) -> bool:
    """Compiled kernels may be longer: numba inlines poorly across many small functions."""
    return any("njit" in ast.unparse(d) for d in node.decorator_list)


def body_lines(node: ast.FunctionDef) -> int:
    body = node.body[1:] if ast.get_docstring(node) is not None else node.body
    return (body[-1].end_lineno or 0) - body[0].lineno + 1 if body else 0


def test_a_file_holds_one_concept_of_at_most_350_lines() -> None:
    def found(path: Path) -> Iterator[str]:
        if (lines := len(path.read_text().splitlines())) > 350:
            yield f"{lines} lines"
        if path.stem in FORBIDDEN_NAMES:
            yield "a name that says nothing"

    assert not (listed := offenders(ALL, found)), listed


def test_functions_are_short() -> None:
    def found(path: Path) -> Iterator[str]:
        for node in ast.walk(tree(path)):
            if isinstance(node, ast.FunctionDef) and body_lines(node) > (150 if is_kernel(node) else 50):
                yield f"{node.name} has {body_lines(node)} lines"

    assert not (listed := offenders(CODE, found)), listed


def test_functions_have_few_parameters() -> None:
    def found(path: Path) -> Iterator[str]:
        for node in ast.walk(tree(path)):
            if isinstance(node, ast.FunctionDef):
                named = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
                if (count := sum(one.arg != "self" for one in named)) > MOST_PARAMETERS:
                    yield f"{node.name} has {count} parameters"

    assert not (listed := offenders(CODE, found)), listed


def test_modules_and_public_names_are_documented() -> None:
    def found(path: Path) -> Iterator[str]:
        if not ast.get_docstring(tree(path)):
            yield "no module docstring"
        for node in tree(path).body:
            public = isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_")
            if public and not ast.get_docstring(node):
                yield f"{node.name} has no docstring"

    assert not (listed := offenders(CODE, found)), listed


def test_generators_are_made_in_one_place() -> None:
    def found(path: Path) -> Iterator[str]:
        yield from (call for call in GENERATORS if call in path.read_text())

    paths = [path for path in CODE if path.name != "seeding.py" and "siggen" in path.parts]
    assert not (listed := offenders(paths, found)), listed


def test_nothing_is_left_undone() -> None:
    def found(path: Path) -> Iterator[str]:
        yield from re.findall(r"\b(TODO|FIXME|XXX|raise NotImplementedError)\b", path.read_text())

    assert not (listed := offenders(CODE, found)), listed


def test_array_types_are_declared_once() -> None:
    def found(path: Path) -> Iterator[str]:
        if path != ROOT / "siggen" / "arrays.py":
            yield from re.findall(r"^\w+ = NDArray\[.*$", path.read_text(), re.MULTILINE)

    assert not (listed := offenders(ALL, found)), listed
