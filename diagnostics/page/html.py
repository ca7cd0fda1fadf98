"""One self-contained page: inline style and script, figures inside, nothing loaded from elsewhere."""

from __future__ import annotations

import base64
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from diagnostics.page.live import STILL, Live
from diagnostics.page.security_policy import HINT_SCRIPT, SORT_SCRIPT, security_policy
from siggen.printable import printable

STYLE = """
:root{color-scheme:light;--ink:#1c2733;--soft:#566573;--line:#dde3e8;--band:#f5f7f9;--accent:#1f6f8b;
--paper:#fff;--warm:#fff7e6}
@media screen and (prefers-color-scheme:dark){:root:not(.print){color-scheme:dark;--ink:#e6ebef;--soft:#a9b6c1;
--line:#3a4650;--band:#1f272e;--accent:#7cc4dd;--paper:#14191d;--warm:#33291a}}
*{box-sizing:border-box}
body{margin:0;font:16px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif;color:var(--ink);
background:var(--paper)}
main{max-width:1280px;margin:0 auto;padding:1.2rem 1rem 4rem}
h1{font-size:1.55rem;line-height:1.25;margin:.4rem 0 1rem;overflow-wrap:anywhere}
h2{font-size:1.2rem;margin:2.4rem 0 .6rem;padding-top:.8rem;border-top:1px solid var(--line)}
p,li{max-width:46rem;overflow-wrap:anywhere}
.first{font-size:1.06rem;padding:.8rem 1rem;background:var(--warm);border-left:4px solid #e3a21a;
border-radius:0 6px 6px 0;max-width:none}
.passed{background:#2e8b5722;border-left-color:#2e8b57}.failed{background:#b01e3c22;border-left-color:#b01e3c}
.note{padding:.6rem 1rem;background:var(--band);border-left:4px solid var(--soft);
border-radius:0 6px 6px 0;max-width:none}
.caption,figcaption{font-size:.9rem;color:var(--soft)}
.caption{margin:1.4rem 0 .4rem;max-width:none}
.caption b,figcaption b{color:var(--ink)}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,430px),1fr));gap:1.2rem;align-items:start;margin-top:1.2rem}
figure{margin:0;border:1px solid var(--line);border-radius:8px;padding:.6rem}
figure img{display:block;width:100%;height:auto;border-radius:4px}
figcaption{margin-top:.4rem}.behind{margin:.3rem 0 0}
td a{color:inherit;text-decoration-color:var(--soft)}
.scroll{overflow-x:auto;border:1px solid var(--line);border-radius:8px}
.scroll:focus-visible,button:focus-visible{outline:2px solid var(--accent);outline-offset:1px}
.tall{max-height:34rem;overflow-y:auto}
table{border-collapse:separate;border-spacing:0;font-size:.9rem;width:100%;font-variant-numeric:tabular-nums}
th,td{padding:.35rem .6rem;text-align:right;vertical-align:top;white-space:nowrap;border-bottom:1px solid var(--line)}
tbody th{font-weight:inherit}
th:first-child{text-align:left;white-space:normal;min-width:11rem;overflow-wrap:anywhere;position:sticky;left:0;
background:var(--paper);border-right:1px solid var(--line)}
thead th{position:sticky;top:0;background:var(--band);vertical-align:bottom;white-space:normal;
min-width:3.2rem;z-index:1}
thead th:first-child{background:var(--band);z-index:2}
tbody tr:last-child>*{border-bottom:0}
td small,th small{display:block;color:var(--soft)}
thead button{all:unset;cursor:pointer;display:inline-block}
thead button::after{content:"\\00a0\\2195";color:#7d8994}
th[aria-sort=ascending] button::after{content:"\\00a0\\2191";color:var(--accent)}
th[aria-sort=descending] button::after{content:"\\00a0\\2193";color:var(--accent)}
table.text th,table.text td{text-align:left;white-space:normal;min-width:7rem}
.printed{display:none}
a{color:var(--accent)}th a{color:inherit;text-decoration-color:var(--soft)}
.answer{display:grid;grid-template-columns:minmax(0,1fr) minmax(0,1.1fr);gap:1.2rem;align-items:start}
.answer h2{font-size:.95rem;margin:0 0 .2rem;padding:0;border:0;color:var(--soft);font-weight:600}
.answer>div p{margin:0 0 1.1rem;max-width:none;font-size:1.16rem;line-height:1.45}.answer p b{color:var(--accent)}
.answer figure{margin:0}
summary{cursor:pointer;font-weight:600;min-height:24px;margin:.6rem 0}
.contents ul{display:flex;flex-wrap:wrap;gap:.2rem 1.1rem;list-style:none;margin:1rem 0 0;padding:.6rem 0;
border:solid var(--line);border-width:1px 0}
.contents li{max-width:none}
:target{scroll-margin-top:1rem;background:var(--warm)}
code{overflow-wrap:anywhere;font-size:.88em}
@media(max-width:800px){.answer{grid-template-columns:minmax(0,1fr);gap:.4rem}}
@media(max-width:600px){body{font-size:15px;line-height:1.45}.answer p{margin-bottom:.45rem}
main{padding:.6rem .7rem 3rem}h1{font-size:1.3rem}figure{padding:.3rem}
th,td{padding:.3rem .4rem}th:first-child{min-width:8.5rem;max-width:10rem}}
"""

