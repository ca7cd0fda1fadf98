"""What a page holds: its payload, one dataclass of blocks that the template draws and tests read."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from diagnostics.page.live import STILL, Live

PRINTED_ROWS = 20
"""Rows of a tall table that are printed; more would be pages of numbers that nobody reads on paper."""
SHORT_ROWS = 12
"""Up to so many rows a table stays on one sheet."""
WIDE, WIDER = 9, 14
"""Columns beyond which paper needs small print, and limits on lines of their own."""
MOST_LINKS = 20
"""Below a figure; more would be longer than its caption."""
PLAIN_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")


@dataclass(frozen=True, slots=True)
class Heading:
    """A heading, with a name that links can lead to."""

    text: str
    level: int = 2
    kind: ClassVar[str] = "heading"

    @property
    def anchor(self) -> str:
        """The name for links: letters and digits in lower case."""
        return re.sub(r"[^a-z0-9]+", "-", self.text.lower()).strip("-") or "section"


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A paragraph, of a class of its own if one is named, behind a few bold words if there are any."""

    text: str
    style: str = ""
    lead: str = ""
    kind: ClassVar[str] = "paragraph"


@dataclass(frozen=True, slots=True)
class RecordLinks:
    """A line below a figure that leads to records, by what each link is called; false without links."""

    title: str
    targets: Mapping[str, str]

    def __bool__(self) -> bool:
        return bool(self.targets)

    @property
    def shown(self) -> list[tuple[str, str]]:
        """The first links, name and target."""
        return list(self.targets.items())[:MOST_LINKS]


@dataclass(frozen=True, slots=True)
class FigureBlock:
    """A picture inside the page with its caption, numbered by the page, and a line that leads to records."""

    png: bytes
    caption: str
    behind: RecordLinks | None = None
    kind: ClassVar[str] = "figure"

    @property
    def size(self) -> tuple[int, int]:
        """Width and height [pixels], of the header of a PNG."""
        width, height = (int.from_bytes(self.png[start : start + 4], "big") for start in (16, 20))
        return width, height


@dataclass(frozen=True, slots=True)
class FigureGrid:
    """Figures or tables side by side where there is room; false without any."""

    blocks: Sequence[Block]
    kind: ClassVar[str] = "figures"

    def __bool__(self) -> bool:
        return bool(self.blocks)


@dataclass(frozen=True, slots=True)
class FoldedBlocks:
    """Blocks below a title that opens them."""

    title: str
    blocks: Sequence[Block]
    kind: ClassVar[str] = "folded"


@dataclass(frozen=True, slots=True)
class Opening:
    """What opens a page: each answer with its question, and the figure beside or below them.

    Attributes
    ----------
    sentences : sequence of (str, str)
        Question in a few words, and its answer, in which `**` stands about what is set in bold.
    figure : FigureBlock, optional
    """

    sentences: Sequence[tuple[str, str]]
    figure: FigureBlock | None = None
    kind: ClassVar[str] = "opening"


@dataclass(frozen=True, slots=True)
class ContentsLinks:
    """Links to the sections of the page, by their headings."""

    kind: ClassVar[str] = "contents"


@dataclass(frozen=True, slots=True)
class RecordsPlace:
    """Where the page's program draws records."""

    kind: ClassVar[str] = "records"


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell of a table.

    Attributes
    ----------
    text, small : str
        What is shown, and what is smaller behind it.
    value : float, optional
        What it is sorted by; None: its text.
    link, hint : str
        Where the text leads, such as `#term-rms`, and what is shown on hover. A cell with a name instead of a link
        gives its hint to all links that lead to it.
    shade : float, optional
        0 to 1: how dark a heat map has it.
    name : str
        What links lead to it by.
    """

    text: str
    small: str = ""
    value: float | None = None
    link: str = ""
    hint: str = ""
    shade: float | None = None
    name: str = ""

    @property
    def sorted_by(self) -> str | None:
        """What the cell is sorted by where what is shown is no number itself; empty where it is undefined."""
        if self.value is None or (math.isfinite(self.value) and PLAIN_NUMBER.fullmatch(self.text)):
            return None
        return f"{self.value:.6g}" if math.isfinite(self.value) else ""

    @property
    def shade_class(self) -> str:
        """Tenths of the shade, each with text that can be read on it."""
        no_shade = self.shade is None or math.isnan(self.shade)
        return "" if no_shade else f"shade{round(10.0 * min(max(self.shade or 0.0, 0.0), 1.0))}"


@dataclass(frozen=True, slots=True)
class TableBlock:
    """A table that scrolls inside itself; false without rows.

    Attributes
    ----------
    head : sequence of str
        Titles of the columns; all empty for a table without a head.
    rows : sequence of sequence of Cell
        The first cell names its row.
    caption : str
        Above the table, numbered by the page.
    sortable, tall, text : bool
        Whether heads sort, whether more than a screen of rows scrolls (and is cut on paper), whether cells wrap.
    """

    head: Sequence[str]
    rows: Sequence[Sequence[Cell]]
    caption: str = ""
    sortable: bool = False
    tall: bool = False
    text: bool = False
    kind: ClassVar[str] = "table"

    def __bool__(self) -> bool:
        return bool(self.rows)

    @property
    def titled(self) -> bool:
        """Whether there is a head."""
        return any(self.head)

    @property
    def is_cut(self) -> bool:
        """Whether paper gets its first rows only."""
        return self.tall and len(self.rows) > PRINTED_ROWS and not self.text

    @property
    def box(self) -> str:
        """Classes of what it scrolls in."""
        flags = {"tall": self.tall, "cut": self.is_cut, "short": len(self.rows) <= SHORT_ROWS}
        return " ".join(["scroll", *(name for name, wanted in flags.items() if wanted)])

    @property
    def style(self) -> str:
        """Classes of the table itself."""
        wide, wider = (len(self.head) > most and not self.text for most in (WIDE, WIDER))
        flags = {"sortable": self.sortable, "text": self.text, "wide": wide, "wider": wider}
        return " ".join(name for name, wanted in flags.items() if wanted)


Block = (
    Heading | Paragraph | FigureBlock | FigureGrid | FoldedBlocks | Opening | ContentsLinks | RecordsPlace | TableBlock
)


@dataclass(frozen=True, slots=True)
class Page:
    """One self-contained page: its title, its blocks, and what a program of its own draws on it."""

    title: str
    blocks: Sequence[Block]
    live: Live = STILL

    @property
    def sections(self) -> list[Heading]:
        """The headings that its contents lead to."""
        return [block for block in self.blocks if isinstance(block, Heading) and block.level == 2]


def summary_blocks(sentences: Sequence[str], verdict: str = "") -> list[Block]:
    """Return the sentences of a summary, the first, which says what all others mean, set off: `passed`, `failed`."""
    first, *others = sentences
    return [Paragraph(first, f"first {verdict}".rstrip()), *map(Paragraph, others)]


def note_blocks(texts: Sequence[str]) -> list[Block]:
    """Return notes as paragraphs, each a sentence whatever part of the program wrote it."""
    return [
        Paragraph(f"{text[:1].upper()}{text[1:]}{'' if text.endswith(('.', '?')) else '.'}", "note") for text in texts
    ]
