"""One self-contained page: inline style and script, figures inside, nothing loaded from elsewhere."""

from __future__ import annotations

import base64
import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

STYLE = """
:root{color-scheme:light;--ink:#1c2733;--soft:#5b6b7b;--line:#dde3e8;--band:#f5f7f9;--accent:#1f6f8b}
*{box-sizing:border-box}
body{margin:0;font:16px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif;color:var(--ink);background:#fff}
main{max-width:1120px;margin:0 auto;padding:1.2rem 1rem 4rem}
h1{font-size:1.55rem;line-height:1.25;margin:.4rem 0 1rem}
h2{font-size:1.2rem;margin:2.4rem 0 .6rem;padding-top:.8rem;border-top:1px solid var(--line)}
p,li{max-width:46rem;overflow-wrap:anywhere}
.first{font-size:1.06rem;padding:.8rem 1rem;background:#fff7e6;border-left:4px solid #e3a21a;
border-radius:0 6px 6px 0;max-width:none}
.note{padding:.6rem 1rem;background:var(--band);border-left:4px solid var(--soft);
border-radius:0 6px 6px 0;max-width:none}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,460px),1fr));gap:1.2rem;align-items:start;margin-top:1.2rem}
figure{margin:0;border:1px solid var(--line);border-radius:8px;padding:.6rem;background:#fff}
figure img{display:block;width:100%;height:auto}
figcaption{font-size:.9rem;color:var(--soft);margin-top:.4rem}
.scroll{overflow-x:auto;border:1px solid var(--line);border-radius:8px}
.tall{max-height:34rem;overflow-y:auto}
table{border-collapse:collapse;font-size:.9rem;width:100%;font-variant-numeric:tabular-nums}
th,td{padding:.35rem .6rem;text-align:right;white-space:nowrap;border-bottom:1px solid var(--line)}
th:first-child,td:first-child{text-align:left;white-space:normal;min-width:15rem}
thead th{position:sticky;top:0;background:var(--band)}
table.sortable thead th{cursor:pointer;user-select:none}
table.sortable thead th::after{content:" \\2195";color:#a9b4be}
thead th[aria-sort=ascending]::after{content:" \\2191"!important;color:var(--accent)!important}
thead th[aria-sort=descending]::after{content:" \\2193"!important;color:var(--accent)!important}
table.text th,table.text td{text-align:left;white-space:normal;vertical-align:top;min-width:7rem}
small{color:var(--soft)}
code{overflow-wrap:anywhere;font-size:.88em}
@media(max-width:600px){body{font-size:15px}main{padding:.6rem .7rem 3rem}h1{font-size:1.3rem}figure{padding:.3rem}
th,td{padding:.3rem .4rem}th:first-child,td:first-child{min-width:8.5rem}}
@media print{main{max-width:none;padding:0}.scroll{overflow:visible}.tall{max-height:none}
thead th{position:static}thead th::after{content:""!important}figure,tr{break-inside:avoid}
h2{break-after:avoid}table{font-size:.75rem}th,td{white-space:normal;padding:.2rem .3rem}}
"""

SCRIPT = """
document.querySelectorAll("table.sortable th").forEach(function(head){head.addEventListener("click",function(){
var table=head.closest("table"),body=table.tBodies[0],column=head.cellIndex;
var down=head.getAttribute("aria-sort")!=="descending";
table.querySelectorAll("th").forEach(function(other){other.removeAttribute("aria-sort")});
head.setAttribute("aria-sort",down?"descending":"ascending");
var key=function(row){var cell=row.cells[column],value=cell.dataset.value;
return value===undefined?cell.textContent:value===""?null:+value};
Array.from(body.rows).sort(function(a,b){var x=key(a),y=key(b);if(x===null)return 1;if(y===null)return -1;
var order=typeof x==="number"?x-y:x.localeCompare(y);return down?-order:order})
.forEach(function(row){body.appendChild(row)})})});
"""


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell of a table: what is shown, what is smaller behind it, and what it is sorted by (None: its text)."""

    text: str
    small: str = ""
    value: float | None = None


def page(title: str, parts: Sequence[str]) -> str:
    """Return the whole page."""
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{escape(title)}</title><style>{STYLE}</style></head>\n<body><main>\n"
        + "\n".join(parts)
        + f"\n</main><script>{SCRIPT}</script></body></html>\n"
    )


def heading(text: str, level: int = 2) -> str:
    """Return a heading."""
    return f"<h{level}>{escape(text)}</h{level}>"


def paragraph(text: str, style: str = "") -> str:
    """Return a paragraph, of a class of its own if one is named."""
    return f'<p class="{style}">{escape(text)}</p>' if style else f"<p>{escape(text)}</p>"


def figure_block(png: bytes, caption: str) -> str:
    """Return a figure with its caption, the picture inside the page."""
    source = base64.b64encode(png).decode("ascii")
    return (
        f'<figure><img alt="{escape(caption, quote=True)}" src="data:image/png;base64,{source}">'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
    )


def figure_grid(blocks: Sequence[str]) -> str:
    """Return figures side by side where there is room."""
    return f'<div class="figures">{"".join(blocks)}</div>'


def table(
    head: Sequence[str],
    rows: Sequence[Sequence[Cell]],
    *,
    sortable: bool = False,
    tall: bool = False,
    text: bool = False,
) -> str:
    """Return a table that scrolls inside itself, sorted by a click on a head if asked for; text wraps in its cells."""
    style = " ".join(name for name, wanted in (("sortable", sortable), ("text", text)) if wanted)
    titles = "".join(f"<th>{escape(title)}</th>" for title in head)
    body = "".join(f"<tr>{''.join(_cell(cell) for cell in row)}</tr>" for row in rows)
    return (
        f'<div class="scroll{" tall" if tall else ""}"><table class="{style}">'
        f"<thead><tr>{titles}</tr></thead><tbody>{body}</tbody></table></div>"
    )


def _cell(cell: Cell) -> str:
    small = f" <small>{escape(cell.small)}</small>" if cell.small else ""
    text = escape(cell.text).replace("_", "_<wbr>")  # long names break between their parts
    if cell.value is None:
        return f"<td>{text}{small}</td>"
    value = f"{cell.value:.6g}" if math.isfinite(cell.value) else ""
    return f'<td data-value="{value}">{text}{small}</td>'