PRINT_STYLE = """
@page{margin:14mm 12mm}
@media print{html{font-size:10pt}body{font-size:1rem;line-height:1.4}
main{max-width:none;padding:0}p,li{max-width:none}h2{margin-top:1.4rem}
.scroll{overflow:visible;border:0}.tall{max-height:none}
table{border-collapse:collapse;font-size:.85rem}table.wide{font-size:.64rem}
th:first-child,thead th,thead th:first-child{position:static;background:none;border-right:0}
thead th{border-bottom:1.5pt solid var(--ink);min-width:0}tbody th:first-child{min-width:11em}
table.text td{min-width:0}table.text tbody th:first-child{min-width:8em}
th,td{padding:.15rem .3rem}table.wide th,table.wide td{padding:.12rem .18rem}
table.wider{font-size:.58rem}table.wider small{white-space:normal}
thead{display:table-header-group}thead button{display:contents}thead button::after{content:""!important}
tr,figure,.note,.short{break-inside:avoid}
h1,h2,h3,.caption{break-after:avoid}.caption,figcaption{font-size:.85rem}p{orphans:3;widows:3}
.cut tbody tr:nth-child(n+ROWS){display:none}.printed{display:block;break-before:avoid}
.figures{grid-template-columns:1fr 1fr;gap:.8rem}figure{padding:.3rem}
.answer{grid-template-columns:minmax(0,1fr) minmax(0,1fr)}
.first,.note{background:none}}
"""


SHADES = "".join(
    f".shade{tenth}{{background:color-mix(in srgb,#1f6f8b {7 * tenth}%,var(--paper))}}"
    f".shade{tenth} small{{color:inherit}}\n"
    for tenth in range(11)
)
"""Cells of a heat map, near enough to the paper, light or dark, that text keeps a contrast of 4.5."""


def style_sheet(printed_rows: int) -> str:
    """Return the style; of a table that is cut on paper so many rows are printed."""
    return STYLE + SHADES + PRINT_STYLE.replace("ROWS", str(printed_rows + 1))


PRINTED_ROWS = 20
"""Rows of a tall table that are printed; more would be pages of numbers that nobody reads on paper."""

SHORT_ROWS = 12
"""Up to so many rows a table stays on one sheet."""

WIDE = 9
"""Columns beyond which paper needs small print."""

WIDER = 14
"""Columns beyond which it also needs limits on lines of their own."""

BOLD, BOLDER = re.compile(r"\*\*(.+?)\*\*"), r"<b>\1</b>"
PLAIN_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")
NUMBERED = (("Figure", "<figcaption>"), ("Table", '<p class="caption">'))


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


