"""Every example answers its question with a picture, in at most 40 lines, from what is installed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

from tests.house.source_tree import ROOT
from tests.pages.running import reader_environment

pytestmark = pytest.mark.timeout(3600)  # one minute of CPU; a busy machine takes many
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
SCRIPT = ROOT / "docs" / "scripts" / "gallery.py"


@pytest.fixture(scope="module")
def pictures(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of all pictures: one fresh process draws them, since several examples read one set."""
    pytest.importorskip("torch")
    folder = tmp_path_factory.mktemp("examples")
    command = [sys.executable, "-W", "ignore", str(SCRIPT), str(folder)]
    ended = subprocess.run(command, env=reader_environment(), cwd=folder, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr[-4000:]
    return folder


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_draws_its_picture(path: Path, pictures: Path) -> None:
    with Image.open(pictures / f"{path.stem}.png") as drawn:
        assert len(drawn.convert("RGB").getcolors(maxcolors=1 << 24) or ()) > 20  # not an empty sheet


def test_there_are_twenty_of_at_most_forty_lines_and_a_kept_picture_of_each() -> None:
    kept = {path.stem for path in (ROOT / "docs" / "figures" / "examples").iterdir()}
    assert {path.stem for path in EXAMPLES} == kept
    assert len(EXAMPLES) == 20
    assert [path.stem for path in EXAMPLES if len(path.read_text(encoding="utf-8").splitlines()) > 40] == []
