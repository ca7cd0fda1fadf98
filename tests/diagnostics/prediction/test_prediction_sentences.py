"""The sentences of a prediction: an answer, or the reasons for none, and what both rest on."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

import siggen
from diagnostics.prediction.prediction import Nearness, Vote
from diagnostics.prediction.prediction_page import model_provenance, prediction_summary
from diagnostics.recordings.shaft_pulses import ShaftPulses
from diagnostics.records.gear_train import pair_train
from diagnostics.statistics.evaluation import Interval


def prediction(distance: float, reasons: tuple[str, ...] = (), pieces: int = 1) -> Any:
    votes = (
        Vote("indicators", np.array([0.05, 0.95]), None if pieces == 1 else 1.0, Interval(0.45, 0.3, 0.6)),
        Vote("network", np.array([0.6, 0.4]), 0.5),
    )
    return SimpleNamespace(
        contradiction="",
        own_state=None,
        classes=("healthy", "severe"),
        class_kind="state",
        votes=votes,
        nearness=Nearness(distance, 2.0, ()),
        reasons=reasons,
        state="abstains" if reasons else "severe",
        pieces=SimpleNamespace(values=np.zeros((pieces, 3)), revolutions=53),
        pulses=ShaftPulses(np.arange(4) / 36.325),
        train=pair_train((18, 47)),
    )


def test_an_answer_comes_with_its_votes_its_distance_and_its_length() -> None:
    assert prediction_summary(prediction(0.83)) == [
        "The recording is most like the state severe.",
        "The most probable state is severe by indicators (95\xa0%; right in 45\xa0% of its test records) and healthy "
        "by the 1-D network (60\xa0%; 50\xa0% of the pieces agree).",
        "Its distance to the training records is 0.83, within the threshold of 2.00.",
        "The models used 1\xa0piece of 53 or more pinion revolutions. The pinion speed is 36.33\xa0Hz (tacho).",
    ]


def test_without_an_answer_the_reasons_come_first_and_the_votes_are_withheld() -> None:
    found = prediction_summary(prediction(3.0, ("too far from training.", "other teeth"), pieces=2))
    assert found[0] == "The models give no answer for this recording. Too far from training. Other teeth."
    assert found[1].endswith(". Do not use these states.")
    assert "(95\xa0%; 100\xa0% of the pieces agree; right in 45\xa0% of its test records)" in found[1]
    assert "3.00, beyond the threshold" in found[2]
    assert "2\xa0pieces" in found[3]


def test_the_program_and_the_set_behind_the_models_are_named() -> None:
    facts: Any = SimpleNamespace(set_name="quickstart", identity="42ab")
    assert model_provenance(facts) == (
        f"Made by siggen-diagnostics {siggen.__version__} with models trained on the set quickstart, identity 42ab."
    )
