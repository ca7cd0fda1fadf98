"""docs/reports: every page is one file that names no machine, and the commands in its README are those that make it."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT / "docs" / "reports"
KEPT = ("quickstart_audit", "quickstart_report")
PAGES = [FOLDER / f"{name}.html" for name in KEPT]


def loaded(name: str) -> ModuleType:
    specification = importlib.util.spec_from_file_location(name, ROOT / "docs" / "scripts" / f"{name}.py")
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def script() -> ModuleType:
    return loaded("report_pages")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_page_is_complete_small_and_names_no_machine(page: Path, script: ModuleType) -> None:
    text = page.read_text(encoding="utf-8")
    assert script.places(text) == []
    assert not re.search(r'(src|href)="(?!data:|#)', text)
    # The report holds the signals of 40 records, half of its size, and all indicators of all records.
    assert page.stat().st_size <= (3.0e6 if page.stem.endswith("report") else 1.0e6)
    assert "Made by siggen-diagnostics" in text


def test_the_readme_names_every_page_with_the_command_that_makes_it(script: ModuleType) -> None:
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    named = dict(re.findall(r"^\| (?:\[)?(\w+)\.html.*\| `siggen-diagnostics ([^`]+)` \|$", text, re.MULTILINE))
    assert named == {name: command for pages in script.REPORTS.values() for name, (_, command) in pages.items()}
    assert script.KEPT == KEPT
    assert all(f"[{name}.html]({name}.html)" in text for name in KEPT)


def test_places_on_a_machine_are_found_and_other_words_are_not(script: ModuleType) -> None:
    assert script.places("see /tmp/set/a.json and /home/ann/x") == ["/tmp/set/a.json", "/home/ann/x"]
    assert script.places(f"in {Path.cwd()}/runs")[0] == str(Path.cwd())
    assert script.places("healthy / damaged, 1/2, m/s², </small>, root mean square") == []


def test_the_readme_says_how_every_set_is_made(script: ModuleType) -> None:
    page = (FOLDER / "README.md").read_text(encoding="utf-8")
    for commands in script.SETS.values():
        for command in commands:
            assert f"`{command}`" in page or f"\n{command}\n" in page


def test_the_page_of_presets_judges_as_many_gearboxes_as_the_kept_report(script: ModuleType) -> None:
    page = (ROOT / "docs" / "understand" / "presets.md").read_text(encoding="utf-8")
    assert f"`python docs/scripts/detectability.py {script.GEARBOXES['bench']} 2 bench`" in page
