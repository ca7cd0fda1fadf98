"""Commands in a folder of somebody else: no module of that folder is executed, by the command or its processes."""

from __future__ import annotations

import sys
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

from siggen.cli.inspect import View
from siggen.workers.choice import workers_of
from siggen.workers.tasks import results
from tests.every_command import LEAVES
from tests.walks.lines import LINES, lay, lines
from tests.walks.walking import fresh
from tests.workers import tasks

EXECUTED = "executed"
PACKAGES = {"dask": "distributed", "ray": "ray"}
QUICK = {"siggen generate", "siggen-diagnostics indicators", "siggen-diagnostics score"}
"""They start processes: to simulate, to read strangers' recordings and predictions."""


def lay_traps(folder: Path) -> None:
    """Lay a module for every name that could be imported: it leaves a note when it is executed."""
    names = {*sys.stdlib_module_names, *packages_distributions(), "siggen", "diagnostics", *PACKAGES.values()}
    for name in names:
        if name.isidentifier():
            note = f"open({str(folder / EXECUTED)!r}, 'a').write({name!r} + chr(10))\n"
            (folder / f"{name}.py").write_text(note)


def executed(folder: Path) -> list[str]:
    note = folder / EXECUTED
    return sorted(set(note.read_text().split())) if note.exists() else []


def executed_by(line: str, folder: Path, factory: pytest.TempPathFactory, code: int = 0) -> list[str]:
    """Return the names of modules that a line executed, in a folder with what it needs and the traps."""
    lay(folder, line, factory)
    lay_traps(folder)
    fresh(folder, line.replace("OUT/", "").replace("IN/", ""), code)
    return executed(folder)


def test_every_command_has_a_line() -> None:
    views = [f"siggen inspect {view}" for view in View]
    assert sorted(LINES) == sorted([*views, *(name for name in LEAVES if name != "siggen inspect")])


@pytest.mark.parametrize("name", lines(LINES, QUICK))
def test_no_command_takes_a_module_from_the_folder(
    name: str, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    assert not executed_by(f"{name} {LINES[name].words}", tmp_path, tmp_path_factory, LINES[name].code)


@pytest.mark.slow
@pytest.mark.parametrize(
    "line",
    [
        "siggen-diagnostics indicators set --out table",
        "siggen-diagnostics explore set --out look.html",
        "siggen generate short.yaml --executor dask --workers 2 --out new",
        "siggen generate short.yaml --executor ray --workers 2 --out new",
    ],
)
def test_nor_do_other_workers(line: str, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    for name, package in PACKAGES.items():
        if f"--executor {name}" in line:
            pytest.importorskip(package)
    assert not executed_by(line, tmp_path, tmp_path_factory)


def test_workers_of_a_script_import_beside_the_script_and_not_from_the_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lay_traps(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert dict(results(workers_of(None, 1), tasks.square, range(3))) == {0: 0, 1: 1, 2: 4}
    assert not executed(tmp_path)
