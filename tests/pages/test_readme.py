"""The Python blocks of README.md and of the page on loading a set run as they stand there, on a smaller set."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

import siggen

ROOT = Path(__file__).resolve().parents[2]


def blocks(page: str) -> list[str]:
    """Return the Python blocks of a page."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


BLOCKS = blocks("README.md")
LOADING = blocks("docs/start/load_a_set.md")
GIVEN = '"specimens=40"'
QUICK = '"specimens=2", "duration_s=0.3", "states=[{name: healthy}]"'


@pytest.mark.slow  # starts two worker processes
def test_python_blocks_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    assert sum(GIVEN in block for block in BLOCKS) == 1
    shutil.copytree(ROOT / "configs", tmp_path / "configs")
    monkeypatch.chdir(tmp_path)
    for block in BLOCKS:
        exec(compile(block.replace(GIVEN, QUICK), "README.md", "exec"), {"__name__": "__main__"})
    first = siggen.open("runs/forty").labels("train").to_pylist()[0]
    assert str(first) in capsys.readouterr().out

    assert len(LOADING) == 2
    names: dict[str, object] = {}
    for block in LOADING:
        exec(compile(block.replace("runs/quickstart", "runs/forty"), "load_a_set.md", "exec"), names)
    assert names["signals"].shape[1] == 0.3 * 25600
    assert names["batch"]["windows"].shape[1:] == (2, 8 * 288)
