"""The documentation: links lead somewhere, named files exist, and printed pages are what their scripts print."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import diagnostics.loader
import siggen
from tests.command import script

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
SCRIPTS = {
    "reference/yaml": "yaml_reference", "reference/commands": "command_reference",
    "reference/columns": "column_reference", "reference/python": "python_reference", "start/gallery": "gallery",
}  # fmt: skip
"""Printed page of docs -> the script in docs/scripts that prints it."""
NAMING = [
    *(page for page in PAGES if not any(name.endswith(f"/{page.stem}") for name in SCRIPTS)),
    *(ROOT / "docs" / "scripts").glob("*.py"),
    *(ROOT / "configs").glob("*.yaml"),
    *(ROOT / "tests").rglob("*.py"),
    *(ROOT / "benchmarks").rglob("*.py"),
]
LINK = re.compile(r"\]\(([^)\s#]*)(?:#([^)\s]*))?\)|(?:src|href)=\"([^\"#]+)\"")
NAMED = re.compile(r"(?<![\w/.])(?:docs|configs|benchmarks)/[\w/-]+\.(?:md|py|yaml|png|html)\b")


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings, as GitHub and the site make them."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    titles = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w -]", "", title.lower()).strip().replace(" ", "-") for title in titles}


def broken(page: Path) -> list[str]:
    """Return the links of a page that lead nowhere in the repository."""
    text = re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S))
    found = []
    for path, anchor, source in LINK.findall(text):
        target = path or source
        if re.match(r"\w+:", target):
            continue
        file = (page.parent / target).resolve() if target else page
        if not file.exists() or (anchor and file.suffix == ".md" and anchor not in anchors(file)):
            found.append(f"{target}#{anchor}" if anchor else target)
    return found


def test_every_relative_link_leads_somewhere() -> None:
    assert len(PAGES) > 20
    assert {str(page.relative_to(ROOT)): links for page in PAGES if (links := broken(page))} == {}


def test_the_site_leads_to_every_page() -> None:
    named = re.findall(r"^ +- .*?([\w/]+\.md)$", (ROOT / "mkdocs.yml").read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(named) == sorted(str(page.relative_to(ROOT / "docs")) for page in (ROOT / "docs").rglob("*.md"))


def test_a_broken_link_is_found(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("# Here\n[a](#here) [b](#there) [c](gone.md) [d](https://example.org/x) `[e](code.md)`\n")
    assert broken(page) == ["#there", "gone.md"]


def test_every_file_that_is_named_exists() -> None:
    missing = {
        f"{file.relative_to(ROOT)}: {name}"
        for file in NAMING
        for name in NAMED.findall(file.read_text(encoding="utf-8"))
        if not (ROOT / name).exists()
    }
    assert missing == set()


@pytest.mark.parametrize(("page", "name"), SCRIPTS.items(), ids=SCRIPTS)
def test_a_printed_page_is_what_its_script_prints(page: str, name: str) -> None:
    printed = script(ROOT / "docs" / "scripts" / f"{name}.py")
    written = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    assert printed == written, f"docs/{page}.md is out of date: run `make reference`"


def test_the_page_of_the_python_api_has_every_public_name() -> None:
    page = (ROOT / "docs/reference/python.md").read_text(encoding="utf-8")
    for package in (siggen, diagnostics, diagnostics.loader):
        named = (f"{package.__name__}.{name}" for name in package.__all__)
        assert not [name for name in named if not re.search(rf"^`{re.escape(name)}[(`]", page, re.MULTILINE)]
