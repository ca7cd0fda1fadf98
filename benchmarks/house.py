"""The repository measured against the goals of its layout: rooms, circles, lines of code, strict types."""

from __future__ import annotations

import ast
import importlib
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from benchmarks.row import Row

ROOT = Path(__file__).resolve().parents[1]
LOOSE = {"siggen": 5, "diagnostics": 2}
"""Goal: modules beside the rooms of a package."""
CODE_LINES = {"siggen": 22_000, "diagnostics": 14_000, "tests": 25_000, "benchmarks": 3_000, "docs/scripts": 2_000}
COMMANDS = {"siggen": 12, "diagnostics": 10}
ROOMS = ROOT / "tests" / "house" / "test_layering.py"


@dataclass(frozen=True, slots=True)
class Module:
    """One file: what it imports, wherever the import stands, and its lines of code."""

    path: Path
    imports: frozenset[str]
    code_lines: int


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield one row per goal; with `quick` without mypy, which takes most of the time."""
    packages = {name: _modules(name) for name in LOOSE}
    for name, found in packages.items():
        loose = [m for m in found.values() if m.path.parent == ROOT / name and m.path.name != "__init__.py"]
        yield _row(f"{name}: loose modules beside its rooms", len(loose), LOOSE[name])
    entries, numbers, astray = _floor_table()
    yield Row(
        "table of floors: entries, numbers in it, entries that are no room",
        f"{entries}, {numbers}, {astray}",
        goal="names alone",
        met=numbers == 0 and astray == 0,
    )
    circles = [circle for found in packages.values() for circle in _circles(found)]
    yield _row("circles, lazy and type imports counted", len(circles), 0)
    yield from _sizes(packages)
    if not quick:
        strict, of_decorators = _strict_errors()
        what = "mypy --strict: errors but those of numba's decorators"
        yield Row(what, f"{strict} (and {of_decorators} of decorators)", goal="0", met=strict == 0)


def _sizes(packages: Mapping[str, Mapping[str, Module]]) -> Iterator[Row]:
    """Yield what the repository asks a reader to know: code, words, configuration paths, commands."""
    for name, most in CODE_LINES.items():
        found = packages.get(name) or _modules(name)
        lines = sum(module.code_lines for module in found.values())
        yield Row(f"{name}: code lines (files)", f"{lines} ({len(found)})", goal=f"about {most}")
    words = sum(len(page.read_text(encoding="utf-8").split()) for page in (ROOT / "docs").rglob("*.md"))
    yield Row("words in docs", str(words), goal="about 50000")
    counted = re.search(r"There are (\d+) keys", (ROOT / "docs/reference/yaml.md").read_text(encoding="utf-8"))
    yield _row("configuration paths", int(counted.group(1)) if counted else 0, 200)
    for name, most in COMMANDS.items():
        app = importlib.import_module(f"{name}.cli.app").app
        yield _row(f"{name}: commands", len(app.registered_commands) + len(app.registered_groups), most)


def _row(what: str, value: int, most: int) -> Row:
    return Row(what, str(value), goal=f"<= {most}" if most else "0", met=value <= most)


def _modules(package: str) -> dict[str, Module]:
    paths = {_name(path): path for path in sorted((ROOT / package).rglob("*.py"))}
    return {name: _module(path, set(paths)) for name, path in paths.items()}


def _name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _module(path: Path, known: set[str]) -> Module:
    """Return a file's imports and lines of code; docstrings, comments and blank lines are none."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    imported: set[str] = set()
    texts: set[int] = set()
    code: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            code.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
            imported.update(_imported(node, known))
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            texts.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
        elif isinstance(node, (ast.stmt, ast.expr)):
            code.update((node.lineno, node.end_lineno or node.lineno))
    return Module(path, frozenset(imported), len(code - texts))


def _imported(node: ast.Import | ast.ImportFrom, known: set[str]) -> Iterator[str]:
    """Yield the modules of a package that a statement imports; `from a import b` is a.b where that is a module."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif node.module:
        for alias in node.names:
            full = f"{node.module}.{alias.name}"
            yield full if full in known else node.module


def _circles(found: Mapping[str, Module]) -> list[set[str]]:
    """Return the groups of modules that reach each other; packages that only name public functions do not count."""
    graph = {
        name: {other for other in module.imports if other in found and other != name}
        for name, module in found.items()
        if "." in name
    }
    reach = {name: _reached(graph, name) for name in graph}
    circles: list[set[str]] = []
    for name in graph:
        circle = {other for other in reach[name] if name in reach.get(other, ())}
        if circle and circle not in circles:
            circles.append(circle)
    return circles


def _reached(graph: Mapping[str, set[str]], start: str) -> set[str]:
    found: set[str] = set()
    waiting = list(graph[start])
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting.extend(graph.get(name, ()))
    return found


def _floor_table() -> tuple[int, int, int]:
    """Return entries of the tables of rooms, numbers in them, and entries that are neither folder nor module."""
    entries = numbers = astray = 0
    for node in ast.parse(ROOMS.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            package = node.targets[0].id.removesuffix("_ROOMS").lower()
            if package in LOOSE:
                values = [item.value for item in ast.walk(node.value) if isinstance(item, ast.Constant)]
                names = [value for value in values if isinstance(value, str)]
                places = [ROOT / package / name.replace(".", "/") for name in names]
                entries, numbers = entries + len(names), numbers + len(values) - len(names)
                astray += sum(not (place.is_dir() or place.with_suffix(".py").is_file()) for place in places)
    return entries, numbers, astray


def _strict_errors() -> tuple[int, int]:
    """Return errors of mypy --strict, and those of decorators without types among them, which are numba's."""
    said = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--no-incremental", "--no-pretty", *LOOSE],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if said.returncode not in {0, 1}:
        raise RuntimeError(f"mypy: {said.stdout[-500:]}{said.stderr[-500:]}")
    errors = re.findall(r": error: .*\[([a-z-]+)\]$", said.stdout, re.MULTILINE)
    of_decorators = errors.count("untyped-decorator")
    return len(errors) - of_decorators, of_decorators
