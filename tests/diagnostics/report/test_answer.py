"""Three sentences say which damage is found from which size on, by what and how surely, and no more than is known."""

from __future__ import annotations

import math
from dataclasses import replace

from diagnostics.judging.alarms import (
    CHOSEN,
    CLASSIFIER,
    INDICATOR,
    NETWORKS,
    Detectors,
    FoundSize,
    JudgedDetector,
    StateFound,
)
from diagnostics.report.answer import ANSWERS, LOOKS, answer_figure, answer_sentences
from diagnostics.statistics.evaluation import Interval

FOUND_MEANS = "Found: the record gives an alarm, as 5 % of healthy records do."
BESIDE = "With a healthy record of the same gearbox"


def detector(auc: float, found_mm2: float, healthy: int = 24) -> JudgedDetector:
    share = Interval(0.4, 0.3, 0.5)
    states = {
        "slight": StateFound("pitting", 1.0, Interval(0.66, 0.55, 0.75), share),
        "severe": StateFound("pitting", 8.0, Interval(0.9, 0.8, 1.0), share),
    }
    sizes = {"pitting": FoundSize(Interval(found_mm2, 2.0, math.inf), 1.0, 8.0)}
    area = Interval(auc, auc - 0.1, auc + 0.1)
    return JudgedDetector("logistic regression", False, area, states, sizes, 72, 24, healthy)


def screen(found: Detectors) -> str:
    return ANSWERS.first_answer(found).replace("\xa0", " ")


def with_choice(found: dict[str, JudgedDetector]) -> dict[str, JudgedDetector]:
    """Return detectors with the first, which the other gearboxes choose."""
    return {**found, CHOSEN: next(iter(found.values()))} if found else {}


def said(**found: JudgedDetector) -> dict[str, str]:
    return {
        question: text.replace("\xa0", " ") for question, text in answer_sentences(Detectors(with_choice(found), {}))
    }


def test_a_size_that_is_reached_has_limits_and_one_that_is_not_gives_the_share_of_the_largest() -> None:
    reached = said(**{CLASSIFIER: detector(0.8, 4.0)})["From which size"]
    assert reached == (
        f"Pitting is found in nine of ten records from 4 mm² on (2 mm² to beyond the largest of the set). {FOUND_MEANS}"
    )
    never = said(**{CLASSIFIER: detector(0.8, math.inf)})["From which size"]
    assert never == (
        "Pitting: nine of ten records are found at no size of the set. Of the largest (severe, up to 8 mm²) it is 40 % "
        f"of records (30 % to 50 %). {FOUND_MEANS}"
    )


def test_a_sham_opens_the_answer_and_what_is_found_no_better_counts_as_not_found() -> None:
    honest = replace(detector(0.8, 4.0), sham=Interval(0.52, 0.4, 0.64))
    (first, *_) = said(**{CLASSIFIER: honest}).items()
    assert first == (
        "On a sham",
        "Damage without any effect is told from healthy records with an AUC of 0.52 (0.40 to 0.64) alone; 0.5 is "
        "chance.",
    )
    leaking = said(**{CLASSIFIER: replace(honest, sham=Interval(0.7, 0.6, 0.8))})["On a sham"]
    assert leaking.endswith("What is told of slight alone is within these limits, so it counts as not told.")


def test_a_large_area_is_written_in_full_with_two_digits() -> None:
    spalled = replace(detector(0.8, 164.0), sizes={"pitting": FoundSize(Interval(164.0, 96.0, 1240.0), 1.0, 2000.0)})
    found = said(**{CLASSIFIER: spalled})["From which size"]
    assert found == f"Pitting is found in nine of ten records from 160 mm² on (96 mm² to 1200 mm²). {FOUND_MEANS}"


def test_the_choice_is_named_with_the_others_beside_it_and_a_network_of_few_gearboxes_is_never_chosen() -> None:
    network = replace(detector(1.0, 1.0), title="1-D network", specimens=5)
    indicator = replace(detector(0.9, 4.0), title=INDICATOR, basis="rms__side_1_axial")
    found = said(**{INDICATOR: indicator, CLASSIFIER: detector(0.8, 4.0), NETWORKS: network})
    assert found["By what"] == (
        "Each group of gearboxes is judged by the detector that is best on the others (nested cross-validation): "
        "always the best single indicator (RMS at side_1_axial). AUC 0.90 (0.80 to 1.00) for all damage together; 0.5 "
        "is chance. Each alone: logistic regression 0.80 (0.70 to 0.90), 1-D network 1.00 (0.90 to 1.10) on 5 test "
        "gearboxes alone."
    )


