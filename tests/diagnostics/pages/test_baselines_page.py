"""The figures of docs/understand/baselines.md are those of the published report."""

from __future__ import annotations

import re

from tests.diagnostics.pages.published_report import ROOT, report_rows

PAGE = (ROOT / "docs" / "understand" / "baselines.md").read_text(encoding="utf-8")


def test_the_calibration_of_the_network_is_that_of_the_published_report() -> None:
    cells = report_rows("with the temperature T")["1-D network"]
    temperature, _, _, before, after, honest = (text for text, _ in cells[1:])
    said = re.search(
        r"the network gets T = ([\d.]+)\. Its calibration error\s+is ([\d.]+) without T, ([\d.]+) with T, and would be "
        r"([\d.]+) if",
        PAGE,
    )
    assert said is not None
    assert said.groups() == (temperature, before, after, honest)


def test_the_epochs_of_both_networks_are_those_of_the_published_report() -> None:
    rows = report_rows("Scores on")
    trained = {name: re.search(r"epoch \d+ of (\d+)", rows[name][0][1]) for name in rows if "network" in name}
    for name, pattern in (
        ("1-D network", r"the network alone .*, an epoch of (\d+)"),
        ("circular network on the average", r"the circular network alone, an epoch of (\d+)"),
    ):
        said, found = re.search(pattern, PAGE), trained[name]
        assert said is not None
        assert found is not None
        assert said.group(1) == found.group(1), name
