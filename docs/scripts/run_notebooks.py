"""Execute the notebooks: `python docs/scripts/run_notebooks.py [NAME ...]`; copies with outputs go to runs/notebooks.

The commands `siggen` and `siggen-diagnostics` of the cells are those beside the Python that runs this script. The
copies are kept for the same notebook and the same code of both packages; the site's build takes them from there.
"""

from __future__ import annotations

import os
import sys
import time
from hashlib import sha256
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "notebooks"
KEPT = ROOT / "runs" / "notebooks"
PACKAGES = ("siggen", "diagnostics", "configs")
NAMES = ("first_set", "own_gearbox", "own_indicator", "train_in_torch", "calibrate")
LIMIT_S = 1200
"""Of a cell: the first one that simulates may have to compile, on a busy machine."""


def executed(path: Path) -> Any:
    """Return a notebook with its outputs, from the copy that is kept of this notebook and this code, if there is one.

    Raises
    ------
    nbclient.exceptions.CellExecutionError
        If a cell failed.
    """
    made_of = _digest(path)
    copy = KEPT / path.name
    if copy.exists():
        notebook = nbformat.read(copy, as_version=4)
        if notebook.metadata.get("made_of") == made_of:
            return notebook
    notebook = _executed_now(path)
    notebook.metadata["made_of"] = made_of
    KEPT.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, copy)
    return notebook


def main(names: tuple[str, ...]) -> None:
    """Execute notebooks, keep copies, print the CPU time of each with its processes."""
    for name in names:
        (KEPT / f"{name}.ipynb").unlink(missing_ok=True)
        before, started_s = _cpu_s(), time.perf_counter()
        executed(FOLDER / f"{name}.ipynb")
        print(f"{name}: {_cpu_s() - before:.0f} s of CPU, {time.perf_counter() - started_s:.0f} s")


def _executed_now(path: Path) -> Any:
    beside = str(Path(sys.executable).parent)
    os.environ["PATH"] = os.pathsep.join((beside, os.environ.get("PATH", "")))
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=LIMIT_S, kernel_name="python3", coalesce_streams=True).execute()
    return notebook


def _digest(path: Path) -> str:
    digest = sha256(path.read_bytes())
    for package in PACKAGES:
        for file in sorted((*(ROOT / package).rglob("*.py"), *(ROOT / package).rglob("*.yaml"))):
            digest.update(file.read_bytes())
    return digest.hexdigest()


def _cpu_s() -> float:
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


if __name__ == "__main__":
    main(tuple(sys.argv[1:]) or NAMES)
