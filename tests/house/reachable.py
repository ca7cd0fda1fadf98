"""Which functions, classes and constants of the packages code can reach: more rather than fewer.

A name is followed through imports, wherever they stand. An attribute may be the method of that name of every class that
is reached. Annotations count in command files, where they hold options.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path

from tests.house.source_tree import tree


class Code:
    """Everything that has a name in modules, by `module:name` or `module:class.method`."""

    def __init__(self, modules: Mapping[str, Path]) -> None:
        self.trees = {module: tree(path) for module, path in modules.items()}
        self.nodes: dict[str, list[ast.AST]] = {}
        self.classes: dict[str, dict[str, str]] = {}
        self.names: dict[str, dict[str, str]] = defaultdict(dict)
        for module, top in self.trees.items():
            self._import(module, top)
            for statement in top.body:
                self._define(module, statement)

    def _import(self, module: str, top: ast.Module) -> None:
        for node in ast.walk(top):
            if isinstance(node, ast.Import):
                self.names[module] |= {alias.asname or alias.name: alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module:
                for alias in node.names:
                    full = f"{node.module}.{alias.name}"
                    self.names[module][alias.asname or alias.name] = (
                        full if full in self.trees else f"{node.module}:{alias.name}"
                    )

    def _define(self, module: str, statement: ast.stmt) -> None:
        if isinstance(statement, ast.FunctionDef | ast.ClassDef):
            key = f"{module}:{statement.name}"
            self.names[module][statement.name] = key
            self.nodes[key] = [statement]
            if isinstance(statement, ast.ClassDef):
                methods = [part for part in statement.body if isinstance(part, ast.FunctionDef)]
                self.classes[key] = {method.name: f"{key}.{method.name}" for method in methods}
                self.nodes |= {f"{key}.{method.name}": [method] for method in methods}
                rest = [part for part in statement.body if part not in methods]
                self.nodes[key] = [*rest, *statement.bases, *statement.decorator_list]
        elif isinstance(statement, ast.Assign | ast.AnnAssign):
            targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
            for name in (part.id for target in targets for part in ast.walk(target) if isinstance(part, ast.Name)):
                self.names[module].setdefault(name, f"{module}:{name}")
                self.nodes.setdefault(f"{module}:{name}", []).append(statement)

    def _followed(self, key: str) -> str:
        """Return where a name is defined that a module only passes on."""
        seen: set[str] = set()
        while key not in self.nodes and key not in seen:
            seen.add(key)
            module, _, name = key.partition(":")
            key = self.names.get(module, {}).get(name, key)
        return key

    @cached_property
    def used(self) -> dict[str, tuple[set[str], set[str]]]:
        """What each uses: the keys of names, and the names of attributes."""
        return {key: self._used(key) for key in self.nodes}

    def _used(self, key: str) -> tuple[set[str], set[str]]:
        module = key.partition(":")[0]
        keys, attributes = set(), set()
        for node in (inner for outer in self.nodes[key] for inner in executed(outer, annotations=".cli." in module)):
            if isinstance(node, ast.Name) and node.id in self.names[module]:
                keys.add(self._followed(self.names[module][node.id]))
            elif isinstance(node, ast.Attribute):
                owner = self.names[module].get(node.value.id, "") if isinstance(node.value, ast.Name) else ""
                if owner in self.trees:
                    keys.add(self._followed(f"{owner}:{node.attr}"))
                attributes.add(node.attr)
        return keys, attributes

    def reached(self, start: str) -> set[str]:
        """Return the keys of all that code beginning at a key can use."""
        seen: set[str] = set()
        attributes: set[str] = set()
        waiting, unasked = [start], defaultdict(list)
        while waiting:
            key = waiting.pop()
            if key in seen or key not in self.nodes:
                continue
            seen.add(key)
            keys, said = self.used[key]
            waiting += keys
            for name in said - attributes:
                waiting += unasked.pop(name, ())
            attributes |= said
            for name, method in self.classes.get(key, {}).items():
                (waiting if name in attributes or name.startswith("__") else unasked[name]).append(method)
        return seen


def executed(node: ast.AST, *, annotations: bool) -> Iterator[ast.AST]:
    """Yield a node and what is below it, without docstrings and, unless wanted, annotations."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return
    yield node
    for field, value in ast.iter_fields(node):
        if field in ("annotation", "returns") and not annotations:
            continue
        for below in value if isinstance(value, list) else [value]:
            if isinstance(below, ast.AST):
                yield from executed(below, annotations=annotations)