def test_few_healthy_records_and_no_detector_at_all_are_said() -> None:
    few = replace(detector(0.8, 4.0, healthy=7), sizes={})
    assert "7 healthy records set no threshold" in said(**{CLASSIFIER: few})["From which size"]
    assert list(said()) == ["No answer"]
    assert "the set has one healthy record per gearbox" in said(**{CLASSIFIER: few})[BESIDE]


def test_a_healthy_record_beside_says_what_is_then_found_in_nine_of_ten() -> None:
    beside = replace(detector(0.9, 4.0), referenced=True)
    answers = dict(
        answer_sentences(Detectors(with_choice({CLASSIFIER: detector(0.8, 6.0)}), with_choice({CLASSIFIER: beside})))
    )
    assert answers[BESIDE].replace("\xa0", " ") == (
        "AUC 0.90 (0.80 to 1.00) by the logistic regression. Nine of ten records are then found of pitting from 4 mm² "
        "on (2 mm² to beyond the largest of the set)."
    )


def test_a_choice_that_differs_from_fold_to_fold_is_said_and_stands_above_what_it_chose_from() -> None:
    mixed = replace(detector(0.7, 4.0), picks=(("gradient boosting", 4), ("logistic regression", 1)))
    answers = dict(answer_sentences(Detectors({CLASSIFIER: detector(0.8, 6.0), CHOSEN: mixed}, {})))
    assert answers["By what"].replace("\xa0", " ") == (
        "Each group of gearboxes is judged by the detector that is best on the others (nested cross-validation): "
        "gradient boosting for 4 of 5 groups and logistic regression for 1. AUC 0.70 (0.60 to 0.80) for all damage "
        "together; 0.5 is chance. Each alone: logistic regression 0.80 (0.70 to 0.90). To pick the largest of these "
        "would use the answer. No network was trained."
    )
    assert "from 4 mm²" in answers["From which size"].replace("\xa0", " ")


def test_the_figure_has_a_mark_for_the_chosen_size_and_says_where_sizes_are_too_few() -> None:
    one = detector(0.8, 4.0)
    slight = StateFound("spalling", 1.0, Interval(0.6, 0.5, 0.7), None)
    mixed = replace(one, states={**one.states, "small": slight}, picks=(("gradient boosting", 5),))
    figure = answer_figure(Detectors({CLASSIFIER: one, CHOSEN: mixed}, {}))
    assert figure is not None
    above, below = figure.axes
    marks = {(line.get_color(), float(line.get_xdata()[0])) for line in below.lines if line.get_marker() == "o"}
    assert marks == {(LOOKS[CHOSEN][1], 4.0)}
    assert [text.get_text() for text in below.texts] == ["too few sizes"]
    underlined = [line.get_linestyle() for line in below.lines if not line.get_clip_on()]
    drawn = [line.get_linestyle() for line in above.lines if line.get_color() == LOOKS[CHOSEN][1]]
    assert underlined == drawn
    assert len(set(drawn)) == 2


def test_the_first_screen_names_damage_size_detector_and_certainty() -> None:
    found = Detectors({CLASSIFIER: detector(0.8, 4.0), CHOSEN: detector(0.8, 4.0)}, {})
    assert screen(found) == (
        "**Pitting from 4 mm² on** (2 to beyond the largest) is found in **nine of ten records**. Detector: "
        "**logistic regression**."
    )
    sure = ANSWERS.first_certainty(found, error_free=False, audit="No leak was found. More.").replace("\xa0", " ")
    assert sure == (
        "**Each of 24 gearboxes was judged by a model that had learnt from others alone.** Of healthy records 5 % give "
        "a false alarm. All damage together: **AUC 0.80** (95 % limits 0.70 to 0.90; 0.5 is chance, 1 is perfect). No "
        "leak was found (something other than damage that tells the labels)."
    )


