"""Execute the notebooks: `python docs/scripts/run_notebooks.py [NAME ...]`; copies with outputs go to runs/notebooks.

The commands `siggen` and `siggen-diagnostics` of the cells are those beside the Python that runs this script.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "notebooks"
NAMES = ("first_set", "own_gearbox", "own_indicator", "train_in_torch", "calibrate")
LIMIT_S = 600
"""Of a cell: the first one that simulates may have to compile, on a busy machine."""


def executed(path: Path) -> Any:
    """Return a notebook with its outputs.

    Raises
    ------
    nbclient.exceptions.CellExecutionError
        If a cell failed.
    """
    beside = str(Path(sys.executable).parent)
    os.environ["PATH"] = os.pathsep.join((beside, os.environ.get("PATH", "")))
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=LIMIT_S, kernel_name="python3", coalesce_streams=True).execute()
    return notebook


def main(names: tuple[str, ...]) -> None:
    """Execute notebooks, keep copies, print the CPU time of each with its processes."""
    out = ROOT / "runs" / "notebooks"
    out.mkdir(parents=True, exist_ok=True)
    for name in names:
        before = _cpu_s()
        started_s = time.perf_counter()
        nbformat.write(executed(FOLDER / f"{name}.ipynb"), out / f"{name}.ipynb")
        print(f"{name}: {_cpu_s() - before:.0f} s of CPU, {time.perf_counter() - started_s:.0f} s")


def _cpu_s() -> float:
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


if __name__ == "__main__":
    main(tuple(sys.argv[1:]) or NAMES)
