"""Commands in a folder of somebody else: no module of that folder is executed, by the command or its processes."""

from __future__ import annotations

import sys
from importlib.metadata import packages_distributions
from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile

from siggen.engines.processes import ProcessEngine
from tests.engines import tasks
from tests.walks.walking import FS_HZ, recorded, walk

EXECUTED = "executed"
DESCRIBED = "--unit g --teeth 18,47 --speed-range 28,32"


def lay_traps(folder: Path) -> None:
    """Lay a module for every name that could be imported: it leaves a note when it is executed."""
    names = {*sys.stdlib_module_names, *packages_distributions(), "siggen", "diagnostics", "ray", "distributed"}
    for name in names:
        if name.isidentifier():
            note = f"open({str(folder / EXECUTED)!r}, 'a').write({name!r} + chr(10))\n"
            (folder / f"{name}.py").write_text(note)


def executed(folder: Path) -> list[str]:
    note = folder / EXECUTED
    return sorted(set(note.read_text().split())) if note.exists() else []


@pytest.fixture
def traps(tmp_path: Path) -> Path:
    lay_traps(tmp_path)
    return tmp_path


def test_workers_of_a_set_take_no_module_from_the_folder(traps: Path) -> None:
    walk(traps, "siggen generate quickstart --set specimens=2 --set duration_s=0.1 --workers 2 --out set")
    assert not executed(traps)


def test_processes_that_read_recordings_take_no_module_from_the_folder(traps: Path) -> None:
    for seed, name in enumerate(("may", "june")):
        wavfile.write(traps / f"{name}.wav", round(FS_HZ), recorded(seed, 0.0).astype(np.float32))
    walk(traps, f"siggen-diagnostics indicators may.wav june.wav {DESCRIBED} --out table")
    assert not executed(traps)


def test_workers_of_a_script_import_beside_the_script_and_not_from_the_folder(
    traps: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(traps)
    assert dict(ProcessEngine(1).map(tasks.square, range(3))) == {0: 0, 1: 1, 2: 4}
    assert not executed(traps)
