"""The twenty keys of docs/reference/twenty_keys.md are there, and examples of docs/reference/yaml.md are taken."""

from __future__ import annotations

import importlib
import json
import re

import pytest
import yaml

import siggen
from siggen.config.expert_keys import schema_text
from tests.house.source_tree import ROOT

PAGE = (ROOT / "docs" / "reference" / "twenty_keys.md").read_text(encoding="utf-8")


def test_there_are_twenty_and_the_configuration_has_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "docs" / "scripts")
    schema = importlib.import_module("yaml_reference").Schema(json.loads(schema_text()))
    known = {re.sub(r" \(kind: \w+\)", "", key.path) for key in schema.keys(schema.content)}
    known.add("states.NAME.damage.kind")  # stands in the headings of the reference
    rows = re.findall(r"^\| (`.*?`) \|", PAGE, re.MULTILINE)
    assert len(rows) == 20
    assert [name for row in rows for name in row.replace("`", "").split(", ") if name not in known] == []


def test_every_example_of_the_keys_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "docs" / "scripts")
    for example in importlib.import_module("yaml_reference").EXAMPLES.values():
        design = siggen.load_config({"extends": "quickstart", "name": "example", **yaml.safe_load(example)})
        assert design.config.name == "example"
