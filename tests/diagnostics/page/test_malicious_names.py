"""Names of a set and of files show as text on every page, whatever they hold: markup, scripts, directions."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pyarrow as pa
import pytest

from diagnostics.cli.app import app
from diagnostics.judging.of_split import NetworkOptions
from diagnostics.page.blocks import Page, Paragraph
from diagnostics.page.template import page_html
from diagnostics.records.usable_records import with_channels
from diagnostics.report.report import write_report
from siggen.printable import printable
from tests.diagnostics import conftest
from tests.diagnostics.conftest import MemoryDataset, memory_dataset
from tests.diagnostics.explore.test_explorer import NAMES, renamed
from tests.diagnostics.machine.test_check import FS_HZ, run, write_recording

MARKS = re.compile("[\u202a-\u202e\u2066-\u2069]")
"""Characters that turn the direction of all text behind them."""


class Seen(HTMLParser):
    """Elements of a page with the names of their attributes, and its text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.running = 0
        self.elements: list[tuple[str, frozenset[str]]] = []
        self.text = ""
        self._code = False
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, frozenset(name for name, _ in attributes)))
        self._code = tag in ("script", "style")
        self.running += tag == "script" and ("type", "application/json") not in attributes

    def handle_endtag(self, tag: str) -> None:
        self._code = False

    def handle_data(self, text: str) -> None:
        self.text += "" if self._code else text


def check(page: Path, names: list[str], scripts: int = 1) -> None:
    seen = Seen(page.read_text(encoding="utf-8"))
    assert not [tag for tag, attributes in seen.elements if any(name.startswith("on") for name in attributes)]
    assert seen.running == scripts
    assert all("alt" in attributes for tag, attributes in seen.elements if tag == "img")
    assert not MARKS.search(page.read_text(encoding="utf-8"))
    for name in names:
        assert shown(name) in re.sub(r"\s+", " ", seen.text), name


def shown(name: str) -> str:
    """Return a name as a page shows it: with all that is no visible sign written out."""
    return re.sub(r"\s+", " ", printable(name, lines=True)).strip()


EVIL = '"><img src=x onerror=alert(1)>'
SENSORS = (f"{EVIL}_vertical", "<script>alert(1)</script>_horizontal")


@pytest.fixture(scope="module")
def malicious() -> Iterator[MemoryDataset]:
    """A set whose folder, states, faults and one sensor have names that a page must not obey."""
    names = {**NAMES, "severe": NAMES["severe"] + r"$\frac{1}$"}  # no mathematics for figures to typeset
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(conftest, "CHANNELS", SENSORS)
        found = renamed(memory_dataset(("train",) * 4 + ("validation",) * 2 + ("test",) * 4), names)
        faults = ["healthy" if name == "healthy" else EVIL for name in found.table.column("fault").to_pylist()]
        place = found.table.column_names.index("fault")
        yield replace(found, table=found.table.set_column(place, "fault", pa.array(faults)), path=Path(EVIL))


@pytest.mark.slow  # trains and draws all of a report; the page of records has these names in every run
def test_a_report_shows_every_name_as_text(malicious: MemoryDataset, tmp_path: Path) -> None:
    states = list(dict.fromkeys(malicious.table.column("state").to_pylist()))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # letters that the font of figures lacks; no room for a name
        one_channel = with_channels(malicious, SENSORS[:1])
        page = write_report(one_channel, tmp_path / "report", 0, network=NetworkOptions(cnn=False))
    check(page, [*states, EVIL, SENSORS[0]], scripts=2)


def test_the_page_of_a_machine_shows_names_of_files_as_text(tmp_path: Path) -> None:
    assert app.info.name == "siggen-diagnostics"
    files = [write_recording(tmp_path / f"<b>healthy\u202e{k}<!--.npz", seed=k) for k in range(4)]
    new = write_recording(tmp_path / "<img src=x onerror=alert(1)>.npz", seed=9)
    run("baseline", *files, "--fs", FS_HZ, "--teeth", "20,31", "--speed", "20,30", "--out", tmp_path / "rig")
    run("check", tmp_path / "rig", new)
    check(tmp_path / "rig" / "machine.html", [files[0].name, new.name])


def test_characters_that_turn_the_text_behind_them_are_named_and_right_to_left_names_stay() -> None:
    text = page_html(Page("a\u202eb", [Paragraph("a\u202eb\u2066c"), Paragraph("שלום")]))
    assert "<title>a\\u202eb</title>" in text
    assert "<p>a\\u202eb\\u2066c</p>" in text
    assert "<p>שלום</p>" in text
