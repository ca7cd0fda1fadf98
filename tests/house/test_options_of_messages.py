"""An option that a message or page names is one of the command that prints it, or of the command that it names."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from diagnostics.cli.check import _in_words_of_check
from tests.every_command import COMMANDS, LEAVES
from tests.house.reachable import Code, executed
from tests.house.source_tree import ROOT, modules

OPTION = re.compile(r"(?<![\w-])(?<!var\()--[a-z][a-z-]*[a-z](?![\w-]*:\S)")
"""Not the colours of a style sheet, `--ink:#123456` and `var(--ink)`."""
REFUSED = re.compile(r"--[a-z-]+(?=: | \{|$)")
"""At its beginning a message names the option whose value it refuses; it is printed where that option was given."""
READ_AS = {
    "siggen-diagnostics check": "siggen-diagnostics baseline",
    "siggen-diagnostics audit": "siggen-diagnostics indicators",
}
"""`check` reads files as the machine was told by `baseline`, `audit` without being told; their messages say so."""


OPTIONS = {
    name: {"--help", "--version", *(word for one in command.params for word in (*one.opts, *one.secondary_opts))}
    for name, command in COMMANDS.items()
}
NAMES = sorted({*LEAVES, *(f"`{name.partition(' ')[2]}" for name in LEAVES)}, key=len, reverse=True)
TEMPLATES = {file.name: file.read_text(encoding="utf-8") for file in ROOT.glob("diagnostics/*/templates/*")}
NAMED = re.compile(rf"({'|'.join(map(re.escape, NAMES))})(?![\w-])")


@cache
def code() -> Code:
    return Code({**modules("siggen"), **modules("diagnostics")})


@cache
def printing() -> dict[str, set[str]]:
    """Return the commands that reach each function, class and constant of both packages."""
    found: dict[str, set[str]] = {key: set() for key in code().nodes}
    for name in LEAVES:
        function = COMMANDS[name].callback
        while hasattr(function, "__wrapped__"):
            function = function.__wrapped__
        for key in code().reached(f"{function.__module__}:{function.__qualname__}"):
            found[key].add(name)
    return found


def texts(node: ast.AST) -> Iterator[str]:
    """Yield the texts of a node, of a formatted one with {} where values come; of a template it names, its parts."""
    inside: set[int] = set()
    for part in executed(node, annotations=True):
        if isinstance(part, ast.JoinedStr):
            inside |= {id(value) for value in part.values}
            yield "".join(value.value if isinstance(value, ast.Constant) else "{}" for value in part.values)
        elif isinstance(part, ast.Constant) and isinstance(part.value, str) and id(part) not in inside:
            yield part.value
            yield from TEMPLATES.get(part.value, "").split("\n\n")


def strangers(text: str, printed_by: set[str]) -> list[str]:
    """Return which options of a text are none of the command named before them, else none of those that print it."""
    found = []
    for match in OPTION.finditer(text):
        if named := NAMED.findall(text[: match.start()]):
            owners = {name for name in LEAVES if named[-1] in (name, f"`{name.partition(' ')[2]}")}
            lacking = owners if not any(match[0] in OPTIONS[name] for name in owners) else set()
        else:
            lacking = {name for name in printed_by if match[0] not in OPTIONS[name] | OPTIONS[READ_AS.get(name, name)]}
            if match.start() == 0 and REFUSED.match(text) and lacking < printed_by:
                lacking = set()
        found += [f"{match[0]} of {', '.join(sorted(lacking))}"] if lacking else []
    return found


def test_every_option_in_a_text_is_one_of_the_command_that_prints_it() -> None:
    wrong = {}
    for key, nodes in code().nodes.items():
        for text in (text for node in nodes for text in texts(node)):
            if found := strangers(text, printing()[key]):
                wrong[f"{key}: {text[:80]}"] = found
    assert not wrong


def test_the_walk_finds_who_prints_what() -> None:
    by = printing()
    readers = {f"siggen-diagnostics {name}" for name in ("baseline", "check", "explore", "indicators", "predict")}
    assert by["diagnostics.recordings.measured_recording:_mapping"] >= readers
    assert by["siggen.sets.loss_limit:LossLimit._message"] >= {"siggen generate"}
    assert by["siggen.cli.tvms:tvms"] == {"siggen inspect"}
    assert not by["diagnostics.cli.recording_options:RecordingOptions"] & {"siggen-diagnostics score"}


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("name it with --channel", True),
        ("`siggen-diagnostics report` takes --channel", False),
        ("`siggen verify SET` compares; else --channel", True),
        ("with `baseline --load slip`", False),
        ("leave --leave-out out", True),
        ("--ink:#123456;color:var(--ink)", False),
    ],
)
def test_an_option_that_the_command_lacks_is_noticed(text: str, found: bool) -> None:
    assert bool(strangers(text, {"siggen-diagnostics score"})) == found


def test_check_says_whose_options_a_message_of_a_file_names() -> None:
    said = _in_words_of_check("a.csv: give the rate, e.g. --fs 51200", Path("rig"))
    assert "are those of `siggen-diagnostics baseline`" in said
    assert said.endswith("--rig rig.yaml")
    assert _in_words_of_check("a.csv: no unit; see --rig", Path("rig")).endswith("no unit; see --rig")
