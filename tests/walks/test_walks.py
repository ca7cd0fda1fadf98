"""What a user comes for, from beginning to end in at most five commands."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pyarrow.csv
import pyarrow.parquet
import pytest
import yaml
from scipy.io import wavfile

import siggen
from tests.publication.conftest import FACTS
from tests.rig_file import rig_file
from tests.walks.walking import FS_HZ, printed, recorded, walk

PAGE = Path(__file__).resolve().parents[2] / "docs" / "understand" / "baselines.md"
STATES = ("healthy", "slight", "severe")
SIZE = "--set specimens=6 --set duration_s=0.3 --set 'splits={train: 10, validation: 4, test: 6}'"
RECORDING = "set/data/test-00000.parquet:2 --fs 25600 --rig tacho.yaml"


@pytest.fixture(scope="session")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the drawing of a gearbox, and a small set of three of its states."""
    folder = tmp_path_factory.mktemp("rig")
    drawing = "--teeth 18,47 --module 3 --face-width 20 --speed 33,36 --torque 30,45 --sensors 1"
    walk(folder, f"siggen init {drawing} --out rig.yaml")
    raw = yaml.safe_load((folder / "rig.yaml").read_text())
    raw["states"] = {**raw["states"], "healthy_again": None, "moderate": None, "sham": None}
    raw["states"]["severe"] |= {"grows": "slight"}
    (folder / "rig.yaml").write_text(yaml.safe_dump(raw, sort_keys=False))
    (folder / "tacho.yaml").write_text("teeth: 18,47\ntacho: tacho_s\n")
    walk(folder, f"siggen generate rig.yaml {SIZE} --out set --executor serial")
    return folder


@pytest.fixture(scope="session")
def models(rig: Path) -> Path:
    walk(rig, "siggen-diagnostics report set --no-cnn --out set_report")
    return rig / "set_report" / "models"


def blocks() -> list[str]:
    """Return the Python blocks of the page on one's own classifier, with the names of this set and training."""
    section = PAGE.read_text(encoding="utf-8").split("\n## Your own classifier\n")[1].split("\n## ")[0]
    found = re.findall(r"^```python\n(.*?)^```$", section, re.MULTILINE | re.DOTALL)
    return [
        block.replace("runs/quickstart", "set").replace("runs/models", "set_report").replace("runs/", "")
        for block in found
    ]


def test_from_a_drawing_to_a_loaded_training_set(rig: Path) -> None:
    planned = walk(rig, f"siggen plan rig.yaml --trial 0 {SIZE}")
    counts = re.search(r"train (\d), validation (\d), test (\d)", planned)
    assert counts is not None
    (rig / "load.py").write_text(
        "import siggen\n"
        "dataset = siggen.open('set')\n"
        "for split in dataset.splits:\n"
        "    for batch in dataset.records(split):\n"
        "        signal = batch.column(dataset.channels[0].column).flatten().to_numpy().reshape(batch.num_rows, -1)\n"
        "        print(split, batch.num_rows, signal.shape[1], signal.std() > 0)\n"
    )
    loaded = [line.split() for line in walk(rig, "python load.py").splitlines()]
    records = {split: sum(int(rows) for name, rows, *_ in loaded if name == split) for split, *_ in loaded}
    assert records == {
        name: len(STATES) * int(gearboxes)
        for name, gearboxes in zip(("train", "validation", "test"), counts.groups(), strict=True)
    }
    assert {(samples, varies) for _, _, samples, varies in loaded} == {("7680", "True")}


def test_from_a_set_to_scores_of_own_classifiers_beside_the_baselines(rig: Path, models: Path) -> None:
    (rig / "tree.py").write_text(next(block for block in blocks() if "mine.parquet" in block))
    in_python = walk(rig, "python tree.py")
    assert walk(rig, "siggen-diagnostics score set mine.parquet") == in_python
    told = printed(rig, "siggen-diagnostics score set mine.parquet --out scores.csv")["scores"]
    rows = pyarrow.csv.read_csv(rig / "scores.csv").to_pylist()
    assert {row["name"] for row in rows} == {"yours", "indicators", "boosting", "rms"}
    assert told == rows
    reported = json.loads((models.parent / "metrics.json").read_text())["training"]["classifiers"]
    judged = [row for row in rows if row["name"] != "yours" and row["records"] != "sham against healthy"]
    for row in judged:  # a sham is judged by `score` alone
        if row["measure"] in ("AUC", "balanced accuracy", "macro AUROC"):
            assert (row["score"], row["low"], row["high"]) == published(row, reported[row["name"]])


