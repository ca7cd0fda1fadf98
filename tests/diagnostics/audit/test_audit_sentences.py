"""The summary of an audit, with many gearboxes, with one, and with nothing that could be judged."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from diagnostics.audit.audit_page import audit_summary, verdict_words
from diagnostics.audit.audit_report import Audit
from diagnostics.audit.bank import ChanceLimit, ShamFound, StateChance, gearboxes_needed
from diagnostics.audit.detectability import BestIndicator, Detectability
from diagnostics.audit.leaks import verdict
from diagnostics.statistics.evaluation import Interval


def detection(state: str, length_mm: float, auc: float) -> Detectability:
    sizes = {"damaged_area_mm2": 20 * length_mm, "damage_profile_length_mm": length_mm}
    return Detectability(state, "spalling", sizes, Interval(auc, auc - 0.05, auc + 0.05), 24)


ENTRIES = [detection("mild", 0.5, 0.5), detection("severe", 1.0, 0.9)]
BEST = {
    "mild": BestIndicator("fm4_pinion__x", Interval(0.7, 0.6, 0.8), 0.51, 820),
    "severe": BestIndicator("rms__x", Interval(0.97, 0.92, 1.0), 0.95, 820),
}
AUDIT = Audit((), "No leak.", None, {"indicators": ENTRIES}, (), 0.1, 96, 24, 2, 0, BEST)


def test_the_strongest_detector_is_named_with_interval_and_number_and_lost_means_all_failed() -> None:
    bank = {
        "indicators": ENTRIES,
        "best band": [replace(detection("severe", 1.0, 0.97), basis="orders 9 to 40", tried=300)],
    }
    found = audit_summary(replace(AUDIT, detections=bank, chance=ChanceLimit(0.66, 8, 100)))
    assert found[1] == "The audit used 96\xa0records of 24\xa0specimens (gearboxes) in 2\xa0channels."
    assert "mild is the hardest to find. The strongest of 2\xa0detectors" in found[2]
    assert "is the best single indicator, chosen among 820\xa0columns: AUC 0.51." in found[2]
    assert "is best band: AUC 0.97 (0.92 to 1.02), most often orders 9 to 40 among 300\xa0columns." in found[2]
    assert "8\xa0detectors stays below an AUC of 0.66 in 95\xa0% of 100 permutations" in found[3]
    assert found[4] == "No detector found mild. These failed: the best single indicator and indicators."
    # of the detectors alone: linear between the states, 20 (0.5 + 0.5 (0.75 - 0.5) / 0.47)
    assert "0.75 is reached from 15\xa0mm² of spalling by strongest detector alone" in found[5]


def test_what_a_detector_reaches_on_a_sham_is_no_damage() -> None:
    def sham(auc: float, **reached: float) -> ShamFound:
        chance = StateChance(0.66, 0.3, "block")
        return ShamFound("sham", "alone", "best band", Interval(auc, auc - 0.1, auc + 0.1), chance, reached)

    bank = {"indicators": [detection("severe", 1.0, 0.9)]}
    audit = replace(AUDIT, detections=bank, best={}, shams=(sham(0.55, indicators=0.55),))
    assert verdict_words(audit, "severe") == "can be found, best by indicators (0.90)"
    found = audit_summary(audit)
    assert found[:2] == [
        AUDIT.verdict,
        "Shams, damage without effect, are not told from healthy: at most an AUC of 0.55 (0.45 to 0.65) by best band "
        "on sham; chance reaches 0.66 in 5 % of the cases.",
    ]
    leaking = replace(audit, shams=(sham(0.95, indicators=0.93),))
    assert verdict_words(leaking, "severe") == ("not shown to be damage: indicators reaches 0.90, and 0.93 on a sham")
    # a detector that was not asked about the sham is held against the strongest, if that tells more than chance does
    unasked = replace(audit, shams=(sham(0.95, other=0.95),))
    assert verdict_words(unasked, "severe").startswith("can be found")
    told = replace(unasked.shams[0], chance=StateChance(0.66, 0.002, "block"))
    assert verdict_words(replace(audit, shams=(told,)), "severe").startswith("not shown to be damage")


def test_one_gearbox_is_said_to_be_too_few() -> None:
    found = audit_summary(replace(AUDIT, specimens=1, records=4, channels=1, detections={"indicators": []}, best={}))
    assert len(found) == 2
    assert "used 4\xa0records of 1\xa0specimen (gearboxes) in 1\xa0channel. Leaks that only appear between" in found[1]
    assert "1\xa0gearbox" in verdict([], 1)
    assert "2\xa0gearboxes" in verdict([], 2)
    assert "As far as the audit can see" in verdict([], 4)
    assert verdict([], 24, missing="damaged").startswith("No verdict: the set has no damaged records")
    assert replace(AUDIT, specimens=24, missing="damaged").tells_too_little


def test_where_chance_reaches_what_a_leak_is_accused_of_nothing_is_said_to_be_found() -> None:
    chance = ChanceLimit(1.0, 8, 100)
    few = replace(AUDIT, specimens=6, chance=chance, verdict=verdict([], 6, chance))
    found = audit_summary(few)
    assert found[0].startswith("There are too few gearboxes to tell: chance reaches an AUC of 1.00.")
    assert found[0].endswith("Use at least 24\xa0gearboxes in place of 6.")
    assert not any("is reached from" in sentence or "No detector found" in sentence for sentence in found)
    assert verdict_words(few, "severe") == "too few gearboxes to tell (0.95 by the best single indicator)"
    assert few.tells_too_little
    told = replace(few, chance=replace(chance, auc=0.89))
    assert not told.tells_too_little
    assert "is reached from" in audit_summary(told)[-1]


@pytest.mark.parametrize(
    ("auc", "specimens", "needed"), [(1.0, 6, 24), (0.9, 8, 21), (0.89, 8, None), (math.nan, 8, None)]
)
def test_gearboxes_needed_grow_with_the_square_of_what_chance_reaches(
    auc: float, specimens: int, needed: int | None
) -> None:
    assert gearboxes_needed(ChanceLimit(auc, 8, 100), specimens) == needed


@pytest.mark.parametrize("auc", [math.nan, 0.9])
def test_a_single_state_is_neither_hardest_nor_easiest(auc: float) -> None:
    best = {"severe": BestIndicator("rms__x", Interval(0.97, 0.92, 1.0), auc, 820)}
    found = audit_summary(replace(AUDIT, detections={"indicators": [detection("severe", 1.0, auc)]}, best=best))
    assert not any("hardest" in sentence for sentence in found)
    assert any("The damaged state is severe. The strongest" in sentence for sentence in found) == (auc == 0.9)
    assert any("at most 20\xa0mm²" in sentence for sentence in found) == (auc == 0.9)
    assert "nan" not in " ".join(found)


def test_the_card_says_lost_only_where_the_strongest_detector_stays_below_chance() -> None:
    assert verdict_words(AUDIT, "severe") == "can be found, best by the best single indicator (0.95)"
    assert verdict_words(AUDIT, "mild") == "not found by the best single indicator (0.51) and indicators (0.50)"
    weak = replace(AUDIT, best={"mild": replace(BEST["mild"], held_out=0.65)})
    assert verdict_words(weak, "mild").startswith("hard to find, best by the best single indicator (0.65) of")
    assert verdict_words(replace(weak, chance=ChanceLimit(0.66, 8, 100)), "mild").startswith("not found by")
    # one detector that finds it is enough, whatever the others say
    found = replace(AUDIT, best={"mild": replace(BEST["mild"], held_out=0.8)})
    assert verdict_words(found, "mild") == "can be found, best by the best single indicator (0.80)"
    assert verdict_words(replace(AUDIT, detections={}, best={}), "mild") == "not judged"


def test_a_set_that_can_be_made_again_is_verified_first() -> None:
    assert not any("siggen verify" in sentence for sentence in audit_summary(AUDIT))
    said = audit_summary(replace(AUDIT, made_again="siggen verify SET --sample 10"))
    assert said[1].startswith("First run `siggen verify SET --sample 10`")