def page(title: str, parts: Sequence[str], live: Live = STILL) -> str:
    """Return the whole page, its figures and tables numbered; `live` is what a program of its own draws on it."""
    script = HINT_SCRIPT + SORT_SCRIPT
    scripts = [script, *([live.script] if live.script else [])]
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"{security_policy(scripts)}"
        f"<title>{escape(printable(title, lines=True))}</title>"
        f"<style>{style_sheet(PRINTED_ROWS)}{live.style}</style></head>\n<body><main>\n"
        + numbered("\n".join(parts))
        + f"\n</main>{live.data_elements()}{''.join(f'<script>{one}</script>' for one in scripts)}</body></html>\n"
    )


def numbered(body: str) -> str:
    """Return the body with a number before every caption, so that text elsewhere can cite figures and tables."""
    for word, opening in NUMBERED:
        first, *rest = body.split(opening)
        body = first + "".join(
            f'{opening[:-1]} id="{word.lower()}-{number}"><b>{word} {number}.</b> {part}'
            for number, part in enumerate(rest, start=1)
        )
    return body


def heading(text: str, level: int = 2) -> str:
    """Return a heading, with a name that links can lead to."""
    return f'<h{level} id="{anchor(text)}">{inline(text)}</h{level}>'


def anchor(text: str) -> str:
    """Return the name of a heading for links: its letters and digits in lower case."""
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-") or "section"


def contents(parts: Sequence[str]) -> str:
    """Return links to the sections of these parts of a page, by their headings."""
    found = re.findall(r'<h2 id="([^"]*)">(.*?)</h2>', "\n".join(part for part in parts if part.startswith("<h2")))
    links = "".join(f'<li><a href="#{name}">{title}</a></li>' for name, title in found)
    return f'<nav class="contents" aria-label="Contents"><ul>{links}</ul></nav>'


def link(text: str, target: str, hint: str = "") -> str:
    """Return a link; its definition or target is shown on hover."""
    title = f' title="{attribute(hint)}"' if hint else ""
    return f'<a href="{escape(target, quote=True)}"{title}>{inline(text)}</a>'


def answer(sentences: Sequence[tuple[str, str]], figure: str) -> str:
    """Return what opens a page: each answer with its question, and the figure beside or below them.

    Parameters
    ----------
    sentences : sequence of (str, str)
        Question in a few words, and its answer, in which `**` stands about what is set in bold.
    figure : str
        A block of `figure_block`, or nothing.
    """
    said = "".join(
        f"<h2>{inline(question)}</h2><p>{BOLD.sub(BOLDER, inline(text))}</p>" for question, text in sentences
    )
    return f'<section class="answer" aria-label="Answer"><div>{said}</div>{figure}</section>'


def folded(title: str, blocks: Sequence[str]) -> str:
    """Return blocks below a title that opens them."""
    return f'<details class="folded"><summary>{inline(title)}</summary>{"".join(blocks)}</details>'


def paragraph(text: str, style: str = "") -> str:
    """Return a paragraph, of a class of its own if one is named."""
    return f'<p class="{style}">{inline(text)}</p>' if style else f"<p>{inline(text)}</p>"


def summary(sentences: Sequence[str], verdict: str = "") -> list[str]:
    """Return the sentences of a summary, the first, which says what all others mean, set off: `passed`, `failed`."""
    first, *others = sentences
    return [paragraph(first, f"first {verdict}".rstrip()), *(paragraph(sentence) for sentence in others)]


def notes(texts: Sequence[str]) -> list[str]:
    """Return notes as paragraphs, each a sentence whatever part of the program wrote it."""
    return [
        paragraph(f"{text[:1].upper()}{text[1:]}{'' if text.endswith(('.', '?')) else '.'}", "note") for text in texts
    ]


def attribute(text: str) -> str:
    """Return text for the value of an attribute."""
    return escape(printable(text, lines=True), quote=True)


def inline(text: str) -> str:
    """Return text for the page: `code` between backticks, long names broken between their parts."""
    found = re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(printable(text, lines=True)))
    return re.sub(r"(?<=\w)_(?=[^\W_])", "_<wbr>", found)