def test_where_some_states_are_told_their_alarms_stand_beside_those_of_healthy_records() -> None:
    never = replace(detector(0.8, math.inf), share=Interval(0.5, 0.4, 0.6))
    severe = StateFound("pitting", 20.0, Interval(0.99, 0.95, 1.0), Interval(1.0, 0.9, 1.0))
    slight = StateFound("pitting", 1.0, Interval(0.52, 0.44, 0.6), Interval(0.06, 0.02, 0.1))
    some = replace(never, states={"slight": slight, "moderate": never.states["severe"], "severe": severe})
    assert screen(Detectors({CHOSEN: some}, {})) == (
        "**Only severe (20 mm²) is found**. Records that alarm: severe (20 mm²) 100 %, moderate (8 mm²) 40 %; healthy "
        "5 %. Not told from healthy: **slight (1 mm²)**. Detector: **logistic regression**. Next: two healthy records "
        "of each gearbox (`repeats: 2`), so that each is judged beside one."
    )
    none = replace(some, states={name: some.states[name] for name in ("slight", "moderate")})
    assert screen(Detectors({CHOSEN: none}, {CHOSEN: some})).startswith(
        "**No size is found in nine of ten records**. Records that alarm: moderate (8 mm²) 40 %; healthy 5 %. Not told"
    )
    other = replace(some, states={**some.states, "chip": replace(slight, kind="chipping")})
    assert "Only severe (20 mm²) of pitting is found" in screen(Detectors({CHOSEN: other}, {}))
    assert "**Chipping** is not told from healthy." in screen(Detectors({CHOSEN: other}, {}))
    many = {f"state_{k}": replace(slight, area_mm2=float(k + 1)) for k in range(30)}
    crowded = screen(Detectors({CHOSEN: replace(some, states={**many, "severe": severe})}, {}))
    assert "state_26 (27 mm²) and 26 more**" in crowded


def test_where_nothing_is_told_chance_stands_beside_it_and_less_than_chance_is_called_out() -> None:
    share, low = Interval(0.05, 0.02, 0.09), Interval(0.42, 0.35, 0.49)
    states = {"severe": StateFound("pitting", 8.0, low, share), "slight": StateFound("pitting", 1.0, share, share)}
    nothing = replace(detector(0.42, math.inf), every=low, states=states, share=share)
    found = Detectors({CHOSEN: nothing}, {CHOSEN: nothing})
    assert screen(found) == (
        "**Nothing was found**: AUC **0.42** (0.35 to 0.49), chance is 0.5; 5 % of damaged and 5 % of healthy records "
        "alarm. **Below chance, with its whole interval: AUC of all damage together (0.35 to 0.49), severe (0.35 to "
        "0.49) and slight (0.02 to 0.09)**. What was learnt turns round on other gearboxes: look for a leak (`audit`). "
        "Detector: **logistic regression**. Next: more gearboxes or larger damage; a healthy record of the same "
        "gearbox tells no more."
    )
    assert "found" not in said(**{CLASSIFIER: nothing})["From which size"].replace("Found: the record", "")
    beside = screen(Detectors({CHOSEN: nothing}, {CHOSEN: detector(0.8, 4.0)}))
    assert beside.endswith("Beside a healthy record of the same gearbox **slight and severe** are told.")
    leaking = replace(detector(0.8, 4.0), sham=Interval(0.9, 0.8, 0.99))
    assert "What is told is no more than on damage without effect (AUC up to 0.99)." in screen(
        Detectors({CHOSEN: leaking}, {})
    )


def test_what_takes_from_the_answer_stands_on_the_first_screen() -> None:
    leaking = Detectors({CHOSEN: replace(detector(0.8, 4.0), sham=Interval(0.7, 0.6, 0.8))}, {})
    sure = ANSWERS.first_certainty(leaking, error_free=True, audit="A leak was found. More.")
    assert "**Damage without effect is told too (AUC 0.70)**: slight is not told." in sure
    assert "**The gears have no manufacturing errors**" in sure
    assert sure.endswith("A leak was found (something other than damage that tells the labels).")
    unasked = ANSWERS.first_certainty(leaking, error_free=False, audit="The audit was not run. So it is not known.")
    assert unasked.endswith("The audit was not run.")
    assert ANSWERS.first_answer(Detectors({}, {})).startswith("**No answer**")
