"""Modules of the two packages, and what each imports: at its top, inside functions, or for types alone."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def modules(package: str) -> dict[str, Path]:
    return {module_name(p): p for p in sorted((ROOT / package).rglob("*.py"))}


@cache
def tree(path: Path) -> ast.Module:
    """Return a file's syntax; parsed when a test asks for it, since collecting tests costs every process."""
    return ast.parse(path.read_text(encoding="utf-8"))


def imports(path: Path, known: set[str]) -> set[str]:
    """Every imported module, wherever the import stands; `from a import b` counts as a.b where that is a module."""
    found: set[str] = set()
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            full = (f"{node.module}.{alias.name}" for alias in node.names)
            found.update(name if name in known else node.module for name in full)
    return found