def figure_block(png: bytes, caption: str, behind: str = "") -> str:
    """Return a figure with its caption, the picture inside the page and its size known before it is drawn.

    Below the caption stands `behind`, a line that leads to records, or nothing.
    """
    source = base64.b64encode(png).decode("ascii")
    width, height = (int.from_bytes(png[start : start + 4], "big") for start in (16, 20))  # of the header of a PNG
    return (
        f'<figure><img alt="{attribute(caption)}" width="{width}" height="{height}" '
        f'src="data:image/png;base64,{source}"><figcaption>{inline(caption)}{behind}</figcaption></figure>'
    )


def figure_grid(blocks: Sequence[str]) -> str:
    """Return figures side by side where there is room; nothing for none."""
    return f'<div class="figures">{"".join(blocks)}</div>' if blocks else ""


def table(
    head: Sequence[str],
    rows: Sequence[Sequence[Cell]],
    *,
    caption: str = "",
    sortable: bool = False,
    tall: bool = False,
    text: bool = False,
) -> str:
    """Return a table that scrolls inside itself, sorted by a click on a head if asked for; text wraps in its cells.

    Parameters
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
    long = tall and len(rows) > PRINTED_ROWS and not text
    short = len(rows) <= SHORT_ROWS
    flags = {
        "sortable": sortable,
        "text": text,
        "wide": len(head) > WIDE and not text,
        "wider": len(head) > WIDER and not text,
    }
    box = " ".join(["scroll", *(["tall"] if tall else []), *(["cut"] if long else []), *(["short"] if short else [])])
    titles = "".join(f'<th scope="col">{inline(title)}</th>' for title in head)
    body = "".join(f"<tr>{''.join(_cell(cell, place) for place, cell in enumerate(row))}</tr>" for row in rows)
    return (
        (f'<p class="caption">{inline(caption)}</p>' if caption else "")
        + f'<div class="{box}" tabindex="0" role="region" aria-label="{attribute(caption or "table")}">'
        + f'<table class="{" ".join(name for name, wanted in flags.items() if wanted)}">'
        + (f"<thead><tr>{titles}</tr></thead>" if any(head) else "")
        + f"<tbody>{body}</tbody></table></div>"
        + (_printed_note(len(rows)) if long else "")
    )


def _printed_note(rows: int) -> str:
    return (
        f'<p class="printed">On paper: the first {PRINTED_ROWS} of {rows} rows in the order that was chosen; all are '
        "on the screen and in the files beside this page.</p>"
    )


def _cell(cell: Cell, place: int) -> str:
    tag, scope = ("td", "") if place else ("th", ' scope="row"')
    small = f" <small>{inline(minus(cell.small))}</small>" if cell.small else ""
    text = link(minus(cell.text), cell.link, cell.hint) if cell.link else inline(minus(cell.text))
    name = f' id="{escape(cell.name, quote=True)}" data-hint="{attribute(cell.hint)}"' if cell.name else ""
    return f"<{tag}{scope}{name}{_sorted_by(cell)}{_shaded(cell.shade)}>{text}{small}</{tag}>"


def _shaded(shade: float | None) -> str:
    """Return the class of a cell of a heat map: tenths of its shade, each with text that can be read on it."""
    return "" if shade is None or math.isnan(shade) else f' class="shade{round(10.0 * min(max(shade, 0.0), 1.0))}"'


def _sorted_by(cell: Cell) -> str:
    """Return the attribute that a table is sorted by, where what is shown is no number itself."""
    if cell.value is None or (math.isfinite(cell.value) and PLAIN_NUMBER.fullmatch(cell.text)):
        return ""
    return f' data-value="{cell.value:.6g}"' if math.isfinite(cell.value) else ' data-value=""'


def minus(text: str) -> str:
    """Return text with a true minus sign before numbers, and none before a zero."""
    plain = re.sub(r"(?<![\w.])[-+](0(?:\.0+)?)(?![\d.])", r"\1", text)
    return re.sub(r"(?<![\w.,)])-(?=\d)", "\N{MINUS SIGN}", plain)
