"""Tables of the published report of quickstart, which pages of the documentation cite."""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
REPORT = (ROOT / "docs" / "reports" / "quickstart_report.html").read_text(encoding="utf-8").replace("<wbr>", "")


def plain(text: str) -> str:
    """Return text without markup, single spaces between its words."""
    return re.sub(r"\s+", " ", unescape(re.sub(r"<[^>]*>", "", text))).strip()