@pytest.mark.slow
def test_scores_of_an_own_network(rig: Path) -> None:
    (rig / "network.py").write_text(next(block for block in blocks() if "import torch" in block))
    assert "  yours " in walk(rig, "python network.py")


def published(row: dict[str, object], metrics: dict[str, dict[str, dict[str, float]]]) -> tuple[float, ...]:
    """Return what `metrics.json` says of a score."""
    found = {
        "AUC": {"every damage": metrics["detection"]["auroc"], **metrics["detection"]["auroc_by_state"]},
        "balanced accuracy": {"all": metrics["balanced_accuracy"]},
        "macro AUROC": {"all": metrics["macro_auroc"]},
    }[str(row["measure"])][str(row["records"])]
    return found["value"], found["low"], found["high"]


def test_from_recordings_of_a_healthy_machine_to_a_verdict(tmp_path: Path) -> None:
    for seed, month in enumerate(("april", "may", "june", "july")):
        rows = (f"{k / FS_HZ:.6f};{value:.6f};0" for k, value in enumerate(recorded(seed, 0.0)))
        text = "\n".join(rows).replace(".", ",")
        (tmp_path / f"{month}.csv").write_text(f"time;vibration;key\n{text}\n")
    for seed, (month, depth) in enumerate({"august": 0.0, "september": 0.7}.items(), 8):
        wavfile.write(tmp_path / f"{month}.wav", round(FS_HZ), recorded(seed, depth).astype(np.float32))
    described = " ".join(rig_file(tmp_path, channels={"vibration": 2}, unit="g", teeth="18,47", speed="28,32"))
    walk(tmp_path, f"siggen-diagnostics baseline april.csv may.csv june.csv july.csv {described} --out machine")
    said = walk(tmp_path, "siggen-diagnostics check machine august.wav september.wav", code=4)
    assert "august.wav: unchanged" in said
    assert "september.wav: changed" in said
    assert (tmp_path / "machine" / "machine.html").stat().st_size > 10_000


def test_from_a_set_to_a_ranking_of_an_own_indicator(rig: Path) -> None:
    (rig / "own.py").write_text(
        "import numpy as np\n\n\n"
        "def crest(signal, tacho, gears):\n"
        "    return float(np.abs(signal).max() / np.sqrt(np.mean(np.square(signal))))\n"
    )
    walk(rig, "siggen-diagnostics indicators set --indicator own:crest --out indicators")
    table = pyarrow.parquet.read_table(rig / "indicators" / "indicators.parquet")
    dataset = siggen.open(rig / "set")
    (channel,) = dataset.channels
    for row in table.to_pylist():
        signal = dataset.record(row["record_id"])[channel.column].astype(np.float64)
        expected = np.abs(signal).max() / np.sqrt(np.mean(signal**2))
        assert row[f"crest__{channel.name}"] == pytest.approx(expected, rel=1e-5)
    assert "crest" in (rig / "indicators" / "evaluation.csv").read_text()


def test_from_a_set_to_a_published_folder_that_opens_again(rig: Path) -> None:
    (rig / "publication.yaml").write_text(yaml.safe_dump(FACTS))
    (rig / "reopen.py").write_text(
        "import numpy as np\nimport siggen\n"
        "mine, published = siggen.open('set'), siggen.open('upload')\n"
        "column = mine.channels[0].column\n"
        "print(np.array_equal(mine.record(3)[column], published.record(3)[column]), published.labels().num_rows)\n"
    )
    walk(rig, "siggen publish set --to upload --facts publication.yaml")
    walk(rig, "siggen verify upload --sample 1")
    assert walk(rig, "python reopen.py").split() == ["True", "18"]
    assert "cc-by-4.0" in (rig / "upload" / "README.md").read_text()


def test_predict_by_classifiers_on_indicators(rig: Path, models: Path) -> None:
    said = walk(rig, f"siggen-diagnostics predict set_report {RECORDING} --out prediction")
    assert "state" in said
    written = json.loads((rig / "prediction" / "prediction.json").read_text())
    assert printed(rig, f"siggen-diagnostics predict set_report {RECORDING}") == {
        "predictions": [written],
        "refused": {},
    }


@pytest.mark.slow  # trains both networks
def test_predict_by_networks(rig: Path) -> None:
    walk(rig, "siggen-diagnostics report set --out all_models")
    said = walk(rig, f"siggen-diagnostics predict all_models {RECORDING} --out by_networks")
    assert "network" in said
