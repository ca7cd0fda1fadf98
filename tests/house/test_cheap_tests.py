"""What keeps the suite short, where a machine can see it without a clock."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tests.house.source_tree import ROOT

FILES = sorted((ROOT / "tests").rglob("test_*.py"))
WORKERS_ARE_THE_SUBJECT = {"tests/cli/test_generate.py", "tests/sets/test_run_log.py", "tests/release/test_wheel.py"}
FRESH_COMMANDS = {
    "tests/cli/test_app.py", "tests/config/test_presets.py",
    "tests/diagnostics/cli/test_two_stages.py", "tests/diagnostics/cli/test_planetary_reports.py",
    "tests/diagnostics/prediction/test_gearbox_answer.py",
}  # fmt: skip
"""Beside walks and pages: fresh processes are their subject, or their tests are slow ones."""
WHO_SIMULATES = {"--executor", "--workers", "executor", "workers"}


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


def test_commands_run_in_their_tests_process_unless_a_fresh_one_is_the_subject() -> None:
    """`tests.command` runs them: the start of one costs more than most of them do."""
    code = "from .*cli" + ".app import main; main"
    fresh = {str(file.relative_to(ROOT)) for file in FILES if re.search(code, file.read_text(encoding="utf-8"))}
    assert fresh <= FRESH_COMMANDS
