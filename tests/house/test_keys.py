"""Keys of the configuration: none without a place where a user meets it, and no more of them than there are."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from tests.house.source_tree import ROOT

MOST_KEYS = 176
"""Keys of docs/reference/yaml.md. A new key is worth more than one that can go: lower this with every one that goes."""
KEY_LINE = re.compile(r"\|`(?P<key>[^`]+)`(?:, `[^`]+`)*\|")
PAGES = [path for path in (ROOT / "docs").rglob("*.md") if path.parent.name != "reference"]
TESTS = [path for path in (ROOT / "tests").rglob("*.py") if path.parent.name != "house"]


@pytest.fixture(scope="module")
def page() -> str:
    return (ROOT / "docs" / "reference" / "yaml.md").read_text(encoding="utf-8")


def named_together(names: list[str], texts: list[str]) -> bool:
    """Return whether one text has all of these words."""
    words = [re.compile(rf"(?<![A-Za-z_]){re.escape(name)}(?![A-Za-z_])") for name in names]
    return any(all(word.search(text) for word in words) for text in texts)


def rows(page: str) -> Iterator[tuple[list[str], str]]:
    """Yield (words of a key: itself, the section around it and the top-level one, whether presets set it)."""
    heading, inside = "", ""
    for line in page.partition("## Ranges")[0].splitlines():
        if line.startswith("#"):
            heading, inside = line.lstrip("# ").removesuffix(".NAME.damage").removesuffix(".NAME.path"), ""
        elif line.startswith(("Kind ", "All kinds")):
            inside = line.partition(" in `")[2].removesuffix("`:")
        elif found := KEY_LINE.match(line):
            path = ".".join(("" if heading == "Top level" else heading, inside, found["key"]))
            words = [word.removesuffix("[]") for word in path.split(".") if word not in ("", "NAME")]
            yield list(dict.fromkeys(words[:1] + words[-2:])), "" if line.endswith("||") else "preset"


def test_every_key_stands_in_a_preset_or_together_with_its_section_in_a_guide_or_test(page: str) -> None:
    texts = [path.read_text(encoding="utf-8") for path in (*PAGES, *TESTS)]
    assert len(list(rows(page))) > 150
    nowhere = [".".join(words) for words, use in rows(page) if not use and not named_together(words, texts)]
    assert nowhere == []


def test_there_are_no_more_keys_than_said(page: str) -> None:
    found = re.search(r"There are (\d+) keys to learn, in (\d+) places", page)
    assert found is not None
    keys, places = map(int, found.groups())
    shown = page.partition("## Top level")[2].partition("## Ranges")[0]
    lines = re.findall(r"^\|`.*", shown, re.MULTILINE)
    sections = [line for line in lines if re.search(r"\|(section|list of section)|; keys as in `", line)]
    assert len(lines) - len(sections) == keys <= MOST_KEYS
    assert keys <= places


def test_a_key_that_nobody_names_is_found() -> None:
    page = "## gears\n|`tip`|x|x>0||\n|`a.teeth`|x|n||\n|`b`|x|x>0|`1`|\n"
    assert list(rows(page)) == [(["gears", "tip"], ""), (["gears", "a", "teeth"], ""), (["gears", "b"], "preset")]
    assert named_together(["gears", "tip"], ["no tip", "gears: {tip: 1}"])
    assert not named_together(["gears", "tip"], ["gears", "tips of gears"])
