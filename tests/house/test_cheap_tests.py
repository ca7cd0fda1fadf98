"""What keeps the suite short, where a machine can see it without a clock."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tests.house.source_tree import ROOT

FILES = sorted((ROOT / "tests").rglob("test_*.py"))
WORKERS_ARE_THE_SUBJECT = {"tests/cli/test_generate.py", "tests/sets/test_run_log.py", "tests/release/test_wheel.py"}
WHO_SIMULATES = {"--engine", "--workers", "engine", "workers"}


def calls(path: str) -> Iterator[ast.Call]:
    tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
    return (node for node in ast.walk(tree) if isinstance(node, ast.Call))


def makes_a_set(call: ast.Call, words: set[object]) -> bool:
    named = isinstance(call.func, ast.Attribute) and ast.unparse(call.func) == "siggen.generate"
    return named or {"generate", "--out"} <= words


def test_whoever_makes_a_set_says_who_simulates_it() -> None:
    """By default as many workers as cores do, and each start of one costs as much as ten short records."""
    silent = []
    for path in (str(file.relative_to(ROOT)) for file in FILES):
        for call in calls(path):
            words = {node.value for node in ast.walk(call) if isinstance(node, ast.Constant)}
            told = words | {keyword.arg for keyword in call.keywords}
            if makes_a_set(call, words) and not told & WHO_SIMULATES and path not in WORKERS_ARE_THE_SUBJECT:
                silent.append(f"{path}:{call.lineno}")
    assert silent == []
