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


def offenders(paths: list[Path], of_file: Callable[[Path], Iterator[str]]) -> str:
    return "\n".join(f"{path.relative_to(ROOT)}: {what}" for path in paths for what in of_file(path))


def test_names_of_files_say_something() -> None:
    assert not (listed := [str(path.relative_to(ROOT)) for path in ALL if path.stem in FORBIDDEN_NAMES]), listed


def test_no_class_name_twice() -> None:
    places: dict[str, list[str]] = {}
    for path in CODE:
        for node in ast.walk(tree(path)):
            if isinstance(node, ast.ClassDef):
                places.setdefault(node.name, []).append(str(path.relative_to(ROOT)))
    assert {name: paths for name, paths in places.items() if len(paths) > 1} == {}


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


def test_texts_are_printed_in_one_way() -> None:
    """`siggen.cli.echo` makes them printable: they may hold names of strangers' files."""
    direct = {"print", "typer.echo", "typer.secho", "click.echo", "click.secho", "sys.stdout.write"}

    def found(path: Path) -> Iterator[str]:
        for node in ast.walk(tree(path)):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in direct:
                yield f"line {node.lineno}: {ast.unparse(node)[:80]}"

    allowed = {ROOT / "siggen/cli/echo.py", ROOT / "diagnostics/base/reading_process.py"}  # the latter to its parent
    assert not (listed := offenders([path for path in CODE if path not in allowed], found)), listed
