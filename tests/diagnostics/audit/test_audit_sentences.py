"""The summary of an audit, with many gearboxes, with one, and with nothing that could be judged."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from diagnostics.audit.audit_report import Audit
from diagnostics.audit.audit_sentences import audit_summary
from diagnostics.audit.best_indicator import BestIndicator
from diagnostics.audit.card_section import verdict_words
from diagnostics.audit.detectability import Detection
from diagnostics.audit.separability_findings import verdict
from diagnostics.statistics.evaluation import Interval


def detection(state: str, length_mm: float, auc: float) -> Detection:
    sizes = {"damaged_area_mm2": 20 * length_mm, "damage_profile_length_mm": length_mm}
    return Detection(state, "spalling", sizes, Interval(auc, auc - 0.05, auc + 0.05), 24)


ENTRIES = [detection("mild", 0.5, 0.5), detection("severe", 1.0, 0.9)]
BEST = {
    "mild": BestIndicator("fm4_pinion__x", Interval(0.7, 0.6, 0.8), 0.51, 820),
    "severe": BestIndicator("rms__x", Interval(0.97, 0.92, 1.0), 0.95, 820),
}
AUDIT = Audit((), "No trap.", None, {"indicators": ENTRIES}, (), 0.1, 96, 24, 2, 0, BEST)


def test_hardest_and_easiest_state_and_the_length_at_an_auc_are_named() -> None:
    found = audit_summary(AUDIT)
    assert found[1] == "The audit used 96\xa0records of 24\xa0specimens (gearboxes) in 2\xa0channels."
    assert "The best of 820\xa0single indicators, fm4_pinion__x, reaches 0.70 (0.60 to 0.80) on the same" in found[2]
    assert "mild is the hardest to find: an indicator chosen on other gearboxes reaches an AUC of 0.51." in found[2]
    assert "For severe an indicator chosen on other gearboxes reaches 0.95." in found[2]
    assert found[3] == "No method found mild. These methods failed: the best single indicator and indicators."
    # linear between the states: 0.5 + 0.5 (0.75 - 0.5) / 0.4
    assert "0.75 is reached from 0.81\xa0mm of spalling by indicators" in found[4]


def test_one_gearbox_is_said_to_be_too_few() -> None:
    found = audit_summary(replace(AUDIT, specimens=1, records=4, channels=1, detections={"indicators": []}, best={}))
    assert len(found) == 2
    assert "used 4\xa0records of 1\xa0specimen (gearboxes) in 1\xa0channel. Traps that only appear between" in found[1]
    assert "1\xa0gearbox" in verdict([], 1)
    assert "2\xa0gearboxes" in verdict([], 2)
    assert "As far as the audit can see" in verdict([], 4)


@pytest.mark.parametrize("auc", [math.nan, 0.9])
def test_a_single_state_is_neither_hardest_nor_easiest(auc: float) -> None:
    best = {"severe": BestIndicator("rms__x", Interval(0.97, 0.92, 1.0), auc, 820)}
    found = audit_summary(replace(AUDIT, detections={"indicators": [detection("severe", 1.0, auc)]}, best=best))
    assert not any("hardest" in sentence for sentence in found)
    assert any("The damaged state is severe: an indicator" in sentence for sentence in found) == (auc == 0.9)
    assert any("at most 1.00\xa0mm" in sentence for sentence in found) == (auc == 0.9)
    assert "nan" not in " ".join(found)


def test_the_card_says_hard_or_lost_only_with_the_probes_that_failed() -> None:
    assert verdict_words(AUDIT, "severe") == "can be found"
    assert verdict_words(AUDIT, "mild") == "not found by the best single indicator (0.51) and indicators (0.50)"
    weak = replace(AUDIT, best={"mild": replace(BEST["mild"], held_out=0.65)})
    assert verdict_words(weak, "mild") == "hard to find by the best single indicator (0.65) and indicators (0.50)"
    # one probe that finds it is enough, whatever the others say
    found = replace(AUDIT, best={"mild": replace(BEST["mild"], held_out=0.8)})
    assert verdict_words(found, "mild") == "can be found"
    assert verdict_words(replace(AUDIT, detections={}, best={}), "mild") == "not judged"
