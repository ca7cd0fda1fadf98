"""The recipes of docs/start/load_a_set.md run as they stand there; those of packages that are absent are skipped."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import torch

import siggen

PAGE = (Path(__file__).resolve().parents[3] / "docs" / "start" / "load_a_set.md").read_text(encoding="utf-8")
BLOCKS = {
    title: re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    for title, text in re.findall(r"^#+ ([^\n]+)\n(.*?)(?=^#+ |\Z)", PAGE, re.DOTALL | re.MULTILINE)
}


def run(title: str, dataset: Any, monkeypatch: pytest.MonkeyPatch, folder: Path) -> dict[str, Any]:
    monkeypatch.setattr(siggen, "open", lambda path: dataset)
    monkeypatch.chdir(folder)
    names: dict[str, Any] = {"__name__": "__main__"}
    (block,) = BLOCKS[title]
    exec(compile(block, f"docs/start/load_a_set.md, {title}", "exec"), names)
    return names


def test_plain_torch(dataset: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    torch.manual_seed(0)
    found = run("Plain PyTorch", dataset, monkeypatch, tmp_path)
    assert found["batch"]["speed_hz"].shape == found["batch"]["class_id"].shape
    assert found["loss"].item() < 1.0  # a model that knows nothing of three states: log 3


# other packages warn of things that are not ours to mend
@pytest.mark.filterwarnings("ignore")
def test_lightning(dataset: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    pytest.importorskip("lightning")
    found = run("Lightning", dataset, monkeypatch, tmp_path)
    assert found["trainer"].global_step == 2 * len(found["loader"])


@pytest.mark.filterwarnings("ignore")
def test_hugging_face(dataset: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    pytest.importorskip("transformers")
    pytest.importorskip("accelerate")
    found = run("Hugging Face Trainer", dataset, monkeypatch, tmp_path)
    assert found["trainer"].state.epoch == 2.0


def test_windows_as_the_first_block_shows_them(dataset: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    found = run("Windows for PyTorch", dataset, monkeypatch, tmp_path)
    assert found["batch"]["windows"].shape[1:] == (2, 8 * 288)
