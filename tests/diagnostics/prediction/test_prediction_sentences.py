"""The sentences of a prediction: an answer, or the reasons for none, and what both rest on."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

import siggen
from diagnostics.prediction.prediction import Nearness, Vote
from diagnostics.prediction.prediction_page import model_provenance, prediction_headline, prediction_rows
from diagnostics.recordings.shaft_pulses import ShaftPulses
from diagnostics.records.gear_train import pair_train
from diagnostics.statistics.evaluation import Interval


def prediction(distance: float, reasons: tuple[str, ...] = (), pieces: int = 1) -> Any:
    votes = (
        Vote("indicators", np.array([0.05, 0.95]), None if pieces == 1 else 1.0, Interval(0.45, 0.3, 0.6)),
        Vote("network", np.array([0.6, 0.4]), 0.5),
    )
    near = Nearness(distance, 2.0, ())
    return SimpleNamespace(
        notes=(),
        plain_nearness=near,
        contradiction="",
        own_state=None,
        classes=("healthy", "severe"),
        class_kind="state",
        votes=votes,
        nearness=near,
        reasons=reasons,
        state="abstains" if reasons else "severe",
        pieces=SimpleNamespace(values=np.zeros((pieces, 3)), revolutions=53),
        pulses=ShaftPulses(np.arange(4) / 36.325),
        train=pair_train((18, 47)),
    )


def test_an_answer_comes_with_its_votes_its_distance_and_its_length() -> None:
    found = prediction(0.83)
    assert prediction_headline(found) == "most like severe (95\xa0%)"
    rows = dict(prediction_rows(found))
    assert rows["by indicators"] == "healthy 0.05, severe 0.95; right in 45% of its test records"
    assert rows["by network"] == "healthy 0.60, severe 0.40; 50% of pieces agree"
    assert rows["distance to training"] == "0.83, threshold 2.00"
    assert rows["averaged"] == "1\xa0piece of 53 or more pinion revolutions"
    assert rows["pinion speed"] == "36.3250 Hz (tacho); mesh 653.85 Hz"


def test_without_an_answer_the_first_reason_is_told_and_the_votes_are_withheld() -> None:
    found = prediction(3.0, ("too far from training", "other teeth"), pieces=2)
    assert prediction_headline(found) == "no state is named: too far from training"
    told = prediction_rows(found)
    assert [text for label, text in told if label == "abstains because"] == ["too far from training", "other teeth"]
    assert all(text.endswith(" (do not use)") for label, text in told if label.startswith("by "))


def test_the_program_and_the_set_behind_the_models_are_named() -> None:
    facts: Any = SimpleNamespace(set_name="quickstart", identity="42ab")
    assert model_provenance(facts) == (
        f"Made by siggen-diagnostics {siggen.__version__} with models trained on the set quickstart, identity 42ab."
    )
