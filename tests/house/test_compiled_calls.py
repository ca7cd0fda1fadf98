"""Compiled functions that Python calls are entries; all others are compiled without what only Python needs."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from tests.house.source_tree import ROOT, imports, tree

DECORATORS = {"njit", "entry", "overload"}  # what an overload names, compiled code calls
FOLDERS = ("siggen", "diagnostics", "benchmarks", "tests", "docs")


@cache
def files() -> dict[str, Path]:
    """Return module -> file of all that may hold or call a compiled function."""
    found = (file for folder in FOLDERS for file in sorted((ROOT / folder).rglob("*.py")))
    return {".".join(file.relative_to(ROOT).with_suffix("").parts): file for file in found}


def decorator(node: ast.AST) -> str | None:
    """Return how a function is compiled, None for one that is not."""
    names = (getattr(one, "func", one) for one in getattr(node, "decorator_list", ()))
    return next((name.id for name in names if isinstance(name, ast.Name) and name.id in DECORATORS), None)


@cache
def compiled() -> dict[tuple[str, str], str]:
    """Return (module, function) -> decorator of all functions that the package's compiler compiles."""
    found = {}
    for module, file in files().items():
        if "siggen.compiled" in file.read_text(encoding="utf-8") and "siggen.compiled" in imports(file, set()):
            functions = (node for node in ast.walk(tree(file)) if isinstance(node, ast.FunctionDef))
            found |= {(module, node.name): how for node in functions if (how := decorator(node))}
    return found


def known(module: str, file: Path) -> dict[str, tuple[str, str]]:
    """Return how a file's Python writes compiled functions, also behind a module's name -> (module, function)."""
    found = {name: (home, name) for home, name in compiled() if home == module}
    imports_from = (node for node in ast.walk(tree(file)) if isinstance(node, ast.ImportFrom))
    for home, alias in ((node.module or "", alias) for node in imports_from for alias in node.names):
        named, inside = alias.asname or alias.name, f"{home}.{alias.name}"
        if (home, alias.name) in compiled():
            found[named] = (home, alias.name)
        elif inside in files():
            found |= {f"{named}.{name}": (inside, name) for other, name in compiled() if other == inside}
    return found


def by_python(node: ast.AST) -> Iterator[ast.Name | ast.Attribute]:
    """Yield the names that stand outside of compiled functions."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, (ast.Name, ast.Attribute)) and isinstance(child.ctx, ast.Load):
            yield child
        if decorator(child) is None:
            yield from by_python(child)


@cache
def callers() -> dict[tuple[str, str], set[str]]:
    """Return compiled functions that Python calls or hands on -> where."""
    found: dict[tuple[str, str], set[str]] = {}
    ends = re.compile(rf"\b({'|'.join(sorted({home.rpartition('.')[2] for home, _ in compiled()}))})\b")
    homes = {home for home, _ in compiled()}
    for module, file in files().items():
        may_call = module in homes or ends.search(file.read_text(encoding="utf-8"))
        names = known(module, file) if may_call else {}
        last = {name.rpartition(".")[2] for name in names}
        for node in by_python(tree(file)) if names else ():
            ends_in = node.id if isinstance(node, ast.Name) else node.attr
            if ends_in in last and (named := ast.unparse(node)) in names:
                found.setdefault(names[named], set()).add(f"{file.relative_to(ROOT)}:{node.lineno}")
    return found


def test_python_calls_no_function_that_is_compiled_for_compiled_code_alone() -> None:
    inner = {name for name, how in compiled().items() if how == "njit"}
    wrong = {".".join(name): sorted(where) for name, where in callers().items() if name in inner}
    assert wrong == {}, "decorate these with @entry, which adds what Python needs, or call them from compiled code"


def test_every_entry_has_a_caller_in_python() -> None:
    unused = {".".join(name) for name, how in compiled().items() if how == "entry" and name not in callers()}
    assert unused == set(), "decorate these with @njit: what Python needs costs compilation"
