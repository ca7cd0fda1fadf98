"""Folders of models: files that were not written together are refused by name, a lost network is noted."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

from diagnostics.cli.app import main
from diagnostics.prediction.released_model import load_model
from diagnostics.training.classifiers import LogisticBaseline
from siggen.dataset.seal import sealed, unsealed
from siggen.errors import UsageError
from tests.diagnostics.prediction.resealed_model import reseal


@pytest.fixture
def folder(models_folder: Path, tmp_path: Path) -> Path:
    for file in models_folder.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    return tmp_path


def change(path: Path, **entries: Any) -> None:
    path.write_text(json.dumps(json.loads(path.read_text()) | entries))
    reseal(path.parent)


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"identity": "f" * 64}, f"identity of the set {'f' * 12} instead of {'0' * 12}"),
        ({"classes": ["healthy", "severe", "slight"]}, "classes healthy, severe, slight instead of healthy, slight"),
    ],
)
def test_names_of_another_model_are_refused(entry: dict[str, Any], message: str, folder: Path) -> None:
    change(folder / "feature_names.json", **entry)
    with pytest.raises(UsageError, match=r"feature_names\.json: does not belong to model\.json") as found:
        load_model(folder)
    assert message in str(found.value)
    assert f"siggen-diagnostics report SET --out {folder}" in str(found.value)


def test_features_of_other_channels_are_refused_with_exit_code_2(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    names = json.loads((folder / "feature_names.json").read_text())
    renamed = {key: [name.replace("_vertical", "_axial") for name in names[key]] for key in ("features", "logarithms")}
    change(folder / "feature_names.json", **renamed)
    monkeypatch.setattr(sys, "argv", ["siggen-diagnostics", "predict", str(folder), "run.csv", "--teeth", "18,47"])
    with pytest.raises(SystemExit) as stop:
        main()
    assert stop.value.code == 2
    assert "channels bearing_axial, bearing_horizontal instead of" in " ".join(capsys.readouterr().err.split())


def test_a_pipeline_of_other_size_is_refused(folder: Path) -> None:
    import skops.io

    rows = np.array([[0.0, 1.0], [1.0, 0.0], [2.0, 2.0], [3.0, 1.0]])
    other = LogisticBaseline((0.01,)).fit(rows, np.arange(4), np.arange(4))
    skops.io.dump(other.pipeline_, folder / "classifier.skops")
    reseal(folder)
    with pytest.raises(UsageError, match=r"classifier\.skops: does not belong .*takes 2 features .* class 4 of 3"):
        load_model(folder)


def test_a_network_of_another_model_is_refused(folder: Path) -> None:
    torch = pytest.importorskip("torch")
    pytest.importorskip("safetensors")
    from diagnostics.training.cnn import CircularNetwork, TrainedNetwork, save_network

    torch.manual_seed(0)
    trained = TrainedNetwork(
        CircularNetwork(6, 3), ("healthy", "slight", "severe"), ("bearing_vertical", "bearing_horizontal")
    )
    for identity in ("f" * 64, "0" * 64):
        save_network(replace(trained, identity=identity), folder / "cnn.safetensors")
        reseal(folder)
        if identity[0] == "f":
            with pytest.raises(UsageError, match=r"cnn\.safetensors: does not belong .*identity"):
                load_model(folder)
    assert load_model(folder).network is not None


def test_a_lost_network_that_was_scored_is_noted(folder: Path) -> None:
    assert load_model(folder).note == ""
    facts = json.loads((folder / "model.json").read_text())
    facts["scores"]["test"]["network"] = facts["scores"]["test"]["indicators"]
    reseal(folder, scores=facts["scores"])
    assert load_model(folder).note.startswith("network left out: model.json gives its scores, but cnn.safetensors is")


@pytest.mark.parametrize("name", ["classifier.skops", "feature_names.json", "model.json", "model_card.md"])
def test_a_flipped_bit_anywhere_in_a_file_is_refused(name: str, folder: Path) -> None:
    whole, chance = (folder / name).read_bytes(), Random(name)
    for _ in range(15):
        broken = bytearray(whole)
        broken[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
        (folder / name).write_bytes(broken)
        with pytest.raises(UsageError, match=name.replace(".", r"\.")):
            load_model(folder)
    (folder / name).write_bytes(whole)
    assert load_model(folder).note == ""


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"temperature": float("nan")}, "received temperature nan; allowed: finite and above 0"),
        ({"temperature": 0.0}, r"received temperature 0\.0"),
        ({"strength": float("inf")}, "received strength inf"),
        ({"features": ["rms__x", "rms__x"]}, "features that are no names or come twice"),
        ({"logarithms": ["colour"]}, "logarithms of colour, which is no feature"),
        ({"classes": None}, "received another schema"),
    ],
)
def test_values_that_cannot_be_are_refused_even_under_fitting_hashes(
    entry: dict[str, Any], message: str, folder: Path
) -> None:
    change(folder / "feature_names.json", **entry)
    with pytest.raises(UsageError, match=message):
        load_model(folder)


def test_features_in_another_order_are_refused_by_the_hash(folder: Path) -> None:
    path = folder / "feature_names.json"
    facts = json.loads(path.read_text())
    path.write_text(json.dumps(facts | {"features": facts["features"][::-1]}))
    with pytest.raises(UsageError, match=r"feature_names\.json not as model\.json promises"):
        load_model(folder)


def test_a_model_that_does_not_say_what_its_classes_are_is_refused_with_the_way_out(folder: Path) -> None:
    content = unsealed("model.json", (folder / "model.json").read_bytes())
    assert content["facts"].pop("class_kind") == "state"
    (folder / "model.json").write_bytes(sealed(content | {"format": "siggen-diagnostics model 5"}))
    with pytest.raises(UsageError, match=r"received format '.* 5'.*Train again: .*"):
        load_model(folder)


def test_an_unknown_kind_of_class_in_a_model_is_refused(folder: Path) -> None:
    content = unsealed("model.json", (folder / "model.json").read_bytes())
    content["facts"]["class_kind"] = "colour"
    (folder / "model.json").write_bytes(sealed(content))
    with pytest.raises(UsageError, match="received 'colour'; allowed are state, fault"):
        load_model(folder)
