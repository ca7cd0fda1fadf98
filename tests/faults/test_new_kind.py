"""Somebody adds a kind of damage, a module and a line: every program knows it, and names no other."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path
from typing import Literal

import pytest

import siggen
from siggen.faults.fault import Fault
from tests.publication.conftest import facts_file
from tests.toy_process import said_by

CONFIG = """
extends: quickstart
name: toy
specimens: 1
duration_s: 0.1
repeats: 1
splits: {train: 10, validation: 5, test: 5}
dynamics: {mesh: {damage: all}}
states:
  others: null
  healthy: {}
  slight: {damage: {kind: toy_hinge, depth_mm: [0.8, 1.2]}}
  severe: {damage: {kind: toy_hinge, depth_mm: [3, 4]}}
"""
OTHER_KINDS = re.compile(r"\b(pits?|pitting|spall\w*)\b", re.IGNORECASE)


LINES = {
    "generate": "siggen generate toy.yaml --out set --engine serial",
    "plan": "siggen plan toy.yaml --trial 0",
    "mistake": "siggen plan toy.yaml --trial 0 --set states.severe.damage.depth_mm=0.01",
    "publish": "siggen publish set --facts publication.yaml --to published",
    "explore": "siggen-diagnostics explore set --out explorer.html",
}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, str]]:
    """Return a folder with all that commands made there in one process, and what they said."""
    folder = tmp_path_factory.mktemp("toy")
    (folder / "toy.yaml").write_text(CONFIG)
    facts_file(folder)
    return folder, said_by("tests.faults.with_toys", folder, LINES, {"mistake": 2})


@pytest.fixture(scope="module")
def folder(made: tuple[Path, dict[str, str]]) -> Path:
    return made[0]


def words_of(page: Path) -> str:
    """Return what a reader of a page sees."""
    source = re.sub(r"(?s)<(script|style)\b.*?</\1>", " ", page.read_text(encoding="utf-8"))
    return html.unescape(re.sub(r"<[^>]+>", " ", source))


def test_it_is_labelled_softens_its_tooth_and_has_its_rows(folder: Path) -> None:
    dataset = siggen.open(folder / "set")
    labels = dataset.labels().to_pylist()
    assert {label["fault"] for label in labels} == {"healthy", "hinge"}
    losses = {s: [one["mesh_stiffness_loss"] for one in labels if one["state"] == s] for s in ("healthy", "severe")}
    assert max(losses["healthy"]) == 0.0 < min(losses["severe"])
    assert {row["kind"] for row in dataset.damage().to_pylist()} == {"hinge"}


def test_the_plan_counts_its_states_and_a_mistake_in_it_is_named(made: tuple[Path, dict[str, str]]) -> None:
    said = made[1]
    assert "hinge" in said["plan"]
    assert "states.severe.damage.depth_mm" in said["mistake"]
    assert "allowed: at least 0.1" in said["mistake"]


def test_card_and_publication_name_it_and_no_other(folder: Path) -> None:
    for card in ("set/README.md", "published/README.md"):
        text = (folder / card).read_text(encoding="utf-8")
        assert "Toy hinges soften their teeth" in text
        assert not OTHER_KINDS.search(text)
    assert "hinge" in json.dumps(json.loads((folder / "published" / "croissant.json").read_text()))


def test_the_explorer_names_it_and_no_other(folder: Path) -> None:
    assert "hinge" in (folder / "explorer.html").read_text(encoding="utf-8")
    assert not OTHER_KINDS.search(words_of(folder / "explorer.html"))


@pytest.fixture(scope="module")
def judged(folder: Path) -> Path:
    """Return the folder with report and audit of a set of as many gearboxes as folds need."""
    lines = {
        "generate": "siggen generate toy.yaml --set specimens=10 --out judged --engine serial",
        "report": "siggen-diagnostics report judged --no-cnn --out report",
        "audit": "siggen-diagnostics audit judged --out audit",
    }
    said_by("tests.faults.with_toys", folder, lines)
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("what", ["report", "audit"])
def test_report_and_audit_name_no_other(judged: Path, what: str) -> None:
    said = words_of(judged / what / f"{what}.html")
    assert "hinge" in said
    assert not OTHER_KINDS.search(said)


def test_a_kind_without_words_is_refused_when_it_is_made() -> None:
    with pytest.raises(TypeError, match=r"Nameless\.words: received \(\)"):

        class Nameless(Fault):
            kind: Literal["nameless"] = "nameless"
