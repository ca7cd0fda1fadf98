"""The blocks of a page: its commands, its Python, files that it shows, and what it says that they print.

A page says by a comment above a block, which readers of the page do not see, how a test runs it:

* `<!-- slow -->`: by `make test-slow` alone;
* `<!-- smaller: specimens=2 for specimens=24 -->`: with the first text in the place of the second;
* `<!-- exit 4 -->`: the last command ends with this code;
* `<!-- needs: dask -->`: where that package is installed;
* `<!-- not run: why -->`: never;
* `<!-- other numbers -->`, above an output: times, or numbers of a larger set; its words are compared.

A comment `<!-- given: runs/quickstart -->` anywhere names what lies in the reader's folder before the page begins;
above a slow block, it lies there where slow blocks run too.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
LANGUAGES = ("console", "python", "yaml", "output", "text")
"""Commands, a script, a configuration, what the block before it prints, anything else."""
FENCE = re.compile(r"(?P<marks>(?:^<!-- .* -->\n)*)^```(?P<info>.*)\n(?P<text>(?:(?!^```$).*\n)*?)^```$", re.MULTILINE)
MARK = re.compile(r"<!-- (slow|other numbers|exit \d+|not run: .+|needs: \w+|smaller: .+ for .+) -->")
GIVEN = re.compile(r"^<!-- given: (.+) -->$", re.MULTILINE)
TITLE = re.compile(r'(\w*)(?: title="(.+)")?$')


@dataclass(frozen=True)
class Block:
    """One block: its line on the page, its language, its marks, the file that it is, and what it prints."""

    line: int
    language: str
    text: str
    marks: tuple[str, ...] = ()
    title: str | None = None
    prints: str | None = None
    same_numbers: bool = True

    def marked(self, kind: str) -> list[str]:
        """Return what stands behind a kind of mark: `specimens=2 for specimens=24` for `smaller`."""
        return [mark[len(kind) :].lstrip(": ") for mark in self.marks if re.match(rf"{kind}\b", mark)]

    @property
    def is_run(self) -> bool:
        """Whether a test does anything with it."""
        return not self.marked("not run") and (self.title is not None or self.language in ("console", "python"))

    @property
    def is_slow(self) -> bool:
        """Whether `make test-slow` alone runs it."""
        return "slow" in self.marks

    @property
    def source(self) -> str:
        """Its text as a test runs it."""
        text = self.text
        for pair in self.marked("smaller"):
            smaller, _, shown = pair.partition(" for ")
            if shown not in text:
                raise ValueError(f"line {self.line}: {shown!r} is not in the block")
            text = text.replace(shown, smaller)
        return text


def blocks_of(text: str) -> list[Block]:
    """Return the blocks of a page in their order; one of `output` belongs to the block before it.

    Raises
    ------
    ValueError
        If a block has no language of LANGUAGES, or a comment above it is none of the marks.
    """
    found: list[Block] = []
    for match in FENCE.finditer(text):
        line = text.count("\n", 0, match.start("info")) + 1
        marks = tuple(_mark(comment, line) for comment in match["marks"].splitlines() if not GIVEN.match(comment))
        language, title = _info(match["info"], line)
        if language == "output":
            before = found.pop()
            found.append(replace(before, prints=match["text"], same_numbers="other numbers" not in marks))
        else:
            found.append(Block(line, language, match["text"], marks, title))
    return found


def given(text: str, *, slow: bool) -> list[str]:
    """Return what a page begins with; without `slow`, not what stands above slow blocks alone."""
    if not slow:
        text = FENCE.sub(lambda block: "" if "<!-- slow -->" in block["marks"] else block[0], text)
    return [name for names in GIVEN.findall(text) for name in names.split(", ")]


def _mark(comment: str, line: int) -> str:
    found = MARK.fullmatch(comment)
    if found is None:
        raise ValueError(f"line {line}: unknown mark {comment}")
    return found[1]


def _info(info: str, line: int) -> tuple[str, str | None]:
    found = TITLE.match(info)
    if found is None or found[1] not in LANGUAGES:
        raise ValueError(f"line {line}: a block of {info!r}; allowed: {', '.join(LANGUAGES)}, and title=")
    return found[1], found[2]
