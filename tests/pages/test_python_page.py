"""The page of the Python API has every public name, in the words of its docstring."""

from __future__ import annotations

import subprocess
import sys

import diagnostics.loader
import siggen
from tests.house.source_tree import ROOT

PAGE = ROOT / "docs/reference/python.md"


def test_the_page_of_the_python_api_is_what_its_script_prints() -> None:
    script = ROOT / "docs/scripts/python_reference.py"
    done = subprocess.run([sys.executable, script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert PAGE.read_text(encoding="utf-8") == done.stdout, "make reference"


def test_it_has_every_public_name() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for package in (siggen, diagnostics, diagnostics.loader):
        named = (f"{package.__name__}.{name}" for name in package.__all__)
        assert not [name for name in named if f"### `{name}`" not in page]
