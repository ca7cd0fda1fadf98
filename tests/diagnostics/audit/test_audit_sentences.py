"""The summary of an audit, with many gearboxes, with one, and with nothing that could be judged."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from diagnostics.audit.audit_report import Audit
from diagnostics.audit.audit_sentences import audit_summary
from diagnostics.audit.detectability import Detection
from diagnostics.audit.separability_findings import verdict
from diagnostics.statistics.evaluation import Interval


def detection(state: str, length_mm: float, auc: float) -> Detection:
    sizes = {"damaged_area_mm2": 20 * length_mm, "damage_profile_length_mm": length_mm}
    return Detection(state, "spalling", sizes, Interval(auc, auc - 0.05, auc + 0.05), 24)


ENTRIES = [detection("mild", 0.5, 0.5), detection("severe", 1.0, 0.9)]
AUDIT = Audit((), "No trap.", None, {"indicators": ENTRIES}, (), 0.1, 96, 24, 2, 0)


def test_hardest_and_easiest_state_and_the_length_at_an_auc_are_named() -> None:
    found = audit_summary(AUDIT)
    assert found[1] == "Judged on 96\xa0records of 24\xa0specimens (gearboxes) in 2\xa0channels."
    assert "from 0.50 (0.45 to 0.55) for mild to 0.90 (0.85 to 0.95) for severe; mild is lost" in found[2]
    # linear between the states: 0.5 + 0.5 (0.75 - 0.5) / 0.4
    assert "0.75 is reached from 0.81\xa0mm of spalling by indicators" in found[3]


def test_one_gearbox_is_said_to_be_too_few() -> None:
    found = audit_summary(replace(AUDIT, specimens=1, records=4, channels=1, detections={"indicators": []}))
    assert len(found) == 2
    assert "Judged on 4\xa0records of 1\xa0specimen (gearboxes) in 1\xa0channel: traps that show between" in found[1]
    assert "1\xa0gearbox" in verdict([], 1)
    assert "2\xa0gearboxes" in verdict([], 2)
    assert "as far as the audit can see" in verdict([], 4)


@pytest.mark.parametrize("auc", [math.nan, 0.9])
def test_a_single_state_is_neither_hardest_nor_easiest(auc: float) -> None:
    found = audit_summary(replace(AUDIT, detections={"indicators": [detection("severe", 1.0, auc)]}))
    assert not any("goes from" in sentence for sentence in found)
    assert any("severe is told from healthy with an AUC of 0.90" in sentence for sentence in found) == (auc == 0.9)
    assert any("at most 1.00\xa0mm" in sentence for sentence in found) == (auc == 0.9)
    assert "nan" not in " ".join(found)
