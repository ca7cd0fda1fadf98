"""Examples of sets have one home, `runs/`, so that every printed line can be copied after the one before it."""

from __future__ import annotations

import re

from tests.house.source_tree import ROOT

COMMAND = re.compile(r"(?<![\w/])siggen(?:-diagnostics)? [a-z][^\n`]*|siggen\.open\([^\n)]*")
ELSEWHERE = re.compile(r"(?<![\w/.:-])(?:data|sets)/\w+")
"""In another folder of sets; a bucket of an object store may have any name."""


def test_no_example_has_its_set_elsewhere() -> None:
    folders = ("siggen", "diagnostics", "docs", "configs", "examples")
    pages = [path for folder in folders for kind in ("py", "md") for path in (ROOT / folder).rglob(f"*.{kind}")]
    found = {}
    for path in (*pages, ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "Makefile"):
        lines = COMMAND.findall(path.read_text(encoding="utf-8"))
        if wrong := [line for line in lines if ELSEWHERE.search(line)]:
            found[str(path.relative_to(ROOT))] = wrong
    assert not found
