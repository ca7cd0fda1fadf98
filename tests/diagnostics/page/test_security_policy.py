"""Pages run their own scripts alone: every script that stands in a page has its hash in the page's policy."""

from __future__ import annotations

import base64
import hashlib
import re

from diagnostics.page.blocks import Page, Paragraph
from diagnostics.page.template import page_html


def test_a_page_allows_its_own_scripts_and_no_network() -> None:
    text = page_html(Page("Title", [Paragraph("One")]))
    (policy,) = re.findall(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', text)
    rules = dict(rule.split(" ", 1) for rule in policy.split("; "))
    assert rules["default-src"] == "'none'"
    assert "connect-src" not in rules
    scripts = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)
    hashes = [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts]
    assert rules["script-src"].split() == [f"'sha256-{found}'" for found in hashes]
    assert text.index("Content-Security-Policy") < text.index("<style>")
