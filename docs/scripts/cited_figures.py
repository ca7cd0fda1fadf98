"""Write the answer that a page cites from the report of quickstart: `python docs/scripts/cited_figures.py`.

docs/start/demo.md cites the answer. Tests compare the page with the report (tests/diagnostics/pages). Sentences around
it are written by hand: read them again after a new report.
"""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from tests.diagnostics.pages.published_report import REPORT, plain  # noqa: E402

DEMO = ROOT / "docs" / "start" / "demo.md"
QUOTED = re.compile(r"^> .*\n(?:> .*\n)*", re.MULTILINE)


def replaced(pattern: re.Pattern[str], new: str, text: str) -> str:
    """Replace the one place that a pattern finds.

    Raises
    ------
    SystemExit
        If it finds none or several: the page was rewritten, and this script with it has to be.
    """
    found, count = pattern.subn(lambda _: new, text)
    if count != 1:
        raise SystemExit(f"{count} places in the page look like {pattern.pattern!r}; one is needed")
    return found


def answer() -> str:
    """Return the report's first answer as a quotation."""
    said = plain(REPORT.split("<b>From which size.</b>")[1].split("</p>")[0])
    return "".join(f"> {line}\n" for line in textwrap.wrap(said, 130, break_long_words=False, break_on_hyphens=False))


def main() -> None:
    """Rewrite the page."""
    demo = replaced(QUOTED, answer(), DEMO.read_text(encoding="utf-8"))
    DEMO.write_text(demo, encoding="utf-8")


if __name__ == "__main__":
    main()
