"""Several classifiers: a contradiction stands beside the answer, each comes with its accuracy."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import diagnostics.prediction.prediction as prediction
from diagnostics.prediction.prediction import NETWORK, Prediction, Vote, predict_recording
from diagnostics.prediction.prediction_page import prediction_facts, prediction_headline, prediction_rows
from diagnostics.prediction.released_model import ReleasedModel, load_model
from diagnostics.recordings.measured_recording import MeasuredRecording
from siggen.errors import UsageError
from siggen.plain_json import plain
from tests.diagnostics.prediction.resealed_model import reseal

FS_HZ = 12_800.0


@pytest.fixture(scope="module")
def model(models_folder: Path) -> ReleasedModel:
    return load_model(models_folder)


@pytest.fixture(scope="module")
def signals(make_dataset: Callable[..., Any]) -> dict[str, np.ndarray]:
    """Return the severe record of a gearbox that nobody trained on."""
    row = make_dataset(("test",) * 2, seed=8).record(2)
    return {name: row[f"accel_{name}_m_s2"] for name in ("bearing_vertical", "bearing_horizontal")}


def predicted(model: ReleasedModel, signals: dict[str, np.ndarray]) -> Prediction:
    return predict_recording(
        model, MeasuredRecording(Path("run.npz"), signals, FS_HZ, None, True), (18, 47), (20.0, 50.0)
    )


def test_a_model_of_forces_takes_no_acceleration(model: ReleasedModel, signals: dict[str, np.ndarray]) -> None:
    of_forces = replace(model, facts=replace(model.facts, units=("m/s^2", "N")))
    with pytest.raises(UsageError, match=r"channel bearing_horizontal is in m/s\^2; allowed: N, as in training"):
        predicted(of_forces, signals)


def with_network(monkeypatch: pytest.MonkeyPatch, probability: tuple[float, ...]) -> None:
    """Let a network say this; its own answers are tested where it is trained."""
    vote = Vote(NETWORK, np.array(probability), 1.0)
    monkeypatch.setattr(prediction, "_network_vote", lambda *_: ((vote,), ()))


def test_a_contradiction_of_the_votes_stands_beside_the_answer_and_is_no_reason_to_abstain(
    model: ReleasedModel, signals: dict[str, np.ndarray], monkeypatch: pytest.MonkeyPatch
) -> None:
    with_network(monkeypatch, (0.97, 0.02, 0.01))
    found = predicted(model, signals)
    sure = found.votes[0].probability.max()
    said = f"the classifiers name different states: indicators severe ({sure:.2f}), network healthy (0.97)"
    assert (found.state, found.reasons, found.contradiction) == ("severe", (), said)
    assert prediction_facts(found, model.facts)["contradiction"] == said
    assert dict(prediction_rows(found))["weak answer"] == said
    assert prediction_headline(found).endswith(", a weak answer)")


def test_votes_that_name_one_state_are_an_answer_however_sure_they_are(
    model: ReleasedModel, signals: dict[str, np.ndarray], monkeypatch: pytest.MonkeyPatch
) -> None:
    with_network(monkeypatch, (0.32, 0.33, 0.35))
    found = predicted(model, signals)
    assert (found.state, found.contradiction) == ("severe", "")


def test_a_vote_comes_with_the_accuracy_that_training_measured(
    model: ReleasedModel, signals: dict[str, np.ndarray]
) -> None:
    found = predicted(model, signals)
    expected = json.loads((model.folder / "model.json").read_text())["scores"]["test"]["indicators"]["accuracy"]
    told = plain(prediction_facts(found, model.facts))
    assert told["probabilities"]["indicators"]["test_accuracy"] == expected
    assert f"right in {expected['value']:.0%} of its test records" in dict(prediction_rows(found))["by indicators"]


def test_a_single_piece_agrees_with_nobody(model: ReleasedModel, signals: dict[str, np.ndarray]) -> None:
    one, two = predicted(model, signals), predicted(model, {name: np.tile(x, 2) for name, x in signals.items()})
    assert (len(one.pieces.values), len(two.pieces.values)) == (1, 2)
    assert one.votes[0].agreement is None
    assert prediction_facts(one, model.facts)["probabilities"]["indicators"]["share_of_pieces_that_agree"] is None
    assert "agree" not in dict(prediction_rows(one))["by indicators"]
    assert two.votes[0].agreement in (0.5, 1.0)
    assert "% of pieces agree" in dict(prediction_rows(two))["by indicators"]


def test_a_model_with_damaged_scores_is_refused(model: ReleasedModel, tmp_path: Path) -> None:
    for file in model.folder.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    reseal(tmp_path, scores={"test": {"indicators": {}}})
    with pytest.raises(UsageError, match=r"model\.json: cannot be used"):
        load_model(tmp_path)
