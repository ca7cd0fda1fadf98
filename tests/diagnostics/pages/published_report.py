"""Tables of the published report of quickstart, which pages of the documentation cite."""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
REPORT = (ROOT / "docs" / "reports" / "quickstart_report.html").read_text(encoding="utf-8").replace("<wbr>", "")


def report_rows(caption: str) -> dict[str, list[tuple[str, str]]]:
    """Return the cells of a table by the names of its rows: text and small print, the name's own small print first."""
    found = [part for part in REPORT.split('<p class="caption"')[1:] if caption in part.split("</p>")[0]]
    assert len(found) == 1, caption
    rows = re.findall(r"<tr>(<th.*?)</tr>", found[0].split("<tbody>")[1].split("</table>")[0])
    return {name: [("", small), *cells] for (name, small), *cells in map(_cells, rows)}


def _cells(row: str) -> list[tuple[str, str]]:
    cells = re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row)
    return [(plain(cell.partition("<small>")[0]), plain(cell.partition("<small>")[2])) for cell in cells]


def plain(text: str) -> str:
    """Return text without markup, single spaces between its words."""
    return re.sub(r"\s+", " ", unescape(re.sub(r"<[^>]*>", "", text))).strip()
