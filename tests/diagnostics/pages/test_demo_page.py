"""What docs/start/demo.md says of the report is what the published report says."""

from __future__ import annotations

import re

from siggen.checks.loading import load_config
from tests.diagnostics.pages.published_report import REPORT, ROOT, plain

PAGE = (ROOT / "docs" / "start" / "demo.md").read_text(encoding="utf-8")
STALE = "**Pages of quickstart are of an earlier preset**"


def test_a_published_report_that_is_not_of_the_shipped_preset_is_said_to_be() -> None:
    current = f"identity {load_config(ROOT / 'configs' / 'quickstart.yaml').identity}" in REPORT
    said = STALE in (ROOT / "docs" / "reports" / "README.md").read_text(encoding="utf-8")
    assert current != said


def test_the_answer_is_that_of_the_published_report() -> None:
    quoted = plain(" ".join(re.findall(r"^> (.*)$", PAGE, re.MULTILINE)))
    opened = plain(REPORT.split("<b>From which size.</b>")[1].split("</p>")[0])
    assert quoted == opened.replace("\N{NO-BREAK SPACE}", " ")
