"""Names are data: what leaves the program is composed of them, and no text is searched for words to be others."""

from __future__ import annotations

import ast
from collections.abc import Iterator

import pytest

from tests.house.source_tree import modules, tree

READS = {
    "siggen.keys.yaml_source": "numbers of a YAML file",
    "diagnostics.recordings.text_files": "text files of others",
    "diagnostics.recordings.units": "units of others",
}
SHOWS = {
    "siggen.columns.record": "a unit with raised digits",
    "siggen.sensors.quantity": "a unit with raised digits",
    "diagnostics.recordings.measured_recording": "a unit with raised digits",
    "diagnostics.page.wording": "the sign of a number",
    "diagnostics.page.style": "ticks of a figure, as matplotlib writes them",
    "diagnostics.page.blocks": "the name of a heading for links",
    "diagnostics.page.template": "markup",
    "diagnostics.page.sentences": "lines of a template, and the space before a unit",
    "diagnostics.page.live": "data inside a script",
    "diagnostics.page.security_policy": "line ends of a script, as browsers hash it",
    "diagnostics.report.report": "a sentence without its markup",
    "siggen.gearbox.description": "the cell of a table in Markdown",
    "siggen.dataset.object_path": "an address of an object store",
    "siggen.sets.run_journal": "a time in UTC",
    "siggen.cli.init": "options as they are typed; a file's name as that of a set",
    "diagnostics.page.provenance": "a place on this machine, on a page that others read",
}


def rewritten(syntax: ast.AST) -> Iterator[int]:
    """Yield the lines of `re.sub`, `PATTERN.sub`, `text.replace(old, new)` and `text.translate`."""
    for node in ast.walk(syntax):
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
            continue
        called, on = node.func.attr, node.func.value
        by_pattern = isinstance(on, ast.Name) and (on.id == "re" or on.id.isupper())
        if (
            (called in ("sub", "subn") and by_pattern)
            or (called == "replace" and len(node.args) > 1)
            or called == "translate"
        ):
            yield node.lineno


def test_no_name_label_path_or_message_is_rewritten() -> None:
    found = {
        name: lines
        for package in ("siggen", "diagnostics")
        for name, path in modules(package).items()
        if (lines := sorted(rewritten(tree(path))))
    }
    known = {*READS, *SHOWS}
    assert {name: lines for name, lines in found.items() if name not in known} == {}, "compose it of its parts"
    assert known - found.keys() == set(), "take these off the list"


@pytest.mark.parametrize(
    ("source", "lines"),
    [
        ("import re\nre.sub('a', 'b', name)", [2]),
        ("OLD.sub('b', name)\nname.replace('pinion', own)", [1, 2]),
        ("name.translate(table)\npath.replace(target)\nreplace(record, name=own)\nbuilder.sub(a, b)", [1]),
        ("when.replace(tzinfo=None)\nfigure.subplots(1, 2)\nname.removesuffix('_hz')", []),
    ],
)
def test_a_rewritten_text_is_seen(source: str, lines: list[int]) -> None:
    assert list(rewritten(ast.parse(source))) == lines
