"""Write the figures that pages cite from the report of quickstart: `python docs/scripts/cited_figures.py`.

docs/start/demo.md cites the answer, docs/understand/baselines.md calibration and epochs of the networks.
Tests compare both pages with the report (tests/diagnostics/pages). Sentences around the figures are written by hand:
read them again after a new report.
"""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from tests.diagnostics.pages.published_report import REPORT, plain, report_rows  # noqa: E402

DEMO = ROOT / "docs" / "start" / "demo.md"
BASELINES = ROOT / "docs" / "understand" / "baselines.md"
WINDOWS, CIRCULAR = "1-D network", "circular network on the average"
QUOTED = re.compile(r"^> .*\n(?:> .*\n)*", re.MULTILINE)
CALIBRATED = re.compile(
    r"the network gets T = [\d.]+\. Its calibration error\s+is [\d.]+ without T, [\d.]+ with T, and would be [\d.]+ if"
)


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


def calibration() -> str:
    """Return what temperature does to the network on windows."""
    temperature, _, _, before, after, honest = (text for text, _ in report_rows("with the temperature T")[WINDOWS][1:])
    return (
        f"the network gets T = {temperature}. Its calibration error\nis {before} without T, {after} with T, and would "
        f"be {honest} if"
    )


def epochs(network: str) -> str:
    """Return how many epochs a network was trained."""
    found = re.search(r"epoch \d+ of (\d+)", report_rows("Scores on")[network][0][1])
    assert found is not None, network
    return found[1]


def main() -> None:
    """Rewrite both pages."""
    demo = replaced(QUOTED, answer(), DEMO.read_text(encoding="utf-8"))
    DEMO.write_text(demo, encoding="utf-8")
    page = replaced(CALIBRATED, calibration(), BASELINES.read_text(encoding="utf-8"))
    for network, name in (
        (WINDOWS, r"(the network alone .*?, an epoch of )\d+"),
        (CIRCULAR, r"(the circular network alone, an epoch of )\d+"),
    ):
        page = re.sub(name, rf"\g<1>{epochs(network)}", page)
    BASELINES.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
